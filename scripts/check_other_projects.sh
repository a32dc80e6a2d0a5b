#!/bin/bash
# Builds a program of ten lines with the module in all ways that there are, and checks that each gives the same map:
# find_package(hdpstereo) from an installation and from this build, pkg-config, and, as it takes minutes, only if asked for,
# FetchContent with a static library.
#   scripts/check_other_projects.sh BUILD [fetch-content]
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

module_build=$1
directory=$module_build/other_projects
rm -rf "$directory"
mkdir -p "$directory"
cd "$directory"
cp -r "$checkout/scripts/other_project" project

# run NAME COMMAND...: messages go to NAME.log.
run()
{
    local name=$1
    shift
    "$@" >>"$name.log" 2>&1 || { tail -n 20 "$name.log" >&2; fail "$* (all of the messages: $directory/$name.log)"; }
}

# check NAME PROGRAM: it runs, and prints what the first one has.
check()
{
    local output
    output=$("$2") || fail "$1: status $?, $output"
    printf '%-24s %s\n' "$1" "$output"
    [ "$output" = "${first:=$output}" ] || fail "$1 has another map than the first program"
}

# build NAME OPTION...: the project, with these options of CMake.
build()
{
    local name=$1
    shift
    run "$name" cmake -S project -B "$name" "$@"
    run "$name" cmake --build "$name" --parallel "$jobs"
}

run install cmake --install "$module_build" --prefix "$directory/installed"
build find_package "-DCMAKE_PREFIX_PATH=$directory/installed"
check "find_package" find_package/program
build build_tree "-Dhdpstereo_DIR=$module_build"
check "find_package, not installed" build_tree/program
for wrong in 1.0 2.999 3.0; do
    sed "s/hdpstereo 2.0/hdpstereo $wrong/" project/CMakeLists.txt >CMakeLists.txt
    cp project/program.cpp .
    ! cmake -S . -B wrong "-DCMAKE_PREFIX_PATH=$directory/installed" >wrong.log 2>&1 || fail "it is taken for version $wrong"
done

if command -v pkg-config >/dev/null; then
    PKG_CONFIG_PATH=$(dirname "$(find installed -name hdpstereo.pc)")
    export PKG_CONFIG_PATH
    pkg-config --exists 'hdpstereo >= 2.0' || fail "pkg-config finds version $(pkg-config --modversion hdpstereo)"
    # shellcheck disable=SC2046  # a list of words
    run pkg-config "${CXX:-c++}" -std=c++11 project/program.cpp -o pkg-config $(pkg-config --cflags --libs hdpstereo) \
        "-Wl,-rpath,$(pkg-config --variable=libdir hdpstereo)"
    check "pkg-config" ./pkg-config
fi

[ "${2:-}" = fetch-content ] || { say "Done"; exit 0; }

# This one builds the module as well: with as little as possible.
build fetch_content "-DHDPSTEREO_CHECKOUT=$checkout" -DBUILD_SHARED_LIBS=OFF -DCMAKE_BUILD_TYPE=Debug -DHDPSTEREO_CPU_DISPATCH=
check "FetchContent, static" fetch_content/program
[ -z "$(find fetch_content -name 'example_*' -o -name 'hdp_*' -executable -o -name 'hdpstereo-run')" ] ||
    fail "FetchContent builds samples or tools"
run fetch_content cmake --install fetch_content --prefix "$directory/installed_program"
[ "$(find installed_program -type f)" = installed_program/bin/program ] ||
    fail "FetchContent installs more than the project: $(find installed_program -type f | paste -sd ' ')"
say "Done"
