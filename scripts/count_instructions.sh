#!/bin/bash
# Counts the instructions of a frame, per pixel, of FAST and of SGBM_3WAY under qemu, as a table for BENCHMARK.md. These are
# instructions, not times: neither what each takes nor the memory counts. Works in build/machines.
#   scripts/count_instructions.sh [OPTION...] [MACHINE...]   arm64 and amd64, or others that check_machine.sh knows
#     --functions=N             and the functions that take at least N percent of FAST's
#     --sizes=W,H,DISPARITIES   or several of them in quotes; the default has those of robots
#     --rate=N                  millions of instructions in a second of the model of a frame's time on arm64
# The model is all instructions at one rate. Its default, 4800, is ASSUMED, not measured: two instructions in each cycle of
# a Cortex-A76 at 2.4 GHz, as in a Raspberry Pi 5, which could take four at best. It says what to expect by a factor of
# two, and compares methods as far as they are alike.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck source=machines.sh
source "$checkout/scripts/machines.sh"

share=
sizes="160,139,32 320,278,64 640,480,64 1280,720,128"
rate=4800
while [[ ${1:-} == --* ]]; do
    case $1 in
    --functions=*) share=${1#*=} ;;
    --sizes=*) sizes=${1#*=} ;;
    --rate=*) rate=${1#*=} ;;
    *) fail "no option $1: --functions=, --sizes= or --rate=" ;;
    esac
    shift
done
[ $# -gt 0 ] || set -- arm64 amd64
install_packages python3-opencv
find_opencv_source || fail "no pictures without OpenCV's source"
pictures=$build/machines
mkdir -p "$pictures"
# shellcheck disable=SC2086  # a list of words
"$python" - "$OPENCV_SOURCE_DIR/samples/data" "$pictures" $sizes <<'PYTHON'
import sys
import cv2
for side in 'LR':
    image = cv2.imread('%s/aloe%s.jpg' % (sys.argv[1], side))
    for size in sys.argv[3:]:
        width, height, _ = map(int, size.split(','))
        cv2.imwrite('%s/%s%d.ppm' % (sys.argv[2], side, width), cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA))
PYTHON

# count WIDTH DISPARITIES METHOD [SHARE]: instructions per pixel and frame
count()
{
    local frames pixels
    for frames in 1 2; do
        pixels=$(INSTRUCTIONS_OUT=$directory/$frames.txt "${emulator[@]}" -plugin "$directory/plugin.so" "$directory/frames" \
            "$pictures/L$1.ppm" "$pictures/R$1.ppm" "$2" "$3" "$frames")
    done
    "$python" "$checkout/scripts/instructions/report.py" "$pixels" nm "$directory/frames" "$directory/1.txt" \
        "$directory/2.txt" ${4:+"$4"}
}

table="| machine | image, disparities | FAST | without alignment | SGBM_3WAY | FAST / SGBM_3WAY | without alignment | \
model: FAST ms | SGBM_3WAY ms |
|---|---|---|---|---|---|---|---|---|
"
for machine in "$@"; do
    find_machine "$machine"
    directory=$build/machines/$machine
    say "Building for $machine" >&2
    mkdir -p "$directory"
    { cmake -S "$checkout" -B "$directory/build" "${machine_options[@]}" &&
        cmake --build "$directory/build" --parallel "$jobs" --target opencv_hdpstereo; } >"$directory/build.log" 2>&1 ||
        { tail -n 20 "$directory/build.log"; fail "could not build it"; }
    version=1 # of what qemu 7 and 8 know
    [[ $("${emulator[0]}" --version) =~ version\ [78][.] ]] || version=2
    cc -shared -fPIC -O2 "-DPLUGIN_VERSION=$version" -Wl,--allow-shlib-undefined "$checkout/scripts/instructions/plugin.c" \
        -o "$directory/plugin.so"
    "$compiler" "${compiler_options[@]}" -O2 -std=c++11 -I"$checkout/include" -I"$sysroot/usr/include/opencv4" \
        "$checkout/scripts/instructions/frames.cpp" "$directory/build/lib/libopencv_hdpstereo.a" \
        -lopencv_calib3d -lopencv_ml -lopencv_imgproc -lopencv_core -o "$directory/frames"
    for size in $sizes; do
        IFS=, read -r width height disparities <<<"$size"
        fast=$(count "$width" "$disparities" fast)
        sgbm=$(count "$width" "$disparities" sgbm-3way)
        unaligned=$(count "$width" "$disparities" unaligned)
        model="| " # of one machine only
        [ "$machine" != arm64 ] ||
            model=$(awk "BEGIN { t = $width * $height / $rate / 1000; printf \"%.1f | %.1f\", $fast * t, $sgbm * t }")
        table+=$(printf '| %s | %s | %s | %s | %s | %s | %s |' "$machine" "$width x $height, $disparities" "$fast" \
            "$unaligned" "$sgbm" "$(awk "BEGIN { printf \"%.2f | %.2f\", $fast / $sgbm, $unaligned / $sgbm }")" \
            "$model")$'\n'
        [ -z "$share" ] || count "$width" "$disparities" fast "$share"
    done
done
printf '%s' "$table"
