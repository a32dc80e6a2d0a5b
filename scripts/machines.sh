# shellcheck shell=bash disable=SC2054,SC2154
# Builds for other machines, by Debian's cross compilers, and runs under qemu; scripts read this file with "source", after
# common.sh.

# find_machine NAME: sets $sysroot; $emulator, a command and its options; $compiler and $compiler_options to build a program,
# $machine_options of CMake. Makes a sysroot and installs what is missing. amd64 is this machine, under qemu all the same.
find_machine()
{
    local name=$1 processor suite triplet packages=(build-essential cmake libopencv-dev)
    sysroot=$build/machines/$name/sysroot
    # shellcheck source=/dev/null
    suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
    case $name in
    amd64) processor=x86_64 ;;
    arm64) processor=aarch64 ;;
    i386) processor=i686 ;;
    s390x) processor=s390x ;;
    riscv64)
        processor=riscv64
        [ "$suite" != bookworm ] || suite=trixie # the first Debian with this machine
        ;;
    *) fail "no machine $name: arm64, i386, riscv64, s390x" ;;
    esac
    triplet=$processor-linux-gnu
    emulator=("qemu-${processor/i686/i386}")
    machine_options=(-DBUILD_SHARED_LIBS=OFF -DHDPSTEREO_PRELOAD=OFF -DHDPSTEREO_INSTALL=OFF
        -DCMAKE_POSITION_INDEPENDENT_CODE=OFF) # functions are where the symbols say
    packages+=(qemu-user)
    if [ "$name" = amd64 ]; then
        install_packages "${packages[@]}"
        sysroot=
        compiler=c++
        compiler_options=(-no-pie)
        machine_options+=("-DCMAKE_EXE_LINKER_FLAGS=-no-pie")
        return
    fi
    install_packages "${packages[@]}" mmdebstrap "g++-${triplet//_/-}"

    local libraries=$sysroot/usr/lib/${triplet/i686/i386} link
    if [ ! -e "$sysroot/.made" ]; then
        say "Making $sysroot"
        rm -rf --one-file-system "$sysroot"
        mkdir -p "$sysroot"
        # Without an address apt-get would want all of the archives that this machine uses.
        # shellcheck disable=SC2086  # options
        mmdebstrap --variant=extract --architectures="$name" --include=libopencv-dev ${HDPSTEREO_MMDEBSTRAP:-} "$suite" \
            "$sysroot" "${HDPSTEREO_MIRROR:-http://deb.debian.org/debian}"
        # What packages do when they are configured, and links that would lead out
        ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$libraries"
        [ -e "$sysroot/lib" ] || ln -s usr/lib "$sysroot/lib"
        find "$sysroot/usr/lib" -type l -lname '/*' | while IFS= read -r link; do
            ln -sfn "$sysroot$(readlink "$link")" "$link"
        done
        touch "$sysroot/.made"
    fi
    emulator+=(-L "$sysroot")
    compiler=$triplet-g++
    # libraries of another compiler's version are among them
    compiler_options=("--sysroot=$sysroot" -no-pie "-L$libraries" "-Wl,-rpath-link,$libraries" -Wl,--allow-shlib-undefined)
    machine_options+=(-DCMAKE_SYSTEM_NAME=Linux "-DCMAKE_SYSTEM_PROCESSOR=$processor" "-DCMAKE_SYSROOT=$sysroot"
        "-DCMAKE_CXX_COMPILER=$compiler" "-DCMAKE_CROSSCOMPILING_EMULATOR=$(IFS=';' && echo "${emulator[*]}")"
        -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY
        -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY
        "-DCMAKE_EXE_LINKER_FLAGS=${compiler_options[*]:1}")
}

# opencv_version ROOT: of the OpenCV below this folder
opencv_version()
{
    sed -n 's/#define CV_VERSION_\(MAJOR\|MINOR\|REVISION\) *//p' "$1/usr/include/opencv4/opencv2/core/version.hpp" | paste -sd .
}
