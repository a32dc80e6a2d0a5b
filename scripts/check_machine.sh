#!/bin/bash
# Builds the module for another machine, runs it under qemu, and compares the maps of all presets with this machine's, to the
# bit. Then it runs unit tests there, if that Debian has the OpenCV of this one. Works in build/machines.
#   scripts/check_machine.sh MACHINE [PATTERN]   arm64, i386, riscv64 or s390x; unit tests as ctest -R takes them
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck source=machines.sh
source "$checkout/scripts/machines.sh"

machine=${1:-}
# All that has an oracle, and the reference outputs
pattern=${2:-Cost|Aggregation|Refinement|Confidence|Prediction|Forest|Pyramid|Alignment|SupportPoints|ReferenceOutput}
find_machine "$machine"
install_packages python3-opencv
find_opencv_source || fail "no pictures without OpenCV's source"
source=$(realpath "$OPENCV_SOURCE_DIR")
directory=$build/machines/$machine
sample=example_hdpstereo_hdp_stereo_match

say "Building for this machine and for $machine"
cmake -S "$checkout" -B "$build/release"
cmake --build "$build/release" --parallel "$jobs" --target "$sample"
options=() targets=("$sample")
if [ "$(opencv_version /)" = "$(opencv_version "$sysroot")" ]; then
    options=("-DOPENCV_SOURCE_DIR=$source")
    targets+=(opencv_test_hdpstereo)
fi
cmake -S "$checkout" -B "$directory/build" "${machine_options[@]}" "${options[@]}"
cmake --build "$directory/build" --parallel "$jobs" --target "${targets[@]}"

say "Matching"
cd "$directory"
"$python" - "$source/samples/data" <<'PYTHON'
import sys
import cv2
for side in 'LR':
    image = cv2.imread('%s/aloe%s.jpg' % (sys.argv[1], side))
    cv2.imwrite(side + '.ppm', cv2.resize(image, (320, 278), interpolation=cv2.INTER_AREA))
PYTHON
for preset in ultrafast fast quality tree paper; do
    "$build/release/bin/$sample" L.ppm R.ppm --num-disparities=64 --preset=$preset here.png >here.log
    "${emulator[@]}" "build/bin/$sample" L.ppm R.ppm --num-disparities=64 --preset=$preset there.png >there.log
    cmp here.png there.png || fail "the map of $preset differs"
    say "The map of $preset is the same"
done

[ ${#options[@]} -gt 0 ] || { say "No tests: Debian has another OpenCV for $machine"; exit 0; }
say "Testing"
ctest --test-dir build -L unit -R "$pattern" --output-on-failure --no-tests=error --parallel "$jobs"
