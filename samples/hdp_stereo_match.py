#!/usr/bin/env python
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Matches a rectified stereo pair by HDPTreeMatcher, of the package hdpstereo or of cv2, beside cv.StereoSGBM.

usage:
    hdp_stereo_match.py [LEFT RIGHT] [--preset=fast] [--num-disparities=128] [--compare]
                        [--output=FILE.png|FILE.pfm] [--picture=FILE] [--point-cloud=FILE.ply] [--truth=FILE] [--show]

Without LEFT and RIGHT it takes the Aloe pair of OpenCV's samples, with ground truth; --help lists all options.
'''

from __future__ import print_function

import argparse
import os
import sys

import numpy as np
import cv2 as cv

try:  # a cv2 that is built with this module
    HDPTreeMatcher = cv.stereo.HDPTreeMatcher
except AttributeError:
    from hdpstereo import HDPTreeMatcher

# By name, as both have them
PRESETS = {'paper': 0, 'fast': 1, 'ultrafast': 2, 'quality': 3, 'tree': 4}

PLY_HEADER = '''ply
format binary_little_endian 1.0
element vertex %d
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
end_header
'''


def read_image(filename, flags):
    image = cv.imread(cv.samples.findFile(filename, required=False) or filename, flags)
    if image is None:
        sys.exit('cannot read the image ' + filename)
    return image


def read_picture(filename):
    '''Colors in 8 bit, or grey levels in 16 bit of a picture that has them.'''
    image = read_image(filename, cv.IMREAD_COLOR | cv.IMREAD_ANYDEPTH)
    return cv.cvtColor(image, cv.COLOR_BGR2GRAY) if image.dtype == np.uint16 else image


def in_8_bit(*images):
    '''Colors, as cv.StereoSGBM and windows take them: the brightest pixel of 16 bit becomes white.'''
    if images[0].dtype == np.uint8:
        return images
    scale = 255.0 / max([image.max() for image in images] + [1])
    return [cv.cvtColor(cv.convertScaleAbs(image, alpha=scale), cv.COLOR_GRAY2BGR) for image in images]


def read_disparity(filename):
    '''PNG of 8 bit, or of 16 bit (disparity * 256), both with 0 for unknown, or PFM. NaN where it is unknown.'''
    image = read_image(filename, cv.IMREAD_UNCHANGED)
    if image.ndim != 2:
        sys.exit(filename + ' is a color image, not a disparity map')
    disparity = image.astype(np.float32) / (256 if image.dtype == np.uint16 else 1)
    disparity[~np.isfinite(disparity) if image.dtype == np.float32 else image == 0] = np.nan
    return disparity


def write(filename, image):
    try:
        written = cv.imwrite(filename, image)
    except cv.error:
        written = False
    if not written:
        sys.exit('cannot write ' + filename)
    print('written', filename)


def write_disparity(filename, disparity):
    if filename.lower().endswith('.pfm'):
        write(filename, np.where(np.isnan(disparity), np.float32(np.inf), disparity))
    else:
        known = (disparity >= 0) & (disparity < 256)
        write(filename, np.where(known, np.maximum(np.nan_to_num(disparity) * 256, 1), 0).astype(np.uint16))


def check_outputs(args, parser):
    '''Before the work: what can be written, and is no input.'''
    inputs = [os.path.realpath(path) for path in (args.left, args.right, args.truth) if path]
    for path in args.output, args.picture, args.point_cloud:
        if path and os.path.realpath(path) in inputs:
            parser.error('cannot write %s: it is an input' % path)
    if not args.output:
        return
    extension = os.path.splitext(args.output)[1].lower()
    if extension not in ('.png', '.pfm'):
        parser.error('--output=%s: neither .png nor .pfm' % args.output)
    if extension == '.png' and args.min_disparity < 0:
        parser.error('PNG has no disparities below 0, and --min-disparity=%d asks for some: take .pfm' %
                     args.min_disparity)


def color_picture(disparity):
    '''From blue (far) to orange (near); black where there is no disparity.'''
    known = ~np.isnan(disparity)
    low, high = np.percentile(disparity[known], (1, 99)) if known.any() else (0, 1)
    levels = np.clip((disparity - low) / max(high - low, 1), 0, 1) * 150 + 20
    picture = cv.applyColorMap(np.nan_to_num(levels).astype(np.uint8), cv.COLORMAP_TURBO)
    picture[~known] = 0
    return picture


def write_point_cloud(filename, disparity, image, focal, baseline):
    '''A binary .ply file; the principal point is the center of the image.'''
    height, width = disparity.shape
    Q = np.float64([[1, 0, 0, -0.5 * (width - 1)],
                    [0, 1, 0, -0.5 * (height - 1)],
                    [0, 0, 0, focal],
                    [0, 0, 1 / baseline, 0]])
    points = cv.reprojectImageTo3D(disparity, Q)
    seen = np.isfinite(points).all(axis=2) & (points[..., 2] > 0)
    vertices = np.empty(np.count_nonzero(seen), [('position', '<f4', 3), ('color', 'u1', 3)])
    vertices['position'] = points[seen]
    vertices['color'] = image[seen][:, ::-1]
    try:
        with open(filename, 'wb') as f:
            f.write((PLY_HEADER % len(vertices)).encode('ascii'))
            f.write(vertices.tobytes())
    except OSError:
        sys.exit('cannot write ' + filename)
    print('written %s (%d points)' % (filename, len(vertices)))


def first_disparity(matcher):
    return matcher.getFindings().minDisparity if hasattr(matcher, 'getFindings') else matcher.getMinDisparity()


def compute(matcher, left, right):
    '''Disparities in pixels, NaN where there is none.'''
    disparity = matcher.compute(left, right).astype(np.float32) / 16
    disparity[disparity < first_disparity(matcher)] = np.nan
    return disparity


def time_in_turns(matchers, pairs, runs):
    '''Median milliseconds of compute(): in turns, so that what else the machine does hits all of them.'''
    times = {name: [] for name in matchers}
    for _ in range(runs):
        for name, matcher in matchers.items():
            start = cv.getTickCount()
            matcher.compute(*pairs[name])
            times[name].append((cv.getTickCount() - start) * 1000 / cv.getTickFrequency())
    return {name: np.median(values) for name, values in times.items()}


def main():
    parser = argparse.ArgumentParser(description='Disparity of a rectified stereo pair by HDPTreeMatcher.')
    parser.add_argument('left', nargs='?', help='left image; without one, the Aloe pair of OpenCV\'s samples/data, in '
                        'OPENCV_SAMPLES_DATA_PATH')
    parser.add_argument('right', nargs='?', help='right image')
    parser.add_argument('--preset', choices=PRESETS, default='fast', help='set of parameters (default: fast)')
    parser.add_argument('--min-disparity', type=int, default=0, help='smallest disparity in pixels (default: 0)')
    parser.add_argument('--num-disparities', type=int, help='number of disparities (default: a fifth of the width); 0: found in the pair')
    parser.add_argument('--output', help='disparity: .png (16 bit, times 256, 0 = none) or .pfm (float, inf = none)')
    parser.add_argument('--picture', help='disparity in colors')
    parser.add_argument('--point-cloud', help='colored points: .ply; needs --focal and --baseline')
    parser.add_argument('--focal', type=float, help='focal length in pixels')
    parser.add_argument('--baseline', type=float, help='distance of the cameras, in the unit of the points')
    parser.add_argument('--truth', help='left disparity: PNG of 8 bit or 16 bit (times 256), 0 = unknown, or PFM')
    parser.add_argument('--compare', action='store_true',
                        help='time and error beside cv.StereoSGBM; pixels without disparity count as wrong')
    parser.add_argument('--runs', type=int, default=5, help='runs that --compare takes the median of (default: 5)')
    parser.add_argument('--show', action='store_true', help='show the pictures in windows')
    args = parser.parse_args()
    if (args.left is None) != (args.right is None):
        parser.error('a left and a right image are needed')
    for option, value in ('--focal', args.focal), ('--baseline', args.baseline):
        if (value is None) != (args.point_cloud is None):
            parser.error('--point-cloud needs --focal and --baseline, and they need it')
        if value is not None and not 0 < value < float('inf'):
            parser.error('%s must be above 0' % option)
    if args.num_disparities == 0 and args.min_disparity != 0:
        parser.error('--min-disparity does not go with --num-disparities=0, which finds it, too')
    check_outputs(args, parser)
    if args.runs < 1:
        parser.error('--runs must be at least 1')
    if args.left is None:
        args.left, args.right, args.truth = 'aloeL.jpg', 'aloeR.jpg', args.truth or 'aloeGT.png'

    left, right = read_picture(args.left), read_picture(args.right)
    truth = read_disparity(args.truth) if args.truth else None
    if truth is not None and truth.shape != left.shape[:2]:
        sys.exit('the truth has another size than the images')
    num_disparities = args.num_disparities
    if num_disparities is None:
        num_disparities = max((left.shape[1] // 5 + 15) // 16 * 16, 16)

    try:
        matcher = HDPTreeMatcher.create(args.min_disparity, num_disparities, PRESETS[args.preset])
        matchers = {args.preset: matcher}
        pairs = {args.preset: (left, right)}
        disparities = {args.preset: compute(matcher, left, right)}
        findings = matcher.getFindings()
        first, count = findings.minDisparity, findings.numDisparities
        if args.compare and left.shape[1] <= first + count:
            print('without cv.StereoSGBM, which takes images that are wider than the disparities')
        elif args.compare:
            pairs['sgbm'] = in_8_bit(left, right)
            matchers['sgbm'] = cv.StereoSGBM.create(first, (count + 15) // 16 * 16, blockSize=3, P1=8 * 27,
                                                    P2=32 * 27, mode=cv.StereoSGBM_MODE_SGBM_3WAY)
            disparities['sgbm'] = compute(matchers['sgbm'], *pairs['sgbm'])
    except (cv.error, ValueError) as e:
        sys.exit('error: %s' % getattr(e, 'err', e))

    print('images %d x %d, disparities %d to %d' % (left.shape[1], left.shape[0], first, first + count - 1))
    times = time_in_turns(matchers, pairs, args.runs) if args.compare else {}
    for stage, milliseconds in zip(findings.stages, findings.stageTimes):
        print('%-24s%10.1f ms' % (stage, milliseconds))
    for name, disparity in disparities.items():
        line = '%-12s' % name
        if times:
            line += '%8.1f ms' % times[name]
        if truth is not None:
            judged = ~np.isnan(truth)
            error = np.nan_to_num(np.abs(disparity - truth)[judged], nan=np.inf)
            wrong = [100 * np.mean(error >= threshold) for threshold in (1, 2)]
            line += '%10.2f %% wrong by 1 and more, %6.2f %% by 2' % tuple(wrong)
        print(line + '%10.2f %% without disparity' % (100 * np.mean(np.isnan(disparity))))

    disparity = disparities[args.preset]
    if args.output:
        write_disparity(args.output, disparity)
    if args.picture:
        write(args.picture, color_picture(disparity))
    if args.point_cloud:
        write_point_cloud(args.point_cloud, disparity, in_8_bit(left)[0], args.focal, args.baseline)
    if args.show:
        cv.imshow('left', in_8_bit(left)[0])
        for name in disparities:
            cv.imshow(name, color_picture(disparities[name]))
        cv.waitKey()
        cv.destroyAllWindows()


if __name__ == '__main__':
    main()
