#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
What HDPTreeMatcher.setPriorDisparity() is worth on KITTI 2015:
    PYTHONPATH=BUILD/python measure_prior.py FOLDER [PRESET [STEP]]
FOLDER has SCENE/{left,right,disp_left}.png, of which every STEP-th is matched. The prior has 500 random points of the
truth, with noise of 0.5 pixels: as they are, 10 % of them wrong by 5 to 50 pixels, those of the left half of the image
by 15, and all of them by 20. Prints D1, the percentage of pixels that are wrong by more than 3 pixels and 5 %. Needs cv2.
'''

import os
import sys

import cv2
import numpy as np

from hdpstereo import HDPTreeMatcher

POINTS, SIGMA = 500, 0.5


def main():
    folder, preset = sys.argv[1], (sys.argv[2:] or ['fast'])[0]
    scenes = sorted(os.listdir(folder))[::int((sys.argv[3:] or [1])[0])]
    errors = {}
    for seed, scene in enumerate(scenes):
        left, right, truth = (cv2.imread(os.path.join(folder, scene, name + '.png'), flags)
                              for name, flags in (('left', 1), ('right', 1), ('disp_left', -1)))
        truth = truth / 256.0
        random = np.random.RandomState(seed)
        places = np.argwhere(truth > 0)
        rows, columns = places[random.choice(len(places), POINTS, replace=False)].T
        points = truth[rows, columns] + random.normal(0, SIGMA, POINTS)
        some = points.copy()
        wrong = random.choice(POINTS, POINTS // 10, replace=False)
        some[wrong] += random.uniform(5, 50, len(wrong)) * random.choice([-1, 1], len(wrong))
        half = np.where(columns < truth.shape[1] // 2, points + 15, points)
        for name, values in (('no prior', None), ('right', points), ('10 % wrong', some), ('half wrong', half),
                             ('all wrong', points + 20)):
            matcher = HDPTreeMatcher.create(0, 256, preset=preset)
            if values is not None:
                prior = np.full(truth.shape, np.nan, np.float32)
                prior[rows, columns] = values
                matcher.setPriorDisparity(prior, SIGMA)
            error = np.abs(matcher.compute(left, right) / 16.0 - truth)
            errors.setdefault(name, []).append(100 * np.mean(((error > 3) & (error > 0.05 * truth))[truth > 0]))
    for name, values in errors.items():
        print('%-12s D1 %5.2f, %.2f of that without' % (name, np.mean(values),
                                                        np.mean(values) / np.mean(errors['no prior'])))


if __name__ == '__main__':
    main()
