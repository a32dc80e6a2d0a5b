#!/bin/bash
# The reference maps must be the same to the bit, whichever of the instruction sets that the library is built for is used.
#   scripts/check_instruction_sets.sh PROGRAM DIRECTORY   opencv_test_hdpstereo, and a directory for its maps
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

program=$1
maps=$2
rm -rf "$maps"
for without in "${disabled_sets[@]}"; do
    directory=$maps/without-$without
    mkdir -p "$directory"
    OPENCV_CPU_DISABLE=$without HDPSTEREO_WRITE_REFERENCE=$directory "$program" \
        '--gtest_filter=*HDPStereo_ReferenceOutput*' >"$directory.log" 2>&1 || fail "see $directory.log"
    [ -n "$(ls "$directory")" ] || fail "no maps are written, see $directory.log"
    diff -r "$maps/without-" "$directory" || fail "the maps depend on the instruction set"
done
say "$(find "$maps/without-" -type f | wc -l) maps, the same with ${#disabled_sets[@]} choices of instruction sets"
