#!/bin/bash
# Installs what is missing, builds the module and its sample, and matches a stereo pair.
#   scripts/demo.sh                         the Aloe pair of OpenCV's samples, with ground truth
#   scripts/demo.sh LEFT RIGHT [OPTION...]  a rectified pair of yours, with options of the sample (--help lists them)
# The disparity (16-bit PNG, disparity * 256, 0 where there is none) and a colour picture of it are written to demo/.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages build-essential cmake libopencv-dev

sample=example_hdpstereo_hdp_stereo_match
directory=$build/release
mkdir -p "$build"
say "Building $sample in $directory"
if ! { cmake -S "$checkout" -B "$directory" &&
    cmake --build "$directory" --parallel "$jobs" --target "$sample"; } >"$build/demo.log" 2>&1; then
    tail -n 20 "$build/demo.log" >&2
    fail "could not build $sample (all of the messages: $build/demo.log)"
fi

name=disparity
if [ $# -eq 0 ]; then
    # Debian's package opencv-doc has the pair, too.
    data=/usr/share/doc/opencv-doc/examples/data
    if [ ! -e "$data/aloeGT.png" ]; then
        find_opencv_source ||
            fail "no Aloe pair without OpenCV's source. With a pair of your own: scripts/demo.sh LEFT RIGHT"
        data=$OPENCV_SOURCE_DIR/samples/data
    fi
    name=aloe
    set -- "$data/aloeL.jpg" "$data/aloeR.jpg" --num-disparities=256 "--truth=$data/aloeGT.png"
fi

# Shown relative to the current directory if that is the checkout.
output=$checkout/demo
[ "$PWD" != "$checkout" ] || output=demo
mkdir -p "$output"
# The user's options come last, and so win over these.
set -- "--output=$output/$name.png" "--picture=$output/${name}_picture.png" "$@"
say "$sample $*"
exec "$directory/bin/$sample" "$@"
