#!/bin/bash
# Installs what is missing, builds the module with its tests against the installed OpenCV, and runs the whole suite.
#   scripts/test.sh [OPTION...]             all of it; with options of ctest, e.g. -L unit, -R Forest, -N (lists it)
#   scripts/test.sh --sanitize [OPTION...]  what runs under AddressSanitizer and UndefinedBehaviorSanitizer
#   scripts/test.sh [--sanitize] --gtest_filter=PATTERN [OPTION...]  opencv_test_hdpstereo alone, with its own options
# cmake/tests.cmake defines the suite. In the environment: HDPSTEREO_BUILD=FOLDER builds there, not in build/;
# OPENCV_SOURCE_DIR=<OpenCV's source> is used instead of Debian's source package.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

preset=release
options=()
packages=(build-essential cmake libopencv-dev)
if [ "${1:-}" = --sanitize ]; then
    preset=sanitize
    shift
    grep -q avx512_bitalg /proc/cpuinfo || options+=(-DHDPSTEREO_CPU_DISPATCH=AVX2) # the widest one that is run
else
    packages+=(python3-dev python3-numpy pybind11-dev mypy doxygen texlive-binaries libjs-mathjax
        # programs for hdpstereo-run
        python3-opencv gstreamer1.0-opencv gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good)
fi
install_packages "${packages[@]}"
cd "$checkout"
if find_opencv_source; then
    options+=("-DOPENCV_SOURCE_DIR=$(realpath "$OPENCV_SOURCE_DIR")")
    if [ "$preset" = release ] &&
        "$python" -c 'import numpy, os, sysconfig; os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null; then
        options+=("-DPython3_EXECUTABLE=$python")
        [ ! -e "$OPENCV_SOURCE_DIR/modules/python" ] || options+=(-DHDPSTEREO_PYTHON=ON)
        [ ! -e /usr/lib/cmake/pybind11 ] || options+=(-DHDPSTEREO_PYTHON_PACKAGE=ON)
    fi
fi

# Of the sanitized suite the library and the programs are sanitized. The tests of the library are not, so those that
# the release build has will do; --gtest_* runs a program that has all of them.
if [ "$preset" = sanitize ]; then
    tests_from=
    if [[ ${1:-} != --gtest_* ]] && [ -x "$build/release/bin/opencv_test_hdpstereo" ]; then
        say "Bringing the tests in $build/release up to date"
        cmake --build "$build/release" --target opencv_test_hdpstereo opencv_test_hdpstereo_tools --parallel "$jobs"
        tests_from=$build/release
    fi
    options+=("-DHDPSTEREO_TESTS_FROM=$tests_from")
fi

say "Building in $build/$preset"
time {
    configure "$preset" "${options[@]}"
    cmake --build "$build/$preset" --parallel "$jobs"
}
[ -n "${OPENCV_SOURCE_DIR:-}" ] || fail "built, but NOT tested: the test framework is in OpenCV's source"

if [[ ${1:-} == --gtest_* ]]; then
    export OPENCV_LOG_LEVEL=${OPENCV_LOG_LEVEL:-FATAL} # bad input is tested a lot
    export OPENCV_TEST_DATA_PATH=$checkout/testdata OPENCV_SAMPLES_DATA_PATH=$OPENCV_SOURCE_DIR/samples/data
    exec "$build/$preset/bin/opencv_test_hdpstereo" "$@"
fi
say "Testing"
run_ctest "$preset" --parallel "$jobs" "$@"
