#!/bin/bash
# Runs programs under hdpstereo-run as it is installed, unchanged, and checks that they match by HDPTreeMatcher; and
# that they go on with their own matcher where it cannot be replaced.
#   scripts/check_run.sh BUILD OPENCV_SOURCE_DIR PROGRAMS
#     cpp         a program of its own, with this OpenCV and with another
#     python      OpenCV's sample stereo_match.py, by Debian's python3-opencv
#     gstreamer   the element disparity of Debian's gstreamer1.0-opencv
#     ros         the node stereo_image_proc of Debian's ros-stereo-image-proc (ROS 1), with a pair that is published
# What cannot run for want of a program is skipped, with status 77.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

module_build=$1
samples=$2/samples
programs=$3
directory=$module_build/run/$programs
run="$directory/installed here/bin/hdpstereo-run" # the dynamic linker takes a space for the end of a name
rm -rf "$directory"
mkdir -p "$directory"
cd "$directory"
unset PYTHONPATH HDPSTEREO_PRESET HDPSTEREO_REPLACE HDPSTEREO_VERBOSE
export OPENCV_SAMPLES_DATA_PATH=$samples/data
cmake --install "$module_build" --prefix "$directory/installed here" >install.log

skip()
{
    echo "skipped: there is no $1"
    exit 77
}

# expect OUTPUT ERROR STATUS COMMAND...: fails unless a command writes this to stdout and one line to stderr, or none if
# ERROR is empty, and has this status. OUTPUT and ERROR are patterns.
expect()
{
    local output=$1 error=$2 expected=$3 status=0
    shift 3
    "$@" >out 2>err || status=$?
    # shellcheck disable=SC2053  # patterns
    if [[ $(<out) != $output || $(<err) != $error || $(<err) == *$'\n'* || $status -ne $expected ]]; then
        cat out err
        fail "status $status from: $*"
    fi
}

check_cpp()
{
    say "Building programs"
    cat >matchers.cpp <<'CPP'
#include "opencv2/calib3d.hpp"
#ifdef HAS_XIMGPROC
#include "opencv2/ximgproc/disparity_filter.hpp"
#endif
#include <cstdio>

// OpenCV's matchers reject the first columns, which have no room for all candidates in the right image.
const char* kind(const cv::Ptr<cv::StereoMatcher>& matcher, bool isRight = false)
{
    cv::Mat left(60, 200, CV_8U), disparity;
    cv::randu(left, 0, 256);
    const cv::Mat right = left.colRange(5, 190).clone();
    matcher->compute(left.colRange(0, 185), right, disparity);
    return disparity.at<short>(30, isRight ? 184 : 0) < matcher->getMinDisparity() * 16 ? "OpenCV" : "HDPTreeMatcher";
}

int main()
{
    const cv::Ptr<cv::StereoMatcher> sgbm = cv::StereoSGBM::create(0, 16), block = cv::StereoBM::create(16, 9);
    std::printf("sgbm:%s block:%s sgbm:%s", kind(sgbm), kind(block), kind(cv::StereoSGBM::create(0, 16)));
#ifdef HAS_XIMGPROC // a library that creates one
    std::printf(" sgbm:%s", kind(cv::ximgproc::createRightMatcher(sgbm), true));
#endif
    return 7;
}
CPP
    cat >other_opencv.cpp <<'CPP'
#include "opencv2/calib3d.hpp"
int cv::getVersionMajor() { return CV_VERSION_MAJOR; }
int cv::getVersionMinor() { return OTHER_MINOR; }
cv::Ptr<cv::StereoSGBM> cv::StereoSGBM::create(int minDisparity, int, int, int, int, int, int, int, int, int, int mode)
{
    return minDisparity == 11 && mode == 12 ? Ptr<StereoSGBM>() : Ptr<StereoSGBM>((StereoSGBM*)1, [](StereoSGBM*) {});
}
CPP
    echo '#include "opencv2/calib3d.hpp"
int main() { return cv::StereoSGBM::create(11, 1, 2, 3, 4, 5, 6, 7, 8, 9, 12).empty() ? 8 : 1; }' >other_program.cpp
    cat >CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.16)
project(run CXX)
find_package(OpenCV REQUIRED)
add_executable(matchers matchers.cpp)
target_link_libraries(matchers opencv_calib3d)
if(TARGET opencv_ximgproc)
  target_link_libraries(matchers opencv_ximgproc)
  target_compile_definitions(matchers PRIVATE HAS_XIMGPROC)
endif()
include_directories(SYSTEM ${OpenCV_INCLUDE_DIRS})
foreach(minor 99 ${OpenCV_VERSION_MINOR})
  add_library(opencv_calib3d.${minor} SHARED other_opencv.cpp)
  target_compile_definitions(opencv_calib3d.${minor} PRIVATE OTHER_MINOR=${minor})
  add_executable(other.${minor} other_program.cpp)
  target_link_libraries(other.${minor} opencv_calib3d.${minor})
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/version "${OpenCV_VERSION_MAJOR}.${OpenCV_VERSION_MINOR}")
CMAKE
    { cmake -S . -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build; } >log 2>&1 ||
        { tail -n 20 log >&2; fail "could not build them (all of the messages: $directory/log)"; }

    say "What is replaced"
    local replaced="is replaced by HDPTreeMatcher, preset" own ours
    expect 'sgbm:OpenCV block:OpenCV sgbm:OpenCV*' "" 7 build/matchers
    own=$(<out)
    ours=${own//sgbm:OpenCV/sgbm:HDPTreeMatcher}
    expect "$ours" "" 7 "$run" build/matchers
    expect "$ours" "" 7 "$module_build/bin/hdpstereo-run" build/matchers
    expect "$ours" "" 7 env HDPSTEREO_PRESET=paper "$run" sh -c build/matchers
    expect "$ours" "hdpstereo: cv::StereoSGBM $replaced fast, in matchers" 7 \
        env HDPSTEREO_VERBOSE=1 "$run" build/matchers
    expect "$ours" "hdpstereo: cv::StereoSGBM $replaced tree, in matchers" 7 \
        env HDPSTEREO_VERBOSE=1 HDPSTEREO_PRESET=tree "$run" build/matchers
    expect "${ours/block:OpenCV/block:HDPTreeMatcher}" "" 7 env HDPSTEREO_REPLACE=bm,sgbm "$run" build/matchers
    expect "${own/block:OpenCV/block:HDPTreeMatcher}" "hdpstereo: cv::StereoBM $replaced fast, in matchers" 7 \
        env HDPSTEREO_VERBOSE=1 HDPSTEREO_REPLACE=bm "$run" build/matchers

    say "What is not"
    local kept="the program keeps the matchers of its OpenCV"
    expect "$own" "hdpstereo: HDPSTEREO_PRESET must be * not best; $kept" 7 \
        env HDPSTEREO_PRESET=best "$run" build/matchers
    expect "$own" "hdpstereo: HDPSTEREO_REPLACE must be * not all; $kept" 7 \
        env HDPSTEREO_REPLACE=all "$run" build/matchers
    local version minor
    version=$(<build/version)
    for minor in 99 "${version#*.}"; do
        expect "" "" 8 "build/other.$minor"
        expect "" "hdpstereo: *calib3d.$minor.so is not of OpenCV $version with libopencv_core.so.*; $kept" 8 \
            "$run" "build/other.$minor"
    done
    find "installed here" -name libhdpstereo_adapters.so -delete
    expect "$own" "hdpstereo: *libhdpstereo_adapters.so: cannot open*; $kept" 7 "$run" build/matchers
}

check_python()
{
    "$python" -c 'import cv2' 2>/dev/null || skip python3-opencv
    cat >sample.py <<'PYTHON'
import runpy
import sys

import cv2
import numpy as np

shown = {}
cv2.imshow = lambda window, image: shown.update({window: image})
cv2.waitKey = cv2.destroyAllWindows = lambda: None
runpy.run_path(sys.argv[1], run_name='__main__')
np.save(sys.argv[2], shown['disparity'] * 96 + 16)
PYTHON
    say "Running stereo_match.py (without its windows)"
    "$python" sample.py "$samples/python/stereo_match.py" own.npy
    HDPSTEREO_VERBOSE=1 "$run" "$python" sample.py "$samples/python/stereo_match.py" replaced.npy
    "$python" - <<'PYTHON'
import cv2
import numpy as np

truth = cv2.imread(cv2.samples.findFile('aloeGT.png'), cv2.IMREAD_GRAYSCALE)[::2, ::2] / 2.0
judged = (truth >= 17) & (truth <= 110)
share = {}
for name in 'own', 'replaced':
    disparity = np.load(name + '.npy')
    known = judged & (disparity >= 16)
    wrong = np.abs(disparity - truth)[known] >= 2
    share[name] = known.sum() / judged.sum(), wrong.mean()
    print('%s: %.1f %% of the pixels have a disparity, %.1f %% of these are wrong'
          % (name, 100 * share[name][0], 100 * share[name][1]))
assert share['own'][0] < 0.7 and share['replaced'][0] > 0.9 and share['replaced'][1] < 0.06
PYTHON
}

# What the element returns is what Python gets from StereoSGBM with the element's parameters.
check_gstreamer()
{
    "$python" -c 'import cv2' 2>/dev/null || skip python3-opencv
    gst-inspect-1.0 --exists disparity 2>/dev/null || skip gstreamer1.0-opencv
    gst-inspect-1.0 --exists pngenc || skip gstreamer1.0-plugins-good
    cat >match.py <<'PYTHON'
import sys

import cv2
import numpy as np

left, right = (cv2.cvtColor(cv2.imread(side), cv2.COLOR_BGR2GRAY) for side in ('left.png', 'right.png'))
disparity = cv2.StereoSGBM_create(1, 64, 3, P1=200, P2=255, mode=cv2.StereoSGBM_MODE_HH).compute(left, right)
expected = cv2.normalize(disparity, None, 0, 255, cv2.NORM_MINMAX, cv2.CV_8U)
actual = cv2.imread(sys.argv[1])
assert (actual == expected[..., None]).all(), np.mean(actual != expected[..., None])
truth = cv2.imread('truth.png', cv2.IMREAD_GRAYSCALE) / 4.0
wrong = np.mean(np.abs(disparity / 16.0 - truth)[truth > 0] >= 2)
print('%s: %.1f %% of the pixels with known truth have none or a wrong disparity' % (sys.argv[1], 100 * wrong))
assert (wrong < 0.25) == (sys.argv[1] == 'replaced.png')
PYTHON
    "$python" - <<'PYTHON'
import cv2

for name, file in ('left', 'aloeL.jpg'), ('right', 'aloeR.jpg'), ('truth', 'aloeGT.png'):
    image = cv2.imread(cv2.samples.findFile(file))
    if name == 'truth':
        image = image[2::4, 2::4][:277, :320]
    else:
        image = cv2.resize(image, (320, 277), interpolation=cv2.INTER_AREA)
    cv2.imwrite(name + '.png', image)
PYTHON
    say "Running the element"
    # It waits for a pair after the last one, so it gets some more.
    local pipeline source prefix
    for side in left right; do
        source="filesrc location=$side.png ! pngdec ! imagefreeze num-buffers=5 ! videoconvert ! video/x-raw,format=RGB"
        pipeline+=" $source ! element.sink_$side"
    done
    for name in own replaced; do
        prefix=()
        [ "$name" = own ] || prefix=(env HDPSTEREO_VERBOSE=1 "$run")
        # shellcheck disable=SC2086  # a list of words
        timeout 60 "${prefix[@]}" gst-launch-1.0 -q $pipeline disparity name=element ! tee name=both \
            both. ! queue ! fakesink \
            both. ! queue ! videoconvert ! pngenc snapshot=false ! multifilesink "location=$name.png"
        "${prefix[@]}" "$python" match.py "$name.png"
    done
}

# As with GStreamer: the disparities of the node are what Python gets with the node's parameters.
check_ros()
{
    "$python" -c 'import cv2' 2>/dev/null || skip python3-opencv
    local node=/usr/lib/stereo_image_proc/stereo_image_proc
    [ -x $node ] || skip ros-stereo-image-proc
    [ -e /usr/share/stereo_image_proc/nodelet_plugins.xml ] || skip libstereo-image-proc-dev
    [ -e /usr/share/image_proc/nodelet_plugins.xml ] || skip libimage-proc-dev
    [ -e /usr/share/nodelet/package.xml ] || skip libnodeletlib-tools
    command -v rosmaster >/dev/null || skip python3-rosmaster
    local module
    for module in netifaces rospy sensor_msgs stereo_msgs; do
        "$python" -c "import $module" 2>/dev/null || skip "python3-${module/_/-}"
    done
    cat >pair.py <<'PYTHON'
import sys

import cv2
import numpy as np

left, right = (cv2.resize(cv2.imread(cv2.samples.findFile(file), cv2.IMREAD_GRAYSCALE), (320, 277),
                          interpolation=cv2.INTER_AREA) for file in ('aloeL.jpg', 'aloeR.jpg'))
if __name__ == '__main__':
    disparity = cv2.StereoSGBM_create(0, 64, 7, 200, 400, 1, 31, 15, 100, 4).compute(left, right)
    actual = np.load(sys.argv[1])
    assert (actual == disparity / np.float32(16)).all(), np.mean(actual != disparity / np.float32(16))
    truth = cv2.imread(cv2.samples.findFile('aloeGT.png'), cv2.IMREAD_GRAYSCALE)[2::4, 2::4][:277, :320] / 4.0
    known = (truth > 0) & (actual >= 0)
    wrong = np.mean(np.abs(actual - truth)[known] >= 2)
    print('%s: %.1f %% of the pixels have a disparity, %.1f %% of these are wrong'
          % (sys.argv[1], 100 * np.mean(actual >= 0), 100 * wrong))
    assert (np.mean(actual >= 0) > 0.8 and wrong < 0.1) == (sys.argv[1] == 'replaced.npy')
PYTHON
    cat >publish.py <<'PYTHON'
import sys

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image
from stereo_msgs.msg import DisparityImage

import pair

maps = []
rospy.init_node('publish')
rospy.Subscriber('/stereo/disparity', DisparityImage, maps.append)
publishers = {side + topic: rospy.Publisher('/stereo/' + side + topic, kind, queue_size=1)
              for side in ('left', 'right') for topic, kind in (('/image_raw', Image), ('/camera_info', CameraInfo))}
end = rospy.get_time() + 60
while not maps:
    assert rospy.get_time() < end, 'no disparities after a minute'
    for side in 'left', 'right':
        image = getattr(pair, side)
        height, width = image.shape
        message = Image(height=height, width=width, encoding='mono8', step=width, data=image.tobytes())
        baseline = 0.1 if side == 'right' else 0
        info = CameraInfo(height=height, width=width, distortion_model='plumb_bob', D=5 * [0],
                          K=[300, 0, 160, 0, 300, 138, 0, 0, 1], R=[1, 0, 0, 0, 1, 0, 0, 0, 1],
                          P=[300, 0, 160, -300 * baseline, 0, 300, 138, 0, 0, 0, 1, 0])
        message.header.stamp = info.header.stamp = rospy.Time(1)
        publishers[side + '/image_raw'].publish(message)
        publishers[side + '/camera_info'].publish(info)
    rospy.sleep(0.2)
image = maps[0].image
np.save(sys.argv[1], np.frombuffer(image.data, np.float32).reshape(image.height, image.step // 4)[:, :image.width])
PYTHON
    local port prefix
    port=$("$python" -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
    export ROS_MASTER_URI=http://localhost:$port ROS_HOSTNAME=localhost
    export ROS_HOME=$directory/ros ROS_PACKAGE_PATH=/usr/share
    rosmaster --core -p "$port" >master.log 2>&1 &
    trap 'kill $(jobs -p)' EXIT
    for name in own replaced; do
        say "Running the node ($name)"
        prefix=()
        [ "$name" = own ] || prefix=(env HDPSTEREO_VERBOSE=1 "$run")
        # It takes its parameters when it starts.
        ROS_NAMESPACE=stereo "${prefix[@]}" "$node" __name:="$name" _stereo_algorithm:=1 _correlation_window_size:=7 \
            _disp12MaxDiff:=1 >"$name.log" 2>&1 &
        timeout 120 "$python" publish.py "$name.npy"
        kill %?node
        grep '^hdpstereo:' "$name.log" || [ "$name" = own ]
        "${prefix[@]}" "$python" pair.py "$name.npy"
    done
}

"check_$programs"
