#!/bin/bash
# Runs the fuzzers over compute() and over calibration files, with AddressSanitizer and UndefinedBehaviorSanitizer:
# fuzz/fuzz_*.cpp say what they look for.
#   scripts/fuzz.sh [SECONDS [OPTION...]]   compute() for this time (60), then files for a tenth of it, with options of
#                                           libFuzzer
#   scripts/fuzz.sh 0 FILE...               these inputs alone: of compute(), or of files if the first one's name has
#                                           "calibration" in it
# The inputs they have come to are kept in build/fuzz/corpus for the next run; one that finds something is written to
# build/fuzz/found-compute-* or found-calibration-*.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages build-essential cmake clang libclang-rt-dev libopencv-dev

seconds=${1:-60}
[ $# -eq 0 ] || shift
directory=$build/fuzz
say "Building in $directory"
cd "$checkout"
cmake --preset fuzz -B "$directory"
cmake --build "$directory" --parallel "$jobs"

asan_options=detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1:intercept_tls_get_addr=0
export ASAN_OPTIONS=$asan_options${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export UBSAN_OPTIONS=print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
fuzzer=$directory/bin/hdpstereo_fuzz
if [ "$seconds" -eq 0 ]; then
    name=compute
    [[ ${1:-} != *calibration* ]] || name=calibration
    exec "${fuzzer}_$name" "$@"
fi
for name in compute calibration; do
    [ $name = compute ] || seconds=$((seconds / 10 + 1))
    mkdir -p "$directory/corpus/$name"
    say "Fuzzing $name for $seconds s"
    "${fuzzer}_$name" "-max_total_time=$seconds" -timeout=120 -rss_limit_mb=4096 -max_len=512 -len_control=0 \
        -print_final_stats=1 "-artifact_prefix=$directory/found-$name-" "$@" "$directory/corpus/$name"
done
