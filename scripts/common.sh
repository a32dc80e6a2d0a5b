# shellcheck shell=bash
# What the other scripts share; they read this file with "source".

set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${HDPSTEREO_BUILD:-$checkout/build} # everything the scripts make is in here, but the demo's pictures
# shellcheck disable=SC2034  # for the others
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
# OPENCV_CPU_DISABLE of all instruction sets that the library is built for and this processor has, and of fewer and fewer
# shellcheck disable=SC2034
disabled_sets=("")
without=
for set_and_flag in AVX512-ICL:avx512_bitalg AVX512-SKX:avx512bw AVX2:avx2 SSE4.2:sse4_2; do
    without+=${without:+,}${set_and_flag%:*}
    ! grep -qw "${set_and_flag#*:}" /proc/cpuinfo || disabled_sets+=("$without")
done
TIMEFORMAT='   (%1R s; %1U s + %1S s of processor time)'

say()
{
    printf '== %s\n' "$*"
}

fail()
{
    printf 'error: %s\n' "$*" >&2
    exit 1
}

[[ $build == /* ]] || build=$PWD/$build

as_root()
{
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        return 1 # not root, and there is no sudo
    fi
}

# Standard input to standard output, with a line for each quarter of what apt-get or make report on stderr.
show_progress()
{
    local line what='' last=''
    local -A verbs=([dl]=downloaded [pm]=installed [make]=built)
    while IFS= read -r line; do
        if [[ $line =~ ^(dl|pm)status:.*:([0-9]+)[.][0-9]+: ]] || [[ $line =~ ^\[\ *()([0-9]+)%\] ]]; then
            what="${verbs[${BASH_REMATCH[1]:-make}]} $((BASH_REMATCH[2] / 25 * 25)) %"
            [ "$what" = "$last" ] || [[ $what == *" 0 %" ]] || printf '   %s\n' "$what" >&2
            last=$what
        fi
        [[ $line == [dp][lm]status:* ]] || printf '%s\n' "$line"
    done
}

# install_packages PACKAGE...: those that are missing.
install_packages()
{
    # Before anything that takes time: a folder that cannot be written is no fault of the network, or of the compiler.
    mkdir -p "$build" 2>/dev/null || true
    [ -w "$build" ] || fail "cannot write to $build: name another folder by HDPSTEREO_BUILD=FOLDER in the environment"
    local package missing=()
    if ! command -v apt-get >/dev/null; then
        say "No apt-get here: going on with what is installed (on Debian it would be: $*)"
        return
    fi
    for package in "$@"; do
        [[ $(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null) == ?i* ]] || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0

    local log=$build/install.log
    if as_root true; then
        say "Installing ${missing[*]} with what they need (takes a minute or two)"
        # The update's own status does not matter: the packages may be known, or in the archives that did answer.
        as_root apt-get -q update >"$log" 2>&1 || true
        if as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o APT::Status-Fd=1 install -y --no-install-recommends \
            "${missing[@]}" 2>&1 | show_progress >>"$log"; then
            return
        fi
        tail -n 5 "$log" >&2
        say "Could NOT install ${missing[*]}: no network? (all of the messages: $log)"
    else
        say "Could NOT install ${missing[*]}: neither root nor sudo"
    fi
    for package in cmake c++ make tar; do
        command -v "$package" >/dev/null || fail "nothing can be built without $package"
    done
    say "Going on with what is installed"
}

# configure PRESET [OPTION...]: as cmake --preset does, but in $build. CMake before 3.21 reads no such presets: a release
# is built without.
configure()
{
    local preset=$1 version
    shift
    version=$(cmake --version | sed -n '1s/cmake version //p')
    if [ "$(printf '%s\n' 3.21 "$version" | sort -V | head -n 1)" = 3.21 ]; then
        cmake --preset "$preset" -B "$build/$preset" "$@"
    elif [ "$preset" = release ]; then
        cmake -S "$checkout" -B "$build/$preset" -DCMAKE_BUILD_TYPE=Release "$@"
    else
        fail "the preset $preset needs CMake 3.21, this is $version"
    fi
}

# run_ctest PRESET [OPTION...]: as ctest --preset does, but in $build
run_ctest()
{
    local preset=$1 options=()
    shift
    case $preset in
    sanitize) options=(-LE slow) ;;
    tsan) options=(-L threads) ;;
    esac
    (cd "$build/$preset" && ctest --output-on-failure --no-label-summary --no-tests=error "${options[@]}" "$@")
}

# The Python that Debian's headers and numpy are for
# shellcheck disable=SC2034
python=/usr/bin/python3

# The source of the installed OpenCV, from Debian's source package. Debian's binary packages have neither OpenCV's test
# framework nor its build files nor the pictures of its samples. apt-get is given a source list of its own, so this needs
# neither root nor any change to the system.

# fetch_tarball: sets $tarball; fails if there is none.
fetch_tarball()
{
    local version upstream apt list uri size hash
    version=$(dpkg-query -W -f '${source:Version}' libopencv-dev 2>/dev/null) || return 1
    upstream=${version%-*}
    upstream=${upstream#*:}
    tarball=$build/opencv_$upstream.orig.tar.xz
    [ ! -e "$tarball" ] || return 0

    apt=$build/apt
    mkdir -p "$apt/sources" "$apt/lists/partial" "$apt/cache/archives/partial"
    for list in /etc/apt/sources.list.d/*.sources; do
        [ ! -e "$list" ] || sed 's/^Types:.*/Types: deb-src/' "$list" >"$apt/sources/${list##*/}"
    done
    cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null |
        sed -n -E 's/^deb(-src)? /deb-src /p' | sort -u >"$apt/sources/lines.list" || true

    local options=(-q -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$apt/sources"
        -o "Dir::State::Lists=$apt/lists" -o "Dir::Cache=$apt/cache"
        -o APT::Sandbox::User=root -o Acquire::Retries=2 -o Acquire::http::Timeout=30)
    apt-get "${options[@]}" update >"$apt/log" 2>&1 || true
    # Any Debian revision of this version will do, they share this file; apt-helper checks the hash.
    read -r uri _ size hash < <(
        { apt-get "${options[@]}" --print-uris --tar-only source "opencv=$version" 2>>"$apt/log" ||
            apt-get "${options[@]}" --print-uris --tar-only source opencv 2>>"$apt/log"; } |
            grep -F "/opencv_${upstream//+/%2b}.orig.tar.xz'"
    ) || true
    say "Fetching OpenCV's source, ${tarball##*/}, from Debian's archive${size:+ ($((size / 1000000)) MB)}"
    # What a release has that has come of age may have moved; the hash tells that it is the same.
    uri=${uri//\'/}
    if [ -z "$uri" ] || ! { apt_download "$uri" || apt_download "http://archive.debian.org/debian/${uri#*/debian/}"; }; then
        grep -E '^(Err:|  |W: Failed)' "$apt/log" | tail -n 2 >&2 || true
        say "Could NOT fetch it: no network? (all of the messages: $apt/log)"
        return 1
    fi
    mv "$tarball.part" "$tarball"
}

# apt_download URI: to $tarball.part, for fetch_tarball.
apt_download()
{
    /usr/lib/apt/apt-helper "${options[@]}" download-file "$1" "$tarball.part" "$hash" >>"$apt/log" 2>&1
}

# unpack_tarball DIRECTORY [PATTERN...]: the files of these names, or all. They keep their times: nothing is built anew.
unpack_tarball()
{
    local directory=$1
    shift
    [ ! -e "$directory/.unpacked" ] || [ "$(cat "$directory/.unpacked")" != "$*" ] || return 0
    say "Unpacking ${tarball##*/}"
    rm -rf "$directory.part"
    mkdir -p "$directory.part"
    tar -xf "$tarball" -C "$directory.part" --strip-components=1 --wildcards "$@" ||
        fail "$tarball does not unpack; remove it to fetch it again"
    echo "$*" >"$directory.part/.unpacked"
    rm -rf "$directory"
    mv "$directory.part" "$directory"
}

# find_opencv_source: sets OPENCV_SOURCE_DIR, if it is not set, to a directory with what tests, demo and the Python bindings
# read of it.
find_opencv_source()
{
    if [ -z "${OPENCV_SOURCE_DIR:-}" ]; then
        fetch_tarball || return 1
        local directory=${tarball##*/}
        directory=$build/${directory%.orig.tar.xz}
        unpack_tarball "$directory" '*/modules/ts/*' '*/modules/core/include/*' '*/modules/python/*' \
            '*/modules/*/misc/python/*' '*/samples/cpp/stereo_*' '*/samples/python/stereo_*' \
            '*/samples/data/aloe*' '*/samples/data/left*.jpg' '*/samples/data/right*.jpg' '*/samples/data/*trinsics.yml'
        OPENCV_SOURCE_DIR=$directory
    fi
}
