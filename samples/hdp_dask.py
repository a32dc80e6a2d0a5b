#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Matches many rectified pairs on many machines, by a Dask cluster.

usage:
    hdp_dask.py LEFTS RIGHTS OUT [--scheduler=tcp://HOST:8786] [--workers=2] [--preset=FAST] [--num-disparities=128]

LEFTS and RIGHTS are folders with files of the same names, OUT gets the maps: PNG of 16 bit, disparity * 256, 0 = none.
All machines have to see the three under the same names. Maps that are there are kept: run again, it does what is left.
Without a scheduler, it makes a cluster of this machine. On Debian: apt install python3-distributed python3-opencv
'''

import argparse
import os
import pathlib
import socket
import sys

from distributed import Client, as_completed


def match(left, right, output, preset, num_disparities):
    '''Runs on a worker, which need not have this file.'''
    import cv2
    import hdpstereo
    import numpy as np

    images = [cv2.imread(str(path)) for path in (left, right)]
    for path, image in zip((left, right), images):
        if image is None:
            raise ValueError("cannot read the image '%s'" % path)
    matcher = hdpstereo.HDPTreeMatcher.create(0, num_disparities, getattr(hdpstereo.HDPTreeMatcher, 'PRESET_' + preset))
    disparity = matcher.compute(*images).astype(int) * 16
    disparity = np.where((disparity >= 0) & (disparity < 1 << 16), np.maximum(disparity, 1), 0).astype(np.uint16)

    # Under another name first: whatever becomes of this worker, a map is whole or not there. Dask may run a pair twice.
    part = '%s.%s.%d.part' % (output, socket.gethostname(), os.getpid())
    with open(part, 'wb') as f:
        f.write(cv2.imencode('.png', disparity)[1])
    os.replace(part, output)


def main():
    parser = argparse.ArgumentParser(description='Disparities of many rectified pairs, by a Dask cluster.')
    parser.add_argument('lefts', type=pathlib.Path, help='folder of left images')
    parser.add_argument('rights', type=pathlib.Path, help='folder of right images, of the same names')
    parser.add_argument('out', type=pathlib.Path, help='folder for the maps')
    parser.add_argument('--scheduler', help='its address; without one, a cluster of this machine')
    parser.add_argument('--workers', type=int, default=2, help='of the cluster of this machine (default: 2)')
    parser.add_argument('--preset', default='FAST', choices=['ULTRAFAST', 'FAST', 'QUALITY', 'TREE', 'PAPER'])
    parser.add_argument('--num-disparities', type=int, default=128, help='number of disparities (default: 128)')
    args = parser.parse_args()

    lefts = sorted(path.resolve() for path in args.lefts.iterdir())
    rights, out = args.rights.resolve(), args.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    outputs = {left: out / (left.stem + '.png') for left in lefts}
    missing = [left for left in lefts if not outputs[left].exists()]
    print('%d pairs, %d of them are there' % (len(lefts), len(lefts) - len(missing)))

    cluster = {'address': args.scheduler} if args.scheduler else {
        'n_workers': args.workers, 'threads_per_worker': 1, 'dashboard_address': None}
    bad = 0
    with Client(**cluster) as client:
        # If a worker dies, Dask gives its pairs to the others.
        futures = {client.submit(match, left, rights / left.name, outputs[left], args.preset, args.num_disparities,
                                 pure=False): left for left in missing}
        for done, future in enumerate(as_completed(futures), 1):
            error = future.exception()
            bad += error is not None
            print('%d/%d %s' % (done, len(missing), futures[future].name) + (' left out: %s' % error if error else ''))
    return 2 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
