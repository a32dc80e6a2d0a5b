#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
samples/hdp_dask.py on a cluster of two workers, one of which is killed on the way. Run by CTest, or alone:
    PYTHONPATH=<build>/python python3 test_hdp_dask.py
'''

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

try:
    import cv2
    import hdpstereo
    import numpy as np
    from distributed import LocalCluster
except ImportError as e:
    print('skipped: %s (on Debian: apt install python3-distributed python3-opencv)' % e)
    sys.exit(77)

SAMPLE = pathlib.Path(__file__).resolve().parents[2] / 'samples' / 'hdp_dask.py'
PAIRS = 60


def main():
    with tempfile.TemporaryDirectory() as folder, \
            LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        folder = pathlib.Path(folder)
        for name in 'lefts', 'rights':
            (folder / name).mkdir()
        rng = np.random.RandomState(1)
        for i in range(PAIRS):
            scene = cv2.GaussianBlur(rng.randint(0, 256, (480, 680, 3)).astype(np.uint8), (3, 3), 0)
            cv2.imwrite(str(folder / 'lefts' / ('%02d.png' % i)), scene[:, :640])
            cv2.imwrite(str(folder / 'rights' / ('%02d.png' % i)), scene[:, i % 40:][:, :640])
        (folder / 'rights' / '07.png').write_text('no picture')
        (folder / 'lefts' / 'readme.txt').write_text('left images')

        command = [sys.executable, str(SAMPLE), 'lefts', 'rights', 'out', '--num-disparities=64',
                   '--scheduler=' + cluster.scheduler_address]
        pid = cluster.workers[0].pid
        run = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True)
        deadline = time.time() + 120
        while len(list(folder.glob('out/*.png'))) < 4:
            assert run.poll() is None and time.time() < deadline, run.communicate()[0]
            time.sleep(0.001)
        os.kill(pid, signal.SIGKILL)
        before = len(list(folder.glob('out/*.png')))
        output = run.communicate(timeout=600)[0]
        print(output, '%d maps were there when the worker was killed' % before)
        assert before < PAIRS - 10, 'too late to matter'
        assert run.returncode == 2, run.returncode  # there is a bad pair
        assert output.count('left out') == 1 and '07.png left out: cannot read the image' in output

        for i in set(range(PAIRS)) - {7}:
            disparity = cv2.imread(str(folder / 'out' / ('%02d.png' % i)), cv2.IMREAD_UNCHANGED)
            images = [cv2.imread(str(folder / side / ('%02d.png' % i))) for side in ('lefts', 'rights')]
            expected = hdpstereo.HDPTreeMatcher.create(0, 64).compute(*images)
            assert (disparity == np.maximum(expected * 16, 1)).all(), i

        cv2.imwrite(str(folder / 'rights' / '07.png'), scene[:, 5:][:, :640])
        again = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=True).stdout
        assert again.startswith('%d pairs, %d of them are there\n1/1 07.png\n' % (PAIRS, PAIRS - 1)), again
        others = subprocess.run(command + ['--preset=quality'], cwd=folder, stderr=subprocess.PIPE, text=True,
                                check=False)
        assert others.returncode == 1 and 'made with other options' in others.stderr, others.stderr

        # 16 bit, and disparities below 0
        for side, columns in ('lefts', slice(0, 640)), ('rights', slice(20, 660)):
            (folder / 'deep' / side).mkdir(parents=True)
            grey = cv2.cvtColor(scene, cv2.COLOR_BGR2GRAY).astype(np.uint16) * 13
            cv2.imwrite(str(folder / 'deep' / side / 'a.png'), np.roll(grey, 40, 1)[:, columns])
        command[2:5] = ['deep/rights', 'deep/lefts', 'deep/out']
        subprocess.run(command + ['--min-disparity=-40', '--format=tif'], cwd=folder, check=True)
        disparity = cv2.imread(str(folder / 'deep' / 'out' / 'a.tif'), cv2.IMREAD_UNCHANGED)
        assert disparity.dtype == np.float32 and abs(np.nanmedian(disparity) + 20) < 0.5, disparity

        # Tiles of one pair, while a worker is killed; what is there is kept
        scene = cv2.GaussianBlur(rng.randint(0, 256, (1200, 1240, 3)).astype(np.uint8), (3, 3), 0)
        cv2.imwrite(str(folder / 'left.png'), scene[:, :1200])
        cv2.imwrite(str(folder / 'right.png'), scene[:, 20:1220])
        command[2:5] = ['left.png', 'right.png', 'tiles']
        command.append('--tile=384')
        pid = next(iter(cluster.workers.values())).pid
        run = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True)
        while len(list(folder.glob('tiles/*_*.tif'))) < 2:
            assert run.poll() is None and time.time() < deadline + 600, run.communicate()[0]
            time.sleep(0.001)
        os.kill(pid, signal.SIGKILL)
        print(run.communicate(timeout=600)[0])
        assert run.returncode == 0
        tiles = sorted(folder.glob('tiles/*_*.tif'))
        assert len(tiles) == 16, tiles
        whole = cv2.imread(str(folder / 'tiles' / 'map.tif'), cv2.IMREAD_UNCHANGED)
        matcher = hdpstereo.HDPTreeMatcher.create(0, 64)
        matcher.setPairModel(hdpstereo.PairModel.load(folder / 'tiles' / 'model.yml'))
        expected = matcher.compute(scene[:, :1200], scene[:, 20:1220], as_float=True)
        assert np.mean(whole != expected) < 0.001, np.mean(whole != expected)
        tiles[3].unlink()
        again = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=True).stdout
        assert again.startswith('16 tiles, 15 of them are there\n1/1\n'), again
        np.testing.assert_array_equal(whole, cv2.imread(str(folder / 'tiles' / 'map.tif'), cv2.IMREAD_UNCHANGED))

        # Grey floats, the range found once for all tiles, NaN without data; a sentence for each mistake
        scene = cv2.GaussianBlur(rng.rand(1500, 2200).astype(np.float32), (0, 0), 3)
        left = scene[:, :2100].copy()
        left[:200, :300] = np.nan
        cv2.imwrite(str(folder / 'left.tif'), left)
        cv2.imwrite(str(folder / 'right.tif'), scene[:, 20:2120])
        command[2:6] = ['left.tif', 'right.tif', 'floats', '--num-disparities=0']
        command[-1] = '--tile=1152'
        found = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=True).stdout
        first, last = (int(number) for number in found.split()[2].split('..'))
        assert found.startswith('found disparities ') and first <= 20 <= last < 100, found
        whole = cv2.imread(str(folder / 'floats' / 'map.tif'), cv2.IMREAD_UNCHANGED)
        assert np.isnan(whole[:200, :300]).all() and np.mean(abs(whole[:, 350:] - 20) < 0.5) > 0.99, whole
        for right, option, error in (('none.tif', '--tile=1152', 'none.tif'),
                                     ('left.png', '--tile=1152', 'of one size'),
                                     ('right.tif', '--min-disparity=3', '--num-disparities must be > 0, or 0 without')):
            (folder / 'none.tif').write_text('no picture')
            command[3:5] = [right, 'wrong_' + right]
            wrong = subprocess.run(command + [option], cwd=folder, stderr=subprocess.PIPE, text=True, check=False)
            assert wrong.returncode == 1 and error in wrong.stderr and 'Traceback' not in wrong.stderr, wrong.stderr
            assert not (folder / command[4]).exists() or not list((folder / command[4]).iterdir())

        # Parameters that are wrong leave nothing: the call with right ones goes on. 2048 is the largest number.
        for name, columns in ('left.tif', slice(0, 100)), ('right.tif', slice(7, 107)):
            (folder / 'small').mkdir(exist_ok=True)
            cv2.imwrite(str(folder / 'small' / name), scene[:80, columns])
            cv2.imwrite(str(folder / ('flat_' + name)), np.ones((80, 100), np.uint8))
        (folder / 'damaged').mkdir()
        (folder / 'damaged' / 'options.json').write_text('')
        (folder / 'links').mkdir()
        (folder / 'links' / '0_0.tif').symlink_to(folder / 'small' / 'left.tif')
        names, levels = set(folder.rglob('*')), (folder / 'small' / 'left.tif').read_bytes()
        left, right = 'small/left.tif', 'small/right.tif'
        for arguments, error in (
                ([left, right, 'small'], 'OUT must be another folder'),
                (['links/0_0.tif', right, 'links'], 'OUT must be another folder'),
                ([left, right, 'map', '--num-disparities=2049'], 'disparities must be from -2047 to 2047'),
                ([left, right, 'map', '--min-disparity=-2048'], 'disparities must be from -2047 to 2047'),
                ([left, right, 'none.tif'], "none.tif' cannot be the folder for the maps"),
                ([left, right, 'damaged'], "options.json' is damaged"),
                ([left, 'nothing.tif', 'map'], "'small/left.tif' is a file, but there is no file 'nothing.tif'"),
                (['nothing.tif', right, 'map'], "'small/right.tif' is a file, but there is no file 'nothing.tif'")):
            wrong = subprocess.run(command[:2] + arguments + command[6:], cwd=folder, stderr=subprocess.PIPE,
                                   text=True, check=False)
            assert wrong.returncode == 1 and wrong.stderr.startswith('error: ') and error in wrong.stderr, wrong.stderr
            assert wrong.stderr.count('\n') == 1 and set(folder.rglob('*')) == names, (wrong.stderr, arguments)
        assert (folder / 'small' / 'left.tif').read_bytes() == levels
        command[2:6] = ['flat_left.tif', 'flat_right.tif', 'map', '--num-disparities=0']
        wrong = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True, check=False)
        assert wrong.returncode == 1 and 'too few corners' in wrong.stderr, wrong.stderr
        command[2:6] = [left, right, 'map', '--num-disparities=2048']
        subprocess.run(command, cwd=folder, check=True)
        disparity = cv2.imread(str(folder / 'map' / 'map.tif'), cv2.IMREAD_UNCHANGED)
        assert abs(np.nanmedian(disparity[:, 20:]) - 7) < 0.5, disparity
        model = hdpstereo.PairModel.load(folder / 'map' / 'model.yml')
        assert model.numDisparities == 2048 and not list(folder.glob('map/*.part')), model


if __name__ == '__main__':
    main()
