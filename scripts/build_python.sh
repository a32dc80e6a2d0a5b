#!/bin/bash
# Builds a Python module cv2 in which cv2.stereo.HDPTreeMatcher is, against the installed OpenCV: OpenCV itself is not
# built. Installs what is missing. A minute of processor time the first time, seconds when nothing has changed.
#   scripts/build_python.sh               builds it, matches a pair as a check, and says how to use it
#   scripts/build_python.sh FILE [ARG...] builds it, and runs FILE with it, e.g. samples/hdp_stereo_match.py
# The module is made of OpenCV's main modules (not dnn, gapi, stitching and those of opencv_contrib) and is used by
# PYTHONPATH alone; the system's cv2 stays as it is. OPENCV_SOURCE_DIR=<OpenCV's source> in the environment: uses that one
# instead of Debian's source package.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages build-essential cmake libopencv-dev python3-dev python3-numpy
find_opencv_source || fail "no Python bindings without OpenCV's source"

directory=$build/release
say "Building cv2 in $directory"
if ! { cmake -S "$checkout" -B "$directory" -DOPENCV_SOURCE_DIR="$OPENCV_SOURCE_DIR" -DHDPSTEREO_PYTHON=ON \
        -DPython3_EXECUTABLE="$python" &&
    cmake --build "$directory" --parallel "$jobs" --target opencv_python3; } 2>&1 | show_progress >"$build/python.log"; then
    tail -n 20 "$build/python.log" >&2
    fail "could not build cv2 (all of the messages: $build/python.log)"
fi

export PYTHONPATH=$directory/lib/python3${PYTHONPATH:+:$PYTHONPATH}
export OPENCV_SAMPLES_DATA_PATH=${OPENCV_SAMPLES_DATA_PATH:-$OPENCV_SOURCE_DIR/samples/data}
if [ $# -gt 0 ]; then
    exec "$python" "$@"
fi

"$python" - <<'PYTHON'
import cv2

matcher = cv2.stereo.HDPTreeMatcher.create(0, 256)
assert isinstance(matcher, cv2.StereoMatcher)
left, right = (cv2.imread(cv2.samples.findFile("aloe" + side + ".jpg")) for side in "LR")
disparity = matcher.compute(left, right)
print("cv2 %s in %s: %d x %d disparities, %s"
      % (cv2.__version__, cv2.__file__, disparity.shape[1], disparity.shape[0], disparity.dtype))
PYTHON
say "To use it: PYTHONPATH=$directory/lib/python3 $python"
