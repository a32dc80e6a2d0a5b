#!/bin/bash
# Installs what is missing, builds the module and its program, and matches a stereo pair, by StereoSGBM, too.
#   scripts/demo.sh                         the Aloe pair of OpenCV's samples, with ground truth
#   scripts/demo.sh LEFT RIGHT [OPTION...]  a rectified pair of yours, with options of the program (--help lists them)
# The disparity (16-bit PNG, disparity * 256, 0 where there is none) and a picture of the left image, of what StereoSGBM
# has (rejected pixels black) and of the disparity in colours are written to demo/.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages build-essential cmake libopencv-dev

program=hdpstereo
directory=$build/release
say "Building $program in $directory"
if ! { cmake -S "$checkout" -B "$directory" &&
    cmake --build "$directory" --parallel "$jobs" --target "${program}_program"; } 2>&1 | show_progress >"$build/demo.log"; then
    tail -n 20 "$build/demo.log" >&2
    fail "could not build $program (all of the messages: $build/demo.log)"
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
[ -z "${HDPSTEREO_BUILD:-}" ] || output=$build/demo
mkdir -p "$output"
picture=$output/${name}_picture.png
rm -f "$picture"
# The user's options come last, and so win over these.
set -- "--output=$output/$name.png" "--picture=$picture" --compare "$@"
say "$program $*"
"$directory/bin/$program" "$@"
[ -e "$picture" ] || exit 0
say "Look at $picture: near is orange, far is blue"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open >/dev/null; then
    xdg-open "$picture" >/dev/null 2>&1 || true
fi
