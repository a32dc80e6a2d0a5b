#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
What HDPTreeMatcher.setPriorDisparity() is worth. The folder has SCENE/{left,right,disp_left}.png. The prior has random
points of the truth, with noise: as they are, a tenth of them wrong by 5 to 50 pixels, those of the left half of the image
by 15, and all of them by 20. Prints the percentage of wrong pixels. Needs cv2.
'''

import argparse
import os
import sys

import cv2
import numpy as np

from hdpstereo import HDPTreeMatcher


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('folder')
    parser.add_argument('preset', nargs='?', default='fast')
    parser.add_argument('--scale', type=float, default=256, help='of the truth, 0 being unknown')
    parser.add_argument('--num-disparities', type=int, default=256)
    parser.add_argument('--points', type=int, default=500)
    parser.add_argument('--sigma', type=float, default=0.5, help='of the points, in pixels')
    parser.add_argument('--largest-error', type=float, default=3, help='of a right pixel, in pixels')
    parser.add_argument('--largest-share', type=float, default=0.05, help='of its disparity, that it may be instead')
    return parser.parse_args()


def make_priors(truth, seed, options):
    random = np.random.RandomState(seed)
    places = np.argwhere(truth > 0)
    rows, columns = places[random.choice(len(places), options.points, replace=False)].T
    points = truth[rows, columns] + random.normal(0, options.sigma, options.points)
    some = points.copy()
    wrong = random.choice(options.points, options.points // 10, replace=False)
    some[wrong] += random.uniform(5, 50, len(wrong)) * random.choice([-1, 1], len(wrong))
    half = np.where(columns < truth.shape[1] // 2, points + 15, points)
    for name, values in ('right', points), ('10 % wrong', some), ('half wrong', half), ('all wrong', points + 20):
        prior = np.full(truth.shape, np.nan, np.float32)
        prior[rows, columns] = values
        yield name, prior


def read_image(path, flags):
    image = cv2.imread(path, flags)
    if image is None:
        sys.exit(f'cannot read the image {path}')
    return image


def read_scene(folder, options):
    left, right, truth = (read_image(os.path.join(folder, name + '.png'), flags)
                          for name, flags in (('left', 1), ('right', 1), ('disp_left', -1)))
    if truth.shape != left.shape[:2] or right.shape != left.shape:
        sys.exit(f'{folder}: the images and the truth, of grey levels, must have one size')
    if np.count_nonzero(truth) < options.points:
        sys.exit(f'{folder}: the truth has fewer than {options.points} points')
    return left, right, truth / options.scale


def main():
    options = parse_arguments()
    scenes = sorted(os.listdir(options.folder)) if os.path.isdir(options.folder) else []
    if not scenes:
        sys.exit(f'there are no scenes in {options.folder}')
    errors = {}
    for seed, scene in enumerate(scenes):
        left, right, truth = read_scene(os.path.join(options.folder, scene), options)
        matcher = HDPTreeMatcher.create(0, options.num_disparities, preset=options.preset)
        for name, prior in [('no prior', None), *make_priors(truth, seed, options)]:
            if prior is not None:
                matcher.setPriorDisparity(prior, options.sigma)
            error = np.abs(matcher.compute(left, right) / 16.0 - truth)
            wrong = (error > options.largest_error) & (error > options.largest_share * truth)
            errors.setdefault(name, []).append(100 * np.mean(wrong[truth > 0]))
    for name, values in errors.items():
        share = np.mean(values) / np.mean(errors['no prior'])
        print(f'{name:12} {np.mean(values):5.2f} %, {share:.2f} of that without')


if __name__ == '__main__':
    main()
