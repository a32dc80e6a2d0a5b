#!/bin/bash
# Runs the fuzzer over compute(), with AddressSanitizer and UndefinedBehaviorSanitizer: fuzz/fuzz_compute.cpp says what
# it looks for.
#   scripts/fuzz.sh [SECONDS [OPTION...]]   for this time (60), with options of libFuzzer
#   scripts/fuzz.sh 0 FILE...               these inputs alone
# The inputs it has come to are kept in build/fuzz/corpus for the next run; one that finds something is written to
# build/fuzz/found-*.
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

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export UBSAN_OPTIONS=print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
fuzzer=$directory/bin/hdpstereo_fuzz_compute
if [ "$seconds" -eq 0 ]; then
    exec "$fuzzer" "$@"
fi
mkdir -p "$directory/corpus"
say "Fuzzing for $seconds s"
"$fuzzer" "-max_total_time=$seconds" -timeout=120 -rss_limit_mb=4096 -max_len=512 -len_control=0 -print_final_stats=1 \
    "-artifact_prefix=$directory/found-" "$@" "$directory/corpus"
