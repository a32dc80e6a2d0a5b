# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Fast non-local stereo matching: disparities of a rectified pair, for numpy arrays.

    import hdpstereo
    matcher = hdpstereo.HDPTreeMatcher.create(0, 128)
    disparity = matcher.compute(left, right) / 16.0
    confidence = matcher.getConfidence()  # 0 .. 255
'''

from ._hdpstereo import (CV_16S, CV_32F, DisparityPredictionModel, HDPTreeMatcher, TreeState, TreeStrategy, __version__,
                         createMinimumSpanningTree, createRandomTree, createSegmentTree)

__all__ = ['CV_16S', 'CV_32F', 'DisparityPredictionModel', 'HDPTreeMatcher', 'TreeState', 'TreeStrategy',
           'createMinimumSpanningTree', 'createRandomTree', 'createSegmentTree']
