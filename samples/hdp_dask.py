#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Matches many rectified pairs on many machines, by a Dask cluster.

usage:
    hdp_dask.py LEFTS RIGHTS OUT [--scheduler=tcp://HOST:8786] [--workers=2] [--preset=fast]
                [--min-disparity=0] [--num-disparities=128] [--format=png]

LEFTS and RIGHTS are folders with files of the same names, of 8 or 16 bit. OUT gets the maps: PNG of 16 bit, disparity *
256, 0 = none, for disparities from 0 to 255; or TIFF of floats, NaN = none, for any. All machines have to see the three
under the same names. Maps that are there are kept: run again, it does what is left. OUT/options.json says what made
them; with other options it stops. Without a scheduler, it makes a cluster of this machine. On Debian: apt install
python3-distributed python3-opencv
'''

import argparse
import json
import os
import pathlib
import socket
import sys

from distributed import Client, as_completed

PICTURES = {'.bmp', '.jpeg', '.jpg', '.pgm', '.png', '.ppm', '.tif', '.tiff', '.webp'}


def match(left, right, output, options):
    '''Runs on a worker, which need not have this file.'''
    import cv2
    import hdpstereo
    import numpy as np

    images = [cv2.imread(str(path), cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH) for path in (left, right)]
    for path, image in zip((left, right), images):
        if image is None:
            raise ValueError("cannot read the image '%s'" % path)
    images = [cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) if image.dtype == np.uint16 else image for image in images]
    matcher = hdpstereo.HDPTreeMatcher.create(options['min_disparity'], options['num_disparities'], options['preset'])
    disparity = matcher.compute(*images, as_float=True)
    if output.suffix == '.png':
        known = (disparity >= 0) & (disparity < 256)
        disparity = np.where(known, np.maximum(disparity * 256, 1), 0).astype(np.uint16)

    # Under another name first: whatever becomes of this worker, a map is whole or not there. Dask may run a pair twice.
    part = '%s.%s.%d.part' % (output, socket.gethostname(), os.getpid())
    with open(part, 'wb') as f:
        f.write(cv2.imencode(output.suffix, disparity)[1])
    os.replace(part, output)


def keep_options(path, options):
    '''What the maps were made with, so that those of other options are not taken for these.'''
    if not path.exists():
        path.write_text(json.dumps(options))
    elif json.loads(path.read_text()) != options:
        sys.exit("error: the maps in '%s' were made with other options, see options.json: take another folder" %
                 path.parent)


def main():
    parser = argparse.ArgumentParser(description='Disparities of many rectified pairs, by a Dask cluster.')
    parser.add_argument('lefts', type=pathlib.Path, help='folder of left images')
    parser.add_argument('rights', type=pathlib.Path, help='folder of right images, of the same names')
    parser.add_argument('out', type=pathlib.Path, help='folder for the maps')
    parser.add_argument('--scheduler', help='its address; without one, a cluster of this machine')
    parser.add_argument('--workers', type=int, default=2, help='of the cluster of this machine (default: 2)')
    parser.add_argument('--preset', default='fast', choices=['ultrafast', 'fast', 'quality', 'tree', 'paper'])
    parser.add_argument('--min-disparity', type=int, default=0, help='smallest disparity (default: 0)')
    parser.add_argument('--num-disparities', type=int, default=128, help='number of disparities (default: 128)')
    parser.add_argument('--format', default='png', choices=['png', 'tif'], help='of the maps (default: png)')
    args = parser.parse_args()
    for folder in args.lefts, args.rights:
        if not folder.is_dir():
            sys.exit("error: there is no folder '%s'" % folder)
    if args.format == 'png' and (args.min_disparity < 0 or args.min_disparity + args.num_disparities > 256):
        sys.exit('error: --format=png is for disparities from 0 to 255, --format=tif for any')

    lefts = sorted(path.resolve() for path in args.lefts.iterdir() if path.suffix.lower() in PICTURES)
    rights, out = args.rights.resolve(), args.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    options = {name: getattr(args, name) for name in ('preset', 'min_disparity', 'num_disparities', 'format')}
    keep_options(out / 'options.json', options)
    outputs = {left: out / (left.stem + '.' + args.format) for left in lefts}
    missing = [left for left in lefts if not outputs[left].exists()]
    print('%d pairs, %d of them are there' % (len(lefts), len(lefts) - len(missing)))

    cluster = {'address': args.scheduler} if args.scheduler else {
        'n_workers': args.workers, 'threads_per_worker': 1, 'dashboard_address': None}
    bad = 0
    with Client(**cluster) as client:
        # If a worker dies, Dask gives its pairs to the others.
        futures = {client.submit(match, left, rights / left.name, outputs[left], options, pure=False): left
                   for left in missing}
        for done, future in enumerate(as_completed(futures), 1):
            error = future.exception()
            bad += error is not None
            print('%d/%d %s' % (done, len(missing), futures[future].name) + (' left out: %s' % error if error else ''))
    return 2 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
