#!/bin/bash
# Builds the Debian packages, for the Debian and the OpenCV that are installed, and checks them by lintian. Installs what is
# missing. They are in build/deb; "apt install ./NAME.deb" installs one:
#   libopencv-hdpstereo*, libopencv-hdpstereo-dev   the library, and what is needed to build with it
#   hdpstereo-tools                                 programs: hdpstereo, hdpstereo-run, hdp_benchmark...
#   python3-hdpstereo                               the Python package
#   hdpstereo-doc                                   reference and tutorials
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

read -ra needed < <(sed -n 's/^Build-Depends.*: //p' "$checkout/debian/control.in" |
    sed 's/-compat ([^)]*)//' | tr -d , | paste -sd ' ')
install_packages build-essential lintian "${needed[@]}"

version=$(sed -n 's/^project(hdpstereo VERSION \([0-9.]*\).*/\1/p' "$checkout/CMakeLists.txt")
[ "$(sed -n '1s/.*(\(.*\)).*/\1/p' "$checkout/debian/changelog")" = "$version" ] ||
    fail "debian/changelog and CMakeLists.txt have different versions"

# In a copy: dpkg-buildpackage writes into the source, and beside it.
directory=$build/deb
source=$directory/hdpstereo-$version
rm -rf "$directory"
mkdir -p "$source"
tar -C "$checkout" -c --exclude-vcs --exclude='./build*' --exclude=./demo . | tar -C "$source" -x
cd "$source"
# Packages of a later Debian replace those of an earlier one.
# shellcheck source=/dev/null
sed -i "1s/($version)/($version+deb$(. /etc/os-release && echo "${VERSION_ID:-0}"))/" debian/changelog
debian/rules debian/control
say "Building packages in $directory"
DEB_BUILD_OPTIONS="parallel=$jobs noautodbgsym" dpkg-buildpackage -b --no-sign >"$directory/build.log" 2>&1 ||
    { tail -n 20 "$directory/build.log" >&2; fail "could not build them (all of the messages: $directory/build.log)"; }
say "Checking them by lintian"
lintian --allow-root --fail-on error "$directory"/*.changes
rm -rf "$source"
cd "$directory"
say "Done: in $directory"
ls -s --block-size=kB ./*.deb
