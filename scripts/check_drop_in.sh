#!/bin/bash
# Changes two lines of OpenCV's own samples stereo_match.cpp and stereo_match.py, so that they match by HDPTreeMatcher, and
# runs them on the Aloe pair: the disparities and the point clouds must be right. The C++ one is built against the module
# as it is installed, by find_package(hdpstereo).
#   scripts/check_drop_in.sh BUILD OPENCV_SOURCE_DIR PYTHON   with a cv2 that has the module in PYTHONPATH
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

module_build=$1
samples=$2/samples
python=$3
directory=$module_build/drop_in
mkdir -p "$directory"
cd "$directory"

say "Changing two lines of stereo_match.cpp and stereo_match.py in $directory"
sed -e '/#include "opencv2\/core\/utility.hpp"/a #include "opencv2/hdpstereo.hpp"' \
    -e 's/sgbm->compute(img1, img2, disp);/stereo::HDPTreeMatcher::create(0, numberOfDisparities)->compute(img1, img2, disp);/' \
    "$samples/cpp/stereo_match.cpp" >stereo_match.cpp
sed -e "/^    print('computing disparity...')/i \\    stereo = cv.stereo.HDPTreeMatcher.create(min_disp, num_disp)" \
    -e "/^    print('computing disparity...')/i \\    stereo.setDisp12MaxDiff(1)" \
    "$samples/python/stereo_match.py" >stereo_match.py
for sample in cpp py; do
    ! diff -U0 "$samples"/*/"stereo_match.$sample" "stereo_match.$sample" >"$sample.diff" || fail "stereo_match.$sample is as it was"
    sed 1,2d "$sample.diff"
    [ "$(grep -c '^+[^+]' "$sample.diff")" -eq 2 ] || fail "stereo_match.$sample has another change than that of two lines"
done

say "Building stereo_match.cpp"
cat >CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.16)
project(drop_in CXX)
find_package(hdpstereo REQUIRED)
add_executable(stereo_match stereo_match.cpp)
target_link_libraries(stereo_match opencv_hdpstereo opencv_imgcodecs opencv_highgui)
CMAKE
{ cmake --install "$module_build" --prefix "$directory/installed" &&
    cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$directory/installed" &&
    cmake --build build; } >log 2>&1 || { tail -n 20 log >&2; fail "could not build it (all of the messages: $directory/log)"; }

# A pair that is rectified: two cameras with f = 1000, a distance of 2 apart, that look the same way
cat >intrinsics.yml <<'YAML'
%YAML:1.0
M1: !!opencv-matrix { rows: 3, cols: 3, dt: d, data: [ 1000., 0., 640.5, 0., 1000., 554.5, 0., 0., 1. ] }
D1: !!opencv-matrix { rows: 1, cols: 5, dt: d, data: [ 0., 0., 0., 0., 0. ] }
M2: !!opencv-matrix { rows: 3, cols: 3, dt: d, data: [ 1000., 0., 640.5, 0., 1000., 554.5, 0., 0., 1. ] }
D2: !!opencv-matrix { rows: 1, cols: 5, dt: d, data: [ 0., 0., 0., 0., 0. ] }
YAML
cat >extrinsics.yml <<'YAML'
%YAML:1.0
R: !!opencv-matrix { rows: 3, cols: 3, dt: d, data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ] }
T: !!opencv-matrix { rows: 3, cols: 1, dt: d, data: [ -2., 0., 0. ] }
YAML
say "Running it"
rm -f ./*.png ./*.xyz ./*.ply
build/stereo_match "$samples"/data/aloe{L,R}.jpg --max-disparity=256 --blocksize=3 -i=intrinsics.yml -e=extrinsics.yml \
    --no-display -o=disparity.png -p=points.xyz

say "Running stereo_match.py (without its windows), and checking what the two wrote"
cat >check.py <<'PYTHON'
import runpy

import cv2
import numpy as np

cv2.imshow = lambda *arguments: None
cv2.waitKey = cv2.destroyAllWindows = lambda: None
runpy.run_path('stereo_match.py', run_name='__main__')

truth = cv2.imread(cv2.samples.findFile('aloeGT.png'), cv2.IMREAD_GRAYSCALE).astype(float)
height, width = truth.shape


def check(name, disparity, truth, least_known, most_wrong):
    judged = (truth > 0) & ~np.isnan(disparity)
    known = np.count_nonzero(judged) / np.count_nonzero(truth > 0)
    wrong = np.mean(np.abs(disparity - truth)[judged] >= 2)
    print('%s: %.1f %% of the pixels with known truth have a disparity, %.1f %% of these are wrong' % (name, 100 * known, 100 * wrong))
    assert known > least_known and wrong < most_wrong


check('disparity.png', cv2.imread('disparity.png', cv2.IMREAD_GRAYSCALE) * (256 / 255.0), truth, 0.99, 0.3)

# From the points back to the disparities: Z = f * B / d, and a point's pixel is where it projects to
x, y, z = np.loadtxt('points.xyz').T
disparity = np.full(truth.shape, np.nan)
disparity[np.rint(y / z * 1000 + 554.5).astype(int), np.rint(x / z * 1000 + 640.5).astype(int)] = 2 * 1000 / z
check('points.xyz', disparity, truth, 0.99, 0.3)

with open('out.ply', 'rb') as f:
    header = f.read().split(b'end_header\n')[0].decode().splitlines()
vertices = np.loadtxt('out.ply', skiprows=len(header) + 1)
assert header[:3] == ['ply', 'format ascii 1.0', 'element vertex %d' % len(vertices)] and vertices.shape[1] == 6
x, y, z = vertices[:, :3].T
h, w = (height + 1) // 2, (width + 1) // 2
f = 0.8 * w
disparity = np.full((h, w), np.nan)
rows, columns = np.rint(0.5 * h + y / z * f).astype(int), np.rint(0.5 * w - x / z * f).astype(int)
disparity[rows, columns] = -f / z
check('out.ply', disparity, truth[::2, ::2] / 2, 0.7, 0.1)
colors = cv2.cvtColor(cv2.pyrDown(cv2.imread(cv2.samples.findFile('aloeL.jpg'))), cv2.COLOR_BGR2RGB)
assert (colors[rows, columns] == vertices[:, 3:]).all()
PYTHON
"$python" check.py
