# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''A program that uses all kinds of things of the package, for mypy --strict.'''

import pathlib
from typing import List, Optional, Tuple

import numpy as np
import numpy.typing as npt

import hdpstereo
from hdpstereo import DisparityPredictionModel, HDPTreeMatcher


class Contours(hdpstereo.TreeStrategy):
    def orderEdges(self, weights: npt.NDArray[np.uint8], edges: npt.NDArray[np.intc]) -> npt.NDArray[np.intc]:
        return edges[np.argsort(weights.ravel()[edges], kind='stable')]

    def mayJoin(self, weight: int, a: hdpstereo.TreeState, b: hdpstereo.TreeState) -> bool:
        return weight <= 20 and a.size + b.size < 1000


def match(left: npt.NDArray[np.uint8], right: npt.NDArray[np.uint8]) -> Tuple[npt.NDArray[np.int16], List[str]]:
    matcher = HDPTreeMatcher.create(0, preset='tree', num_disparities=64, fill_occlusions=False)
    pixels: npt.NDArray[np.float32] = matcher.compute(left, right, as_float=True)
    print(matcher, np.nanmean(pixels), hdpstereo.getNumThreads())
    params = HDPTreeMatcher.Params(HDPTreeMatcher.PRESET_TREE, gamma=10, treeStrategy=Contours())
    print(HDPTreeMatcher.Params('quality', fill_occlusions=False))
    params.matchingCost = HDPTreeMatcher.MatchingCost.COST_CENSUS
    params.predictionModel = DisparityPredictionModel.createPublished(DisparityPredictionModel.PUBLISHED_SMALL)
    matcher.setParams(params)
    cost: HDPTreeMatcher.MatchingCost = matcher.getParams().matchingCost
    preset: HDPTreeMatcher.Preset = HDPTreeMatcher.PRESET_QUALITY
    matcher.setPriorDisparity(np.full(left.shape, np.nan, np.float32), 0.5)
    model = matcher.getPairModel()
    model.rows = [0, 0, 0, 0, 0]
    disparity: npt.NDArray[np.int16] = matcher.compute(left, right)
    confidence: Optional[npt.NDArray[np.uint8]] = matcher.getConfidence()
    if confidence is not None:
        disparity[confidence < 50] = -16
    matcher.save(pathlib.Path(cost.name + preset.name + '.yml'))
    findings = matcher.getFindings()
    return disparity, findings.stages if findings.areRowsMoved else []


def depth(left: npt.NDArray[np.uint8], right: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    rig = hdpstereo.StereoRig(hdpstereo.readStereoCalibration(pathlib.Path('left.yaml'), 'right.yaml'), fieldOfView=80)
    rectified = rig.rectify(left, right)
    metres: npt.NDArray[np.float32] = rig.computeDepth(HDPTreeMatcher().compute(*rectified))
    drift = hdpstereo.RigDrift(rig.getRectification()[3], rig.getSize())
    if drift.add([0, 0.1, 0, 0, 0]):
        print(drift.correct(rig.getCalibration(), rig.getRectification()[1]).T[0])
    return metres


matcher = HDPTreeMatcher()
matcher.setNoiseThreshold('wide')  # type: ignore[arg-type]
matcher.setMaxRowOffset(1.5)  # type: ignore[arg-type]
matcher.getParams().gamma = 'wide'  # type: ignore[assignment]
HDPTreeMatcher.Params(numLayers=1.5)  # type: ignore[arg-type]
matcher.compute([[1]], [[2]])  # type: ignore[arg-type]
matcher.getSomething()  # type: ignore[attr-defined]
