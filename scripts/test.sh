#!/bin/bash
# Installs what is missing, builds the module with its tests against the installed OpenCV, and runs them.
#   scripts/test.sh                       tests, those from Python too, OpenCV's samples with this matcher, one short round
#                                         of the performance tests, and the documentation
#   scripts/test.sh --sanitize            tests but the slow ones, under AddressSanitizer and UndefinedBehaviorSanitizer,
#                                         and the samples: one on a full-size pair, the benchmark on a small one
#   scripts/test.sh [--sanitize] OPTION...  the tests alone, with these options of theirs, e.g. --gtest_filter=...
# OPENCV_SOURCE_DIR=<OpenCV's source> in the environment: uses that one instead of Debian's source package.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

sanitize=
if [ "${1:-}" = --sanitize ]; then
    sanitize=1
    shift
fi

passed=0
failed=0

# run_tests PROGRAM [OPTION...]: adds to the counts. A program that dies counts as a failed test.
run_tests()
{
    local program=$1 log status=0 ok skipped bad
    shift
    log=$directory/${program##*/}.log
    time "$program" "$@" 2>&1 | tee "$log" || status=$?
    ok=$(grep -c '^\[       OK \]' "$log") || true
    skipped=$(grep -c '^\[     SKIP \]' "$log") || true
    bad=$(grep -c '^\[  FAILED  \].* ms)$' "$log") || true
    if ! grep -q '^\[==========\] .* ran\.' "$log" || { [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; }; then
        say "${program##*/} died, or ended wrongly, with status $status"
        bad=$((bad + 1))
    fi
    [ "$skipped" -eq 0 ] || say "$skipped tests of ${program##*/} skipped themselves, for want of data"
    passed=$((passed + ok - skipped))
    failed=$((failed + bad))
}

# compare_instruction_sets PROGRAM: one more test, that the reference maps are the same to the bit, whichever of the
# instruction sets that the library is built for is used.
compare_instruction_sets()
{
    local program=$1 maps=$directory/maps without status=0
    rm -rf "$maps"
    for without in "${disabled_sets[@]}"; do
        mkdir -p "$maps/without-$without"
        OPENCV_CPU_DISABLE=$without HDPSTEREO_WRITE_REFERENCE=$maps/without-$without \
            "$program" '--gtest_filter=HDPStereo_ReferenceOutput*' >"$maps/without-$without.log" 2>&1 || status=1
        [ -n "$(ls "$maps/without-$without")" ] && diff -r "$maps/without-" "$maps/without-$without" || status=1
    done
    if [ "$status" -eq 0 ]; then
        passed=$((passed + 1))
    else
        say "the reference maps depend on the instruction set, or are not written; see $maps"
        failed=$((failed + 1))
    fi
}

# run_python_tests: adds to the counts, as run_tests does.
run_python_tests()
{
    local log=$directory/python.log status=0 total bad skipped
    time PYTHONPATH=$directory/lib/python3 OPENCV_LOG_LEVEL=FATAL \
        "$python" "$checkout/misc/python/test/test_hdpstereo.py" --verbose 2>&1 | tee "$log" || status=$?
    total=$(sed -n -E 's/^Ran ([0-9]+) tests? in .*/\1/p' "$log")
    bad=$(sed -n -E 's/^FAILED \((.*)\)$/\1/p' "$log" | tr ',' '\n' | sed -n -E 's/^ *(failures|errors)=//p' | paste -sd+)
    skipped=$(sed -n -E 's/^(OK|FAILED) \(.*skipped=([0-9]+).*\)$/\2/p' "$log")
    bad=$((${bad:-0}))
    if [ -z "$total" ] || { [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; }; then
        say "the Python tests died, or ended wrongly, with status $status"
        total=$((${total:-0} + 1))
        bad=$((bad + 1))
    fi
    [ "${skipped:-0}" -eq 0 ] || say "$skipped Python tests skipped themselves"
    passed=$((passed + total - bad - ${skipped:-0}))
    failed=$((failed + bad))
}

install_packages build-essential cmake libopencv-dev python3-dev python3-numpy

directory=$build/release
options=()
python_options=()
if [ -z "$sanitize" ]; then
    if "$python" -c 'import numpy, os, sysconfig; os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null; then
        python_options=(-DHDPSTEREO_PYTHON=ON "-DPython3_EXECUTABLE=$python")
    else
        say "No python3-dev or no python3-numpy: NOT testing from Python"
    fi
fi
targets=(all)
if [ -n "$sanitize" ]; then
    directory=$build/sanitize
    options=("-DHDPSTEREO_SANITIZE=address,undefined" -DCMAKE_BUILD_TYPE=RelWithDebInfo
        "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1")
    targets=(opencv_test_hdpstereo opencv_test_hdpstereo_tools example_hdpstereo_hdp_stereo_match hdp_benchmark)
fi

if ! find_opencv_source; then
    say "Without it there is no test framework: building the library and the samples only"
    cmake -S "$checkout" -B "$directory" "${options[@]}"
    cmake --build "$directory" --parallel "$jobs"
    fail "built, but NOT tested"
fi

say "Building in $directory"
time {
    cmake -S "$checkout" -B "$directory" -DOPENCV_SOURCE_DIR="$OPENCV_SOURCE_DIR" "${options[@]}" "${python_options[@]}"
    cmake --build "$directory" --parallel "$jobs" --target "${targets[@]}"
}

export OPENCV_TEST_DATA_PATH=$checkout/testdata                # reference data
export OPENCV_SAMPLES_DATA_PATH=$OPENCV_SOURCE_DIR/samples/data # the Aloe pair
if [ -n "$sanitize" ]; then
    # opencv_ts catches SIGSEGV, which would hide where it came from.
    export ASAN_OPTIONS=handle_segv=2:detect_stack_use_after_return=1:strict_string_checks=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
    export UBSAN_OPTIONS=print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
fi

if [ -n "$sanitize" ] && [ $# -eq 0 ]; then
    say "Matching the Aloe pair at full size under the sanitizers"
    "$directory/bin/example_hdpstereo_hdp_stereo_match" "$OPENCV_SAMPLES_DATA_PATH"/aloe{L,R}.jpg --num-disparities=256 \
        "--truth=$OPENCV_SAMPLES_DATA_PATH/aloeGT.png" "--output=$directory/aloe.png" "--picture=$directory/aloe_picture.png"
    say "The benchmark on a small pair under the sanitizers (its figures mean nothing)"
    "$directory/bin/hdp_benchmark" "$OPENCV_SAMPLES_DATA_PATH"/aloe{L,R}.jpg --resize=160x136 \
        --num-disparities=32 "--truth=$OPENCV_SAMPLES_DATA_PATH/aloeGT.png" --runs=2 --stages
    # These would take ten minutes: all nine systems at full size, most of them over the full range.
    set -- '--gtest_filter=-HDPStereo_Slow*'
    say "Running the tests but HDPStereo_Slow* under the sanitizers"
else
    say "Running the tests${sanitize:+ under the sanitizers}"
fi
run_tests "$directory/bin/opencv_test_hdpstereo" "$@"
if [ $# -eq 0 ] || [ -n "$sanitize" ]; then
    run_tests "$directory/bin/opencv_test_hdpstereo_tools"
fi
if [ -z "$sanitize" ] && [ $# -eq 0 ]; then
    if [ ${#python_options[@]} -gt 0 ]; then
        say "Running the Python tests"
        run_python_tests
        say "Running OpenCV's stereo_match samples with this matcher"
        if time "$checkout/scripts/check_drop_in.sh"; then
            passed=$((passed + 1))
        else
            say "scripts/check_drop_in.sh failed"
            failed=$((failed + 1))
        fi
    fi
    say "Comparing the reference maps between instruction sets"
    compare_instruction_sets "$directory/bin/opencv_test_hdpstereo"
fi
if [ -z "$sanitize" ] && [ $# -eq 0 ] && [ -x "$directory/bin/opencv_perf_hdpstereo" ]; then
    say "Running the performance tests, one round of the smallest images"
    run_tests "$directory/bin/opencv_perf_hdpstereo" "--gtest_param_filter=*640x480*" \
        --perf_min_samples=1 --perf_force_samples=1
fi
if [ -z "$sanitize" ] && [ $# -eq 0 ]; then
    say "Making the documentation"
    install_packages doxygen texlive-binaries
    if ! command -v doxygen >/dev/null || ! command -v bibtex >/dev/null; then
        say "NOT checked: there is no doxygen, or no bibtex"
    elif "$checkout/scripts/docs.sh"; then
        passed=$((passed + 1))
    else
        say "the documentation has warnings"
        failed=$((failed + 1))
    fi
fi

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
