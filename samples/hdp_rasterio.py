#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Matches a rectified pair of rasters, window by window, and writes a map that lies where the left raster does.

usage:
    hdp_rasterio.py LEFT RIGHT OUT [--window=X,Y,WIDTH,HEIGHT] [--min-disparity=0] [--num-disparities=128]
                    [--preset=fast] [--tile=1152]

LEFT and RIGHT are of one size, of any number of columns, in formats of GDAL: 8 bit, 16 bit or float; of more bands
than one, 8 bit has the first three, all others the first. What a raster declares as no data has no disparity and no
influence. OUT is a GeoTIFF of floats, NaN = none, with the coordinates of the left raster, its ground control points
and its rational polynomials; of the window alone, if there is one. Tiles are matched with one model of the pair, found
in its overviews, so that there are no seams, and so is the range of disparities if --num-disparities is 0; memory is
that of a tile. On Debian: apt install python3-rasterio python3-opencv
'''

import argparse
import os
import sys
import warnings

import hdpstereo
import numpy as np
import rasterio
from rasterio.enums import MaskFlags, Resampling
from rasterio.windows import Window

GRID, MARGIN = 384, 128  # pixels of all layers begin at its multiples; what scanlines need


def read(raster, window, size):
    '''Levels and mask of a window, at this size (width, height). No mask if the raster has none: black borders are
    found then.'''
    bands = [3, 2, 1] if raster.count >= 3 and raster.dtypes[0] == 'uint8' else 1
    shape = (size[1], size[0])
    levels = raster.read(bands, window=window, resampling=Resampling.average,
                         out_shape=shape if bands == 1 else (3,) + shape)
    is_masked = any(flags != [MaskFlags.all_valid] for flags in raster.mask_flag_enums)
    mask = raster.dataset_mask(window=window, out_shape=shape, resampling=Resampling.nearest) if is_masked else None
    return np.ascontiguousarray(levels if bands == 1 else levels.transpose(1, 2, 0)), mask


def match(matcher, rasters, window, size):
    '''Disparities of a window of both rasters'''
    (left, left_mask), (right, right_mask) = (read(raster, window, size) for raster in rasters)
    matcher.setMasks(left_mask, right_mask)
    return matcher.compute(left, right, as_float=True)


def find_model(rasters, args):
    '''What all tiles are matched with: that of the pair, halved until it has some megapixels. If there is no range of
    disparities, it is found there.'''
    width, height, times = rasters[0].width, rasters[0].height, 0
    while (height >> times) * (width >> times) > 3e6:
        times += 1
    size, number = (width >> times, height >> times), args.num_disparities
    matcher = hdpstereo.HDPTreeMatcher.create(args.min_disparity >> times, number and (number >> times) + (times > 0),
                                              args.preset)
    match(matcher, rasters, Window(0, 0, size[0] << times, size[1] << times), size)
    model = matcher.getPairModel().enlarged(times, width, height)
    if number == 0:
        args.min_disparity, args.num_disparities = model.minDisparity, model.numDisparities
        print('found disparities %d..%d' % (model.minDisparity, model.minDisparity + model.numDisparities - 1))
    return model


def cut(window, width, height, args):
    '''Tiles with their margins, and what is kept of each'''
    largest = max(args.min_disparity + args.num_disparities - 1, 0)
    before, after = largest + MARGIN, max(-args.min_disparity, 0) + MARGIN
    end_x, end_y = window.col_off + window.width, window.row_off + window.height
    for y in range(window.row_off, end_y, args.tile):
        for x in range(window.col_off, end_x, args.tile):
            kept = Window(x, y, min(args.tile, end_x - x), min(args.tile, end_y - y))
            x0, y0 = (max(start - margin, 0) // GRID * GRID for start, margin in ((x, before), (y, MARGIN)))
            yield Window(x0, y0, min(x + kept.width + after, width) - x0,
                         min(y + kept.height + MARGIN, height) - y0), kept


def open_rasters(args):
    '''Both, and the window. Raises ValueError.'''
    left, right = (rasterio.open(name) for name in (args.left, args.right))
    if right.shape != left.shape:
        raise ValueError("'%s' must have the size of '%s'" % (args.right, args.left))
    if (right.dtypes[0], right.count >= 3) != (left.dtypes[0], left.count >= 3):
        raise ValueError("'%s' must have the type and the bands of '%s'" % (args.right, args.left))
    if left.dtypes[0] not in ('uint8', 'uint16', 'float32'):
        raise ValueError("'%s' must be of uint8, uint16 or float32, not %s" % (args.left, left.dtypes[0]))
    whole = Window(0, 0, left.width, left.height)
    try:
        window = Window(*[int(number) for number in args.window.split(',')]) if args.window else whole
        inside = window.intersection(whole) == window
    except (TypeError, ValueError, rasterio.errors.WindowError):
        inside = False
    if not inside:
        raise ValueError('--window must be X,Y,WIDTH,HEIGHT inside of %d x %d pixels' % (left.width, left.height))
    return (left, right), window


def place_of(raster, window):
    '''Coordinates, ground control points and rational polynomials of a window, for a file of it'''
    gcps, crs = raster.gcps
    for gcp in gcps:
        gcp.row, gcp.col = gcp.row - window.row_off, gcp.col - window.col_off
    rpcs = raster.rpcs
    if rpcs:
        rpcs.line_off, rpcs.samp_off = rpcs.line_off - window.row_off, rpcs.samp_off - window.col_off
    place = dict(crs=crs, gcps=gcps) if gcps else dict(crs=raster.crs, transform=raster.window_transform(window))
    return dict(place, rpcs=rpcs)


def match_rasters(args):
    '''Errors are ValueError, or those of rasterio and of the system.'''
    if args.tile <= 0:
        raise ValueError('--tile must be > 0')
    if args.num_disparities < 0 or (args.num_disparities == 0 and args.min_disparity != 0):
        raise ValueError('--num-disparities must be > 0, or 0 without --min-disparity, which is found then, too')
    if args.min_disparity < -2047 or args.min_disparity + args.num_disparities > 2048:
        raise ValueError('disparities must be from -2047 to 2047')
    if os.path.isdir(args.out):
        raise ValueError("OUT must not be a folder, '%s'" % args.out)
    rasters, window = open_rasters(args)
    if os.path.realpath(args.out) in [os.path.realpath(name) for name in (args.left, args.right)]:
        raise ValueError("OUT must not be an input, '%s'" % args.out)
    left = rasters[0]
    profile = dict(driver='GTiff', dtype='float32', count=1, nodata=np.nan, width=window.width, height=window.height,
                   compress='deflate', **place_of(left, window))
    part = args.out + '.part'  # a map that is there is kept until the new one is whole
    try:
        with rasterio.open(part, 'w', **profile) as out:
            model = find_model(rasters, args)
            matcher = hdpstereo.HDPTreeMatcher.create(args.min_disparity, args.num_disparities, args.preset)
            for tile, kept in cut(window, left.width, left.height, args):
                matcher.setPairModel(model.tile(tile.col_off, tile.row_off, tile.width, tile.height))
                disparity = match(matcher, rasters, tile, (tile.width, tile.height))
                top, first = kept.row_off - tile.row_off, kept.col_off - tile.col_off
                out.write(disparity[top:top + kept.height, first:first + kept.width], 1,
                          window=Window(kept.col_off - window.col_off, kept.row_off - window.row_off, kept.width,
                                        kept.height))
        os.replace(part, args.out)
    finally:
        if os.path.exists(part):
            os.remove(part)


def main():
    parser = argparse.ArgumentParser(description='Disparities of a rectified pair of rasters.')
    parser.add_argument('left', help='left raster')
    parser.add_argument('right', help='right raster, of its size')
    parser.add_argument('out', help='GeoTIFF for the map')
    parser.add_argument('--window', help='X,Y,WIDTH,HEIGHT in pixels (default: all)')
    parser.add_argument('--min-disparity', type=int, default=0, help='smallest disparity (default: 0)')
    parser.add_argument('--num-disparities', type=int, default=128,
                        help='number of disparities; 0: found in the pair (default: 128)')
    parser.add_argument('--preset', default='fast', choices=['ultrafast', 'fast', 'quality', 'tree', 'paper'])
    parser.add_argument('--tile', type=int, default=1152, help='side of a tile (default: 1152)')
    args = parser.parse_args()
    warnings.simplefilter('ignore', rasterio.errors.NotGeoreferencedWarning)  # a raster need not have coordinates
    try:
        match_rasters(args)
    except (ValueError, OSError, rasterio.errors.RasterioError, rasterio.errors.WindowError) as error:
        sys.exit('error: %s' % error)


if __name__ == '__main__':
    main()
