#!/bin/bash
# The long checks, one after the other, that continuous integration leaves out; a few hours in all on two processors.
#   scripts/check_all.sh [--fuzz-seconds=N] [STEP...]   all of them, or these:
#     warnings   everything built by Clang and by GCC with warnings as errors
#     widths     the unit tests with each instruction set that the library is built for
#     threads    the tests of threads under ThreadSanitizer
#     memory     10,000 calls of compute() under LeakSanitizer, and what is allocated meanwhile
#     fuzz       scripts/fuzz.sh, for 1800 s or N
#     in-tree    scripts/build_in_tree.sh
#     projects   a program that builds the module by FetchContent, as a static library
#     dask       samples/hdp_dask.py on a cluster that loses a worker
#     rasterio   samples/hdp_rasterio.py on georeferenced rasters
#     web        scripts/check_web.sh: the web page, in Chromium
#     ros        ROS 1's stereo_image_proc under hdpstereo-run
#     arm64, i386, riscv64, s390x   scripts/check_machine.sh: the same maps there, and unit tests
#     clang      unit tests of a build by Clang
#     mingw      nothing in the library keeps it from Windows: MinGW-w64 compiles it, against the headers of OpenCV
#     bullseye, bookworm, trixie   scripts/test.sh in a fresh Debian 11 (OpenCV 4.5.1, GCC 10, CMake 3.18, Python 3.9), 12
#                        or 13 (as root; mmdebstrap makes it)
#     packages-bookworm, packages-trixie   scripts/check_wheel.sh and build_deb.sh in the same way, and check_deb.sh in
#                        another fresh one
# Each step's messages are in build/check_all/STEP.log; a summary comes last, and the status is that of the worst step.
# HDPSTEREO_MMDEBSTRAP: further options of mmdebstrap. HDPSTEREO_MIRROR: Debian's archive for other machines.
# shellcheck source-path=SCRIPTDIR source=common.sh disable=SC2317
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

fuzz_seconds=1800
all_steps=(warnings widths threads memory fuzz in-tree projects dask rasterio web ros arm64 i386 riscv64 s390x clang mingw
    bullseye bookworm trixie packages-bookworm packages-trixie)
steps=()
for argument in "$@"; do
    case $argument in
    --fuzz-seconds=*) fuzz_seconds=${argument#*=} ;;
    *)
        [[ " ${all_steps[*]} " == *" $argument "* ]] || fail "no step $argument: ${all_steps[*]}"
        steps+=("$argument")
        ;;
    esac
done
[ ${#steps[@]} -gt 0 ] || steps=("${all_steps[@]}")

# build_tests DIRECTORY TARGET [OPTION...]: a build with tests, with these options of CMake.
build_tests()
{
    local directory=$1 target=$2
    shift 2
    find_opencv_source
    cmake -S "$checkout" -B "$directory" -DOPENCV_SOURCE_DIR="$OPENCV_SOURCE_DIR" "$@"
    cmake --build "$directory" --parallel "$jobs" --target "$target"
    export OPENCV_LOG_LEVEL=FATAL # bad input is tested a lot
    export OPENCV_TEST_DATA_PATH=$checkout/testdata OPENCV_SAMPLES_DATA_PATH=$OPENCV_SOURCE_DIR/samples/data
}

# Fast enough to build with a sanitizer, and to run
sanitized=(-DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1")

check_warnings()
{
    install_packages build-essential cmake clang libopencv-dev
    local compiler
    for compiler in clang++ g++; do
        say "Building with $compiler"
        build_tests "$build/warnings-$compiler" all "-DCMAKE_CXX_COMPILER=$compiler" -DHDPSTEREO_WARNINGS_AS_ERRORS=ON
    done
}

check_widths()
{
    local without
    for without in "${disabled_sets[@]}"; do
        say "OPENCV_CPU_DISABLE=$without"
        OPENCV_CPU_DISABLE=$without "$checkout/scripts/test.sh" -L unit
    done
}

check_threads()
{
    install_packages build-essential cmake libopencv-dev
    find_opencv_source
    cd "$checkout"
    configure tsan -DOPENCV_SOURCE_DIR="$OPENCV_SOURCE_DIR"
    cmake --build "$build/tsan" --parallel "$jobs" --target opencv_test_hdpstereo
    run_ctest tsan
}

check_memory()
{
    install_packages build-essential cmake libopencv-dev
    build_tests "$build/memory" opencv_test_hdpstereo -DHDPSTEREO_SANITIZE=leak "${sanitized[@]}"
    HDPSTEREO_ENDURANCE=10000 "$build/memory/bin/opencv_test_hdpstereo" '--gtest_filter=HDPStereo_Endurance*'
}

check_fuzz()
{
    "$checkout/scripts/fuzz.sh" "$fuzz_seconds"
}

check_in-tree()
{
    "$checkout/scripts/build_in_tree.sh"
}

check_projects()
{
    build_tests "$build/release" all
    "$checkout/scripts/check_other_projects.sh" "$build/release" fetch-content
}

# check_sample NAME PACKAGE...: a sample in Python that needs these packages of Debian
check_sample()
{
    local name=$1
    shift
    install_packages python3-opencv "$@"
    "$checkout/scripts/test.sh" -R "sample_$name"
    ! ctest --test-dir "$build/release" -R "sample_$name" | grep Skipped
}

check_dask()
{
    check_sample dask python3-distributed
}

check_rasterio()
{
    check_sample rasterio python3-rasterio
}

check_web()
{
    install_packages build-essential cmake libopencv-dev emscripten chromium
    build_tests "$build/release" all
    "$checkout/scripts/check_web.sh" "$build/release"
}

check_ros()
{
    install_packages build-essential cmake libopencv-dev python3-opencv ros-stereo-image-proc libstereo-image-proc-dev \
        libimage-proc-dev libnodeletlib-tools python3-rosmaster python3-rospy python3-netifaces \
        python3-sensor-msgs python3-stereo-msgs
    build_tests "$build/release" hdpstereo_preload
    "$checkout/scripts/check_run.sh" "$build/release" "$OPENCV_SOURCE_DIR" ros
}

check_arm64()
{
    "$checkout/scripts/check_machine.sh" arm64
}

check_i386()
{
    "$checkout/scripts/check_machine.sh" i386
}

check_riscv64()
{
    "$checkout/scripts/check_machine.sh" riscv64
}

check_s390x()
{
    "$checkout/scripts/check_machine.sh" s390x
}

check_clang()
{
    install_packages build-essential cmake clang libopencv-dev
    build_tests "$build/clang" opencv_test_hdpstereo -DCMAKE_CXX_COMPILER=clang++
    ctest --test-dir "$build/clang" -L unit --output-on-failure --no-tests=error --parallel "$jobs"
}

check_mingw()
{
    install_packages build-essential cmake g++-mingw-w64-x86-64-posix libopencv-dev
    cmake -S "$checkout" -B "$build/release" # makes the headers of dispatch
    local file
    for file in "$checkout"/src/*.cpp "$checkout"/src/*/*.cpp; do
        echo "$file"
        x86_64-w64-mingw32-g++-posix -fsyntax-only -std=c++11 -Wall -Wextra -Werror -D__OPENCV_BUILD=1 \
            -I"$checkout/include" -I"$checkout/src" -I"$build/release/dispatch" -idirafter /usr/include/opencv4 \
            -idirafter /usr/include/x86_64-linux-gnu/opencv4 "$file"
    done
}

# make_root SUITE: sets $root, a machine that has nothing yet but what is committed, in ~/hdpstereo.
make_root()
{
    root=$build/check_all/$1
    [ "$(id -u)" -eq 0 ] || fail "only root can make a fresh $1"
    install_packages git mmdebstrap
    rm -rf --one-file-system "$root"
    say "Making a fresh $1 in $root"
    local archive=() # Debian's own choice: updates of security, too
    [ "$1" != bullseye ] || archive=(http://deb.debian.org/debian) # has lost some of its updates of security
    # shellcheck disable=SC2086  # options
    mmdebstrap --variant=minbase ${HDPSTEREO_MMDEBSTRAP:-} "$1" "$root" "${archive[@]}"
    mkdir "$root/root/hdpstereo"
    git -c safe.directory="$checkout" -C "$checkout" archive HEAD | tar -C "$root/root/hdpstereo" -x
}

# in_root COMMANDS: in ~/hdpstereo
in_root()
{
    # What is mounted is so for this command alone.
    unshare --mount bash -e -s "$root" "$jobs" "$1" <<'COMMANDS'
mount -t proc proc "$1/proc"
mount --rbind /dev "$1/dev"
exec chroot "$1" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb \
    CMAKE_BUILD_PARALLEL_LEVEL="$2" bash -e -c "cat /etc/debian_version; cd ~/hdpstereo; $3" </dev/null
COMMANDS
}

# check_debian SUITE [SOURCE]: with the test framework of this source of OpenCV, which may be of another version; cv2's
# bindings may not.
check_debian()
{
    make_root "$1"
    if [ -n "${2:-}" ]; then
        cp -r "$2" "$root/root/opencv"
        rm -r "$root/root/opencv/modules/python"
    fi
    in_root "${2:+OPENCV_SOURCE_DIR=/root/opencv }exec scripts/test.sh"
    rm -rf --one-file-system "$root"
}

# Packages are made in one root and used in another, which has nothing of what made them.
check_packages()
{
    local debs=$build/check_all/$1.deb
    make_root "$1"
    in_root "scripts/build_deb.sh; scripts/check_wheel.sh"
    rm -rf "$debs"
    cp -r "$root/root/hdpstereo/build/deb" "$debs"
    make_root "$1"
    mkdir "$root/root/hdpstereo/build"
    mv "$debs" "$root/root/hdpstereo/build/deb"
    in_root "exec scripts/check_deb.sh"
    rm -rf --one-file-system "$root"
}

# Archives do not have the source of its OpenCV any more.
check_bullseye()
{
    install_packages libopencv-dev
    find_opencv_source || fail "there is no source of OpenCV"
    check_debian bullseye "$OPENCV_SOURCE_DIR"
}

check_bookworm()
{
    check_debian bookworm
}

check_trixie()
{
    check_debian trixie
}

check_packages-bookworm()
{
    check_packages bookworm
}

check_packages-trixie()
{
    check_packages trixie
}

mkdir -p "$build/check_all"
summary=
worst=0
for step in "${steps[@]}"; do
    log=$build/check_all/$step.log
    say "$step (messages: $log)"
    begin=$SECONDS
    # In a shell of its own and not as a condition, so that -e counts in it
    set +e
    (
        set -e
        "check_$step"
    ) >"$log" 2>&1
    status=$?
    set -e
    result=passed
    if [ "$status" -ne 0 ]; then
        result=FAILED
        worst=1
        tail -n 15 "$log"
    fi
    # What tells most of it
    detail=$(grep -aE '^\[  (PASSED|FAILED)  \]|^[0-9]+% tests passed|^[0-9]+ calls:|^Done [0-9]+ runs|^SUMMARY|WARNING: Thread' "$log" |
        sed 's/^\[  //; s/  \]//' | paste -sd ';' | cut -c1-160) || true
    summary+=$(printf '%-17s %s %6d s  %s' "$step" "$result" $((SECONDS - begin)) "$detail")$'\n'
done
say "Summary"
printf '%s' "$summary"
exit "$worst"
