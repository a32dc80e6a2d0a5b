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
    matcher = HDPTreeMatcher.create(0, 64, preset=HDPTreeMatcher.PRESET_TREE)
    matcher.setTreeStrategy(Contours())
    matcher.setGamma(10)
    matcher.setMatchingCost(HDPTreeMatcher.MatchingCost.COST_CENSUS)
    cost: HDPTreeMatcher.MatchingCost = matcher.getMatchingCost()
    preset: HDPTreeMatcher.Preset = HDPTreeMatcher.PRESET_QUALITY
    matcher.setPredictionModel(DisparityPredictionModel.createPublished(DisparityPredictionModel.PUBLISHED_SMALL))
    disparity: npt.NDArray[np.int16] = matcher.compute(left, right)
    confidence: Optional[npt.NDArray[np.uint8]] = matcher.getConfidence()
    if confidence is not None:
        disparity[confidence < 50] = -16
    matcher.save(pathlib.Path(cost.name + preset.name + '.yml'))
    moved: bool = matcher.getRowAlignment()[0]
    stages, milliseconds = matcher.getStageTimes()
    return disparity, stages if moved else []


matcher = HDPTreeMatcher()
matcher.setGamma('wide')  # type: ignore[arg-type]
matcher.setNumLayers(1.5)  # type: ignore[arg-type]
matcher.compute([[1]], [[2]])  # type: ignore[arg-type]
matcher.getSomething()  # type: ignore[attr-defined]
