#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Matches many rectified pairs on many machines, by a Dask cluster.

usage:
    hdp_dask.py LEFTS RIGHTS OUT [--scheduler=tcp://HOST:8786] [--workers=2] [--preset=fast]
                [--min-disparity=0] [--num-disparities=128] [--format=png] [--tile=1152]

LEFTS and RIGHTS are folders with files of the same names, of 8 bit, 16 bit or floats. OUT gets the maps: PNG of 16
bit, disparity * 256, 0 = none, for disparities from 0 to 255; or TIFF of floats, NaN = none, for any. All machines
have to see the three under the same names. Maps that are there are kept: run again, it does what is left.
OUT/options.json says what made them; with other options it stops. LEFTS and RIGHTS may also be the two files of one
large pair: it is cut into tiles, which are matched with one model of the pair, OUT/model.yml, so that there are no
seams; OUT/map.tif is put together when all tiles are there. With rasterio, TIFF is read by windows and the map written
by tiles, so that no worker has more than a tile in memory, and what TIFF declares as no data has no disparity; other
images, and TIFF without rasterio, are read whole for each tile, and the map is put together in memory.
--num-disparities=0 finds the disparities, of one large pair once for all tiles. Without a scheduler, it makes a
cluster of this machine. On Debian: apt install python3-distributed python3-opencv python3-rasterio
'''

import argparse
import json
import os
import pathlib
import socket
import sys
import warnings

from distributed import Client, as_completed

PICTURES = {'.bmp', '.jpeg', '.jpg', '.pgm', '.png', '.ppm', '.tif', '.tiff', '.webp'}


def find_rasterio():
    '''The module, or None if it is not installed.'''
    try:
        import rasterio
    except ImportError:
        return None
    warnings.simplefilter('ignore', rasterio.errors.NotGeoreferencedWarning)  # coordinates are not looked at
    return rasterio


def open_raster(path):
    '''Of TIFF, if there is rasterio: what is read by windows. Else None.'''
    rasterio = find_rasterio()
    if not rasterio or path.suffix.lower() not in ('.tif', '.tiff'):
        return None
    try:
        return rasterio.open(path)
    except rasterio.errors.RasterioError:
        raise ValueError("cannot read the image '%s'" % path)


def read(path, window=None, size=None):
    '''A window (x, y, width, height) of an image, at a size (width, height), and its mask: colours in 8 bit, or grey.

    Runs on a worker, which need not have this file.'''
    import cv2
    import numpy as np

    raster, mask = open_raster(path), None
    if raster:
        from rasterio.enums import MaskFlags, Resampling
        from rasterio.windows import Window

        with raster:
            part = Window(*(window or (0, 0, raster.width, raster.height)))
            shape = (size or (part.width, part.height))[::-1]
            bands = [3, 2, 1] if raster.count >= 3 else [1]
            image = raster.read(bands, window=part, out_shape=(len(bands),) + shape, resampling=Resampling.average)
            image = np.ascontiguousarray(image.transpose(1, 2, 0)) if len(bands) > 1 else image[0]
            if any(flags != [MaskFlags.all_valid] for flags in raster.mask_flag_enums):
                mask = raster.dataset_mask(window=part, out_shape=shape, resampling=Resampling.nearest)
    else:
        image = cv2.imread(str(path), cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH)
        if image is None:  # TIFF of grey floats is no colour image
            image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        if image is None:
            raise ValueError("cannot read the image '%s'" % path)
        if window:
            x, y, width, height = window
            image = image[y:y + height, x:x + width]
        if size:
            image = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    if image.ndim == 3 and image.dtype != np.uint8:
        image = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    return image.astype(np.float32) if image.dtype == np.float64 else image, mask


def compute(matcher, left, right, window=None, size=None):
    '''Disparities of a window of both images'''
    (left, left_mask), (right, right_mask) = (read(path, window, size) for path in (left, right))
    matcher.setMasks(left_mask, right_mask)
    return matcher.compute(left, right, as_float=True)


def write(output, disparity):
    '''Under another name first: whatever becomes of this worker, a map is whole or not there. Dask may run a pair
    twice.'''
    import cv2

    part = '%s.%s.%d.part' % (output, socket.gethostname(), os.getpid())
    with open(part, 'wb') as f:
        f.write(cv2.imencode(output.suffix, disparity)[1])
    os.replace(part, output)


def match(left, right, output, options):
    '''A pair'''
    import hdpstereo
    import numpy as np

    matcher = hdpstereo.HDPTreeMatcher.create(options['min_disparity'], options['num_disparities'], options['preset'])
    disparity = compute(matcher, left, right)
    if output.suffix == '.png':
        if np.nanmin(disparity) < 0 or np.nanmax(disparity) >= 256:
            raise ValueError('PNG is for disparities from 0 to 255, take --format=tif')
        disparity = np.where(np.isnan(disparity), 0, np.maximum(disparity * 256, 1)).astype(np.uint16)
    write(output, disparity)


def size_of(path):
    '''Width and height'''
    raster = open_raster(path)
    if not raster:
        return read(path)[0].shape[1::-1]
    with raster:
        return raster.width, raster.height


def find_model(left, right, width, height, options):
    '''What all tiles are matched with: that of the pair, halved until it has some megapixels. If there is no range of
    disparities, it is found there.'''
    import hdpstereo

    times = 0
    while (height >> times) * (width >> times) > 3e6:
        times += 1
    size, number = (width >> times, height >> times), options['num_disparities']
    matcher = hdpstereo.HDPTreeMatcher.create(options['min_disparity'] >> times,
                                              number and (number >> times) + (times > 0), options['preset'])
    compute(matcher, left, right, (0, 0, size[0] << times, size[1] << times), size)
    return matcher.getPairModel().enlarged(times, width, height)


def match_tile(left, right, tile, inside, model, output, options):
    '''A tile of a pair, with its margins; inside: what is kept of it. Both are (x, y, width, height).'''
    import hdpstereo

    x, y, width, height = tile
    matcher = hdpstereo.HDPTreeMatcher.create(options['min_disparity'], options['num_disparities'], options['preset'])
    matcher.setPairModel(hdpstereo.PairModel.load(model).tile(x, y, width, height))
    disparity = compute(matcher, left, right, tile)
    first, top = inside[0] - x, inside[1] - y
    write(output, disparity[top:top + inside[3], first:first + inside[2]])


def cut(width, height, options):
    '''Tiles with their margins, and what is kept of each.'''
    grid, margin = 384, 128  # pixels of all layers begin at its multiples; what scanlines need
    largest = max(options['min_disparity'] + options['num_disparities'] - 1, 0)
    before, after = -(-(largest + margin) // grid) * grid, max(-options['min_disparity'], 0) + margin
    for y in range(0, height, options['tile']):
        for x in range(0, width, options['tile']):
            right, bottom = min(x + options['tile'], width), min(y + options['tile'], height)
            x0, y0 = max(x - before, 0), max(y - grid, 0)
            yield ((x0, y0, min(right + after, width) - x0, min(bottom + margin, height) - y0),
                   (x, y, right - x, bottom - y))


def put_together(tiles, width, height, path):
    '''The map of a pair. tiles: the files, and what each is of it.'''
    import cv2
    import numpy as np

    def of_tiles():
        for tile, (x, y, columns, rows) in tiles:
            yield cv2.imread(str(tile), cv2.IMREAD_UNCHANGED), slice(y, y + rows), slice(x, x + columns)

    rasterio = find_rasterio()
    if not rasterio:
        whole = np.empty((height, width), np.float32)
        for disparity, rows, columns in of_tiles():
            whole[rows, columns] = disparity
        return write(path, whole)
    part = path.with_name('part.' + path.name)
    with rasterio.open(part, 'w', driver='GTiff', dtype='float32', count=1, width=width, height=height, nodata=np.nan,
                       tiled=True, blockxsize=128, blockysize=128, BIGTIFF='IF_SAFER') as whole:
        for disparity, rows, columns in of_tiles():
            whole.write(disparity, 1, window=rasterio.windows.Window.from_slices(rows, columns))
    os.replace(part, path)


def match_tiles(args, options, cluster):
    '''One pair. Returns the exit status.'''
    import hdpstereo

    paths = [path.resolve() for path in (args.lefts, args.rights)]
    out, model = args.out.resolve(), args.out.resolve() / 'model.yml'
    (width, height), size = (size_of(path) for path in paths)
    if size != (width, height):
        raise ValueError('the images must be of one size, not %d x %d and %d x %d' % (width, height, *size))
    keep_options(out, options)
    if not model.exists():
        part = out / 'part.model.yml'
        try:
            find_model(*paths, width, height, options).save(part)
        except Exception:
            (out / 'options.json').unlink()  # nothing is made with them
            raise
        os.replace(part, model)
    if options['num_disparities'] == 0:
        found = hdpstereo.PairModel.load(model)
        options = dict(options, min_disparity=found.minDisparity, num_disparities=found.numDisparities)
        print('found disparities %d..%d' % (found.minDisparity, found.minDisparity + found.numDisparities - 1))
    tiles = {out / ('%d_%d.tif' % inside[:2]): (tile, inside) for tile, inside in cut(width, height, options)}
    missing = [path for path in tiles if not path.exists()]
    print('%d tiles, %d of them are there' % (len(tiles), len(tiles) - len(missing)))
    with Client(**cluster) as client:
        futures = [client.submit(match_tile, *paths, *tiles[path], model, path, options, pure=False)
                   for path in missing]
        for done, future in enumerate(as_completed(futures), 1):
            error = future.exception()
            if error:
                raise ValueError(error)
            print('%d/%d' % (done, len(missing)))
    put_together([(path, inside) for path, (_, inside) in tiles.items()], width, height, out / 'map.tif')
    return 0


def keep_options(out, options):
    '''What the maps of this folder were made with, so that those of other options are not taken for these.'''
    path, part = out / 'options.json', out / 'options.json.part'
    try:
        out.mkdir(parents=True, exist_ok=True)
        if not path.exists():
            part.write_text(json.dumps(options))
            os.replace(part, path)
        elif json.loads(path.read_text()) != options:
            sys.exit("error: the maps in '%s' were made with other options, see options.json: take another folder" %
                     out)
    except ValueError:
        sys.exit("error: '%s' is damaged: take another folder" % path)
    except OSError as error:
        sys.exit("error: '%s' cannot be the folder for the maps: %s" % (out, error))


def main():
    parser = argparse.ArgumentParser(description='Disparities of many rectified pairs, by a Dask cluster.')
    parser.add_argument('lefts', type=pathlib.Path, help='folder of left images, or one left image')
    parser.add_argument('rights', type=pathlib.Path, help='folder of right images, of the same names, or one')
    parser.add_argument('out', type=pathlib.Path, help='folder for the maps')
    parser.add_argument('--scheduler', help='its address; without one, a cluster of this machine')
    parser.add_argument('--workers', type=int, default=2, help='of the cluster of this machine (default: 2)')
    parser.add_argument('--preset', default='fast', choices=['ultrafast', 'fast', 'quality', 'tree', 'paper'])
    parser.add_argument('--min-disparity', type=int, default=0, help='smallest disparity (default: 0)')
    parser.add_argument('--num-disparities', type=int, default=128,
                        help='number of disparities; 0: found in the pair (default: 128)')
    parser.add_argument('--format', default='png', choices=['png', 'tif'], help='of the maps (default: png)')
    parser.add_argument('--tile', type=int, default=1152, help='side of the tiles of one pair, a multiple of 384')
    args = parser.parse_args()
    if args.num_disparities < 0 or (args.num_disparities == 0 and args.min_disparity != 0):
        sys.exit('error: --num-disparities must be > 0, or 0 without --min-disparity, which is found then, too')
    if args.min_disparity < -2047 or args.min_disparity + args.num_disparities > 2048:
        sys.exit('error: disparities must be from -2047 to 2047')
    if args.workers < 1:
        sys.exit('error: --workers must be at least 1')
    cluster = {'address': args.scheduler} if args.scheduler else {
        'n_workers': args.workers, 'threads_per_worker': 1, 'dashboard_address': None}
    out = args.out.resolve()
    if args.lefts.is_file() and args.rights.is_file():
        if any(out in (path.parent.resolve(), path.resolve().parent) for path in (args.lefts, args.rights)):
            sys.exit('error: OUT must be another folder than that of the images')
        if args.tile <= 0 or args.tile % 384 != 0:
            sys.exit('error: --tile must be a multiple of 384')
        options = {name: getattr(args, name) for name in ('preset', 'min_disparity', 'num_disparities', 'tile')}
        options.update(left=str(args.lefts.resolve()), right=str(args.rights.resolve()))
        try:
            return match_tiles(args, options, cluster)
        except (ValueError, RuntimeError, OSError) as error:
            sys.exit('error: %s' % error)
    for path, other in (args.lefts, args.rights), (args.rights, args.lefts):
        if other.is_file():
            sys.exit("error: '%s' is a file, but there is no file '%s'" % (other, path))
    for folder in args.lefts, args.rights:
        if not folder.is_dir():
            sys.exit("error: there is no folder '%s'" % folder)
    if args.format == 'png' and (args.min_disparity < 0 or args.min_disparity + args.num_disparities > 256):
        sys.exit('error: --format=png is for disparities from 0 to 255, --format=tif for any')

    lefts = sorted(path.resolve() for path in args.lefts.iterdir() if path.suffix.lower() in PICTURES)
    rights = args.rights.resolve()
    if out in (args.lefts.resolve(), rights):
        sys.exit('error: OUT must be another folder than that of the images')
    outputs = {left: out / (left.stem + '.' + args.format) for left in lefts}
    if len(set(outputs.values())) < len(lefts):
        sys.exit('error: two left images have the same name, but for its ending')
    options = {name: getattr(args, name) for name in ('preset', 'min_disparity', 'num_disparities', 'format')}
    options.update(left=str(args.lefts.resolve()), right=str(rights))
    keep_options(out, options)
    missing = [left for left in lefts if not outputs[left].exists()]
    print('%d pairs, %d of them are there' % (len(lefts), len(lefts) - len(missing)))

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
