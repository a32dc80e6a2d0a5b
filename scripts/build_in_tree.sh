#!/bin/bash
# Builds the module inside OpenCV, as a module of opencv_contrib: library, tests, performance tests, samples and Python
# bindings, from the source of the OpenCV version that Debian has. Runs the tests, from Python too. About ten
# minutes on two processors, most of it OpenCV itself. OPENCV_SOURCE_DIR=<OpenCV's source>: builds that one instead.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages build-essential cmake ninja-build libopencv-dev \
    python3-dev python3-numpy libtbb-dev libjpeg-dev libpng-dev zlib1g-dev

directory=$build/in-tree
if [ -z "${OPENCV_SOURCE_DIR:-}" ]; then
    fetch_tarball || fail "nothing to build without OpenCV's source"
    OPENCV_SOURCE_DIR=$build/source-${tarball##*/}
    OPENCV_SOURCE_DIR=${OPENCV_SOURCE_DIR%.orig.tar.xz}
    unpack_tarball "$OPENCV_SOURCE_DIR"
fi

# The module and what it needs, only our tests, and no optional part of OpenCV that they do not use (Debian's source
# has no 3rdparty, so some of these could not be built anyway).
options=(-DCMAKE_BUILD_TYPE=Release
    "-DOPENCV_EXTRA_MODULES_PATH=$checkout" "-DBUILD_LIST=hdpstereo,ts,python3,python_tests"
    -DOPENCV_BUILD_TEST_MODULES_LIST=hdpstereo -DOPENCV_BUILD_PERF_TEST_MODULES_LIST=hdpstereo
    -DBUILD_EXAMPLES=ON -DBUILD_opencv_apps=ON -DBUILD_JAVA=OFF
    -DPYTHON3_EXECUTABLE="$python" -DWITH_TBB=ON)
for part in IPP ITT QUIRC ADE PROTOBUF CAROTENE OPENEXR OPENJPEG JASPER TIFF WEBP FFMPEG GSTREAMER V4L 1394 GTK OPENCL \
    LAPACK; do
    options+=("-DWITH_$part=OFF")
done

say "Configuring OpenCV with this module in $directory"
cmake -S "$OPENCV_SOURCE_DIR" -B "$directory" -G Ninja "${options[@]}" >"$build/in-tree.log" 2>&1 ||
    { tail -n 20 "$build/in-tree.log" >&2; fail "cmake (all of the messages: $build/in-tree.log)"; }
sed -n '/OpenCV modules:/,/^-- *$/p' "$build/in-tree.log"
grep -q 'To be built:.* hdpstereo .*python3' "$build/in-tree.log" || fail "not all of it can be built (why: $build/in-tree.log)"
say "Building"
time cmake --build "$directory" --parallel "$jobs"

export OPENCV_LOG_LEVEL=FATAL # bad input is tested a lot
export OPENCV_TEST_DATA_PATH=$checkout/testdata OPENCV_SAMPLES_DATA_PATH=$OPENCV_SOURCE_DIR/samples/data
say "Running opencv_test_hdpstereo"
time "$directory/bin/opencv_test_hdpstereo"
say "Running opencv_perf_hdpstereo, one round of the smallest images"
time "$directory/bin/opencv_perf_hdpstereo" "--gtest_param_filter=*640x480*" \
    --perf_min_samples=1 --perf_force_samples=1
say "Running the Python tests"
(cd "$directory" && time PYTHONPATH=$directory/lib/python3 OPENCV_PYTEST_FILTER=test_hdpstereo \
    "$python" "$OPENCV_SOURCE_DIR/modules/python/test/test.py" --repo "$OPENCV_SOURCE_DIR" -v)
say "Done: $directory/lib, $directory/bin, and cv2 in $directory/lib/python3"
