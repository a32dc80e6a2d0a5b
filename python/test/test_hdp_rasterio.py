#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
samples/hdp_rasterio.py on georeferenced rasters. Run by CTest, or alone:
    PYTHONPATH=<build>/python python3 test_hdp_rasterio.py
'''

import pathlib
import subprocess
import sys
import tempfile
import warnings

try:
    import cv2
    import hdpstereo
    import numpy as np
    import rasterio
    from rasterio.control import GroundControlPoint
    from rasterio.rpc import RPC
    from rasterio.transform import from_origin
except ImportError as e:
    print('skipped: %s (on Debian: apt install python3-rasterio python3-opencv)' % e)
    sys.exit(77)

SAMPLE = pathlib.Path(__file__).resolve().parents[2] / 'samples' / 'hdp_rasterio.py'
WIDTH, HEIGHT, NO_DATA = 2000, 900, 0
TRANSFORM = from_origin(431000, 4582000, 0.5, 0.5)


def save(path, levels):
    with rasterio.open(path, 'w', driver='GTiff', dtype=levels.dtype, count=1, width=levels.shape[1],
                       height=levels.shape[0], nodata=NO_DATA, crs='EPSG:32631', transform=TRANSFORM) as out:
        out.write(levels, 1)


def make_pair(folder):
    '''Ground at a disparity of 12 with a block at 31; 16 bit, a corner without data'''
    rng = np.random.RandomState(1)
    ground = cv2.GaussianBlur(rng.randint(500, 4000, (HEIGHT, WIDTH + 64)).astype(np.uint16), (3, 3), 0)
    truth = np.full((HEIGHT, WIDTH), 12, np.float32)
    left, right = ground[:, :WIDTH].copy(), ground[:, 12:][:, :WIDTH].copy()
    block = cv2.GaussianBlur(rng.randint(500, 4000, (300, 600)).astype(np.uint16), (3, 3), 0)
    left[200:500, 900:1500], right[200:500, 869:1469] = block, block
    truth[200:500, 900:1500] = 31
    left[:100, :150] = NO_DATA
    truth[:100, :150] = np.nan
    save(folder / 'left.tif', left)
    save(folder / 'right.tif', right)
    return truth


def check_error(result, error):
    assert result.returncode == 1 and 'error: ' in result.stdout and error in result.stdout, result.stdout
    assert 'Traceback' not in result.stdout, result.stdout


def run(folder, *arguments, out='out.tif'):
    return subprocess.run([sys.executable, str(SAMPLE), 'left.tif', 'right.tif', out, '--num-disparities=64',
                           *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def load(folder):
    with rasterio.open(folder / 'out.tif') as raster:
        assert raster.crs == rasterio.crs.CRS.from_epsg(32631) and np.isnan(raster.nodata)
        return raster.read(1), raster.transform


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        truth = make_pair(folder)

        result = run(folder, '--tile=500')
        assert result.returncode == 0, result.stdout
        whole, transform = load(folder)
        assert whole.shape == truth.shape and transform == TRANSFORM
        assert np.isnan(whole[:100, :150]).all(), 'no data must have no disparity'
        judged = ~np.isnan(truth)
        judged[:, :40] = judged[200:500, 860:960] = False  # what the right raster does not show
        wrong = np.mean(~(np.abs(whole - truth)[judged] <= 0.5))
        assert wrong < 0.01, wrong

        result = run(folder, '--window=700,150,900,420')
        assert result.returncode == 0, result.stdout
        part, transform = load(folder)
        assert part.shape == (420, 900) and transform == TRANSFORM * transform.translation(700, 150)
        other = np.mean(~(np.abs(part - whole[150:570, 700:1600]) <= 0.1))
        assert other < 0.001, other

        for name in 'left.tif', 'right.tif':
            with rasterio.open(folder / name) as raster:
                levels = raster.read(1).astype(np.float32) / 4096
            save(folder / name, levels)
        result = run(folder, '--tile=500')
        assert result.returncode == 0, result.stdout
        floats, _ = load(folder)
        wrong = np.mean(~(np.abs(floats - truth)[judged] <= 0.5))
        assert np.isnan(floats[:100, :150]).all() and wrong < 0.01, wrong

        result = run(folder, '--tile=500', '--num-disparities=0')
        assert result.returncode == 0 and result.stdout.startswith('found disparities '), result.stdout
        found, _ = load(folder)
        wrong = np.mean(~(np.abs(found - truth)[judged] <= 0.5))
        assert wrong < 0.01, wrong

        with rasterio.open(folder / 'left.tif', 'r+') as raster:
            raster.rpcs = RPC(height_off=100, height_scale=50, lat_off=43, lat_scale=0.1, line_off=450, line_scale=450,
                              long_off=1.5, long_scale=0.1, samp_off=1000, samp_scale=1000,
                              line_den_coeff=[1] + [0] * 19, line_num_coeff=[0, 0, -1] + [0] * 17,
                              samp_den_coeff=[1] + [0] * 19, samp_num_coeff=[0, 1] + [0] * 18)
        assert run(folder, '--window=700,150,300,200').returncode == 0
        with rasterio.open(folder / 'out.tif') as raster:
            assert (raster.rpcs.line_off, raster.rpcs.samp_off) == (300, 300), raster.rpcs
            assert raster.transform == TRANSFORM * raster.transform.translation(700, 150)
        with rasterio.open(folder / 'left.tif', 'r+') as raster:
            raster.gcps = [GroundControlPoint(row, col, 2. + col, 48. - row) for row in (0, 800) for col in (0, 1800)
                           ], rasterio.crs.CRS.from_epsg(4326)
        assert run(folder, '--window=700,150,300,200').returncode == 0
        with rasterio.open(folder / 'out.tif') as raster:
            points, crs = raster.gcps
            assert [(p.row, p.col, p.x, p.y) for p in points][3] == (650, 1100, 1802, -752), points
            assert crs == rasterio.crs.CRS.from_epsg(4326)

        for window in '1900,0,200,100', '0,0,10', 'left':
            result = run(folder, '--window=' + window)
            assert result.returncode == 1 and 'error: --window must be X,Y,WIDTH,HEIGHT inside of 2000 x 900' in \
                result.stdout, result.stdout
        before, left = (folder / 'out.tif').read_bytes(), (folder / 'left.tif').read_bytes()
        (folder / 'folder').mkdir()
        for options, error in ((['--num-disparities=2049'], 'disparities must be from -2047 to 2047'),
                               (['--num-disparities=-1'], '--num-disparities must be > 0'),
                               (['--tile=0'], '--tile must be'),
                               (['--num-disparities=0', '--min-disparity=2'], '--num-disparities must be > 0')):
            check_error(run(folder, *options), error)
        for out, error in (('left.tif', 'OUT must not be an input'), ('folder', 'OUT must not be a folder'),
                           ('no/such/folder/out.tif', 'no/such/folder')):
            check_error(run(folder, out=out), error)
        save(folder / 'right.tif', np.ones((HEIGHT, WIDTH), np.uint8))
        check_error(run(folder), "'right.tif' must have the type and the bands of 'left.tif'")
        save(folder / 'left.tif', np.ones((HEIGHT, WIDTH), np.int16))
        save(folder / 'right.tif', np.ones((HEIGHT, WIDTH), np.int16))
        check_error(run(folder), "'left.tif' must be of uint8, uint16 or float32, not int16")
        assert (folder / 'out.tif').read_bytes() == before and not (folder / 'out.tif.part').exists()
        (folder / 'left.tif').write_bytes(left)
        save(folder / 'right.tif', np.ones((HEIGHT, 100), np.uint16))
        result = run(folder)
        assert result.returncode == 1 and "'right.tif' must have the size of 'left.tif'" in result.stdout, result.stdout
        (folder / 'right.tif').unlink()
        result = run(folder)
        assert result.returncode == 1 and 'error: right.tif' in result.stdout, result.stdout

        # The largest number of disparities; coordinates need not be there
        scene = cv2.GaussianBlur(np.random.RandomState(1).randint(0, 256, (80, 120)).astype(np.uint8), (3, 3), 0)
        cv2.imwrite(str(folder / 'left.tif'), scene[:, :100])
        cv2.imwrite(str(folder / 'right.tif'), scene[:, 7:107])
        result = run(folder, '--num-disparities=2048')
        assert result.returncode == 0 and not result.stdout, result.stdout
        disparity = cv2.imread(str(folder / 'out.tif'), cv2.IMREAD_UNCHANGED)
        assert abs(np.nanmedian(disparity[:, 20:]) - 7) < 0.5, disparity


if __name__ == '__main__':
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        main()
