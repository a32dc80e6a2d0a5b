#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Instructions per pixel and frame of a program, from what plugin.c wrote in runs of one frame and of two.
    report.py PIXELS NM PROGRAM ONE TWO [SHARE]   with the functions that take at least so many percent of them
'''

import bisect
import collections
import subprocess
import sys


def read(path):
    counts = collections.Counter()
    with open(path) as lines:
        for line in lines:
            address, count = line.split()
            counts[int(address, 16)] += int(count)
    return counts


def main():
    pixels, nm, program, one, two = sys.argv[1:6]
    pixels = int(pixels)
    counts = read(two)
    counts.subtract(read(one))
    total = sum(counts.values())
    print('%.0f' % (total / pixels))
    if len(sys.argv) < 7:
        return
    symbols = []
    for line in subprocess.run([nm, '-C', '--defined-only', program], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines():
        address, kind, name = line.split(' ', 2)
        if kind in 'tTWVuwi':
            symbols.append((int(address, 16), name))
    symbols.sort()
    addresses = [address for address, _ in symbols]
    functions = collections.Counter()
    for address, count in counts.items():
        i = bisect.bisect_right(addresses, address) - 1
        inside = i >= 0 and address < addresses[-1] + (1 << 16)
        functions[symbols[i][1] if inside else '(libraries)'] += count
    for name, count in functions.most_common():
        if 100 * count / total < float(sys.argv[6]):
            break
        print('    %7.1f %5.1f %%  %s' % (count / pixels, 100 * count / total, name[:150]))


if __name__ == '__main__':
    main()
