#!/bin/bash
# Installs the packages that scripts/build_deb.sh has made, uses all of them, and removes them: for a machine that has
# nothing of them, such as one that scripts/check_all.sh makes.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=("$build"/deb/*.deb)
mapfile -t names < <(for package in "${packages[@]}"; do dpkg-deb -f "$package" Package; done)
install_packages build-essential cmake pkgconf
say "Installing ${names[*]}"
as_root apt-get -qq update
as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${packages[@]}" >"$build/deb/install.log" 2>&1 ||
    { tail -n 20 "$build/deb/install.log" >&2; fail "could not install them"; }
mapfile -t files < <(dpkg -L "${names[@]}" | grep -vx /. | sort -u)

directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
cd "$directory"
cp "$checkout"/scripts/other_project/* .
say "A program, by CMake, pkg-config, and with the static library"
{ cmake -S . -B cmake && cmake --build cmake; } >log 2>&1 || { cat log >&2; fail "CMake"; }
# shellcheck disable=SC2046  # lists of words
{
    c++ program.cpp -o pkg-config $(pkg-config --cflags --libs hdpstereo)
    c++ program.cpp -o static $(pkg-config --cflags hdpstereo) \
        $(pkg-config --static --libs hdpstereo | sed 's/-lopencv_hdpstereo/-l:libopencv_hdpstereo.a/')
}
expected=$(cmake/program)
for program in cmake/program ./pkg-config ./static; do
    [ "$($program)" = "$expected" ] || fail "$program prints another map"
done
# Not grep -q, which ends while the other side of the pipe still writes
ldd ./pkg-config | grep libopencv_hdpstereo >log || fail "pkg-config does not link the shared library"
! ldd ./static | grep hdpstereo || fail "the static library is not linked"

say "Programs"
"$python" - <<'PYTHON'
import hdpstereo
import numpy as np

scene = np.random.RandomState(1).randint(0, 256, (60, 200, 3)).astype(np.uint8)
left, right = scene[:, :190].copy(), scene[:, 5:195].copy()
for name, image in ('left', left), ('right', right):
    with open(name + '.ppm', 'wb') as f:
        f.write(b'P6 190 60 255\n' + image[:, :, ::-1].tobytes())
disparity = hdpstereo.HDPTreeMatcher(0, 16).compute(left, right)
assert (np.abs(disparity[5:-5, 10:-10] - 80) <= 8).mean() > 0.95
np.where(disparity <= 0, 1, disparity * 16).astype('>u2').tofile('expected.raw')
PYTHON
hdpstereo left.ppm right.ppm --num-disparities=16 --output=disparity.png --picture=picture.png
[ "$(head -c 4 disparity.png | tail -c 3)" = PNG ] || fail "hdpstereo writes no picture"
[ "$(hdpstereo-run printenv LD_PRELOAD)" = "/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/hdpstereo/libhdpstereo_preload.so" ] ||
    fail "hdpstereo-run does not preload"
for program in $(dpkg -L hdpstereo-tools | sed -n 's#^/usr/bin/##p'); do
    "$program" --help >/dev/null || fail "$program --help"
    dpkg -L hdpstereo-tools | grep -x "/usr/share/man/man1/$program.1.gz" >log || fail "no man page of $program"
done

say "Python"
"$python" "$checkout/python/test/test_hdpstereo.py"
[ -e /usr/share/doc/hdpstereo-doc/html/index.html ] || fail "no documentation"

say "Removing them"
as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq purge -y "${names[@]}" >"$build/deb/purge.log"
left=()
for file in "${files[@]}"; do
    # Directories of other packages stay.
    [ ! -e "$file" ] && [ ! -L "$file" ] || dpkg -S "$file" >/dev/null 2>&1 || left+=("$file")
done
mapfile -t -O ${#left[@]} left < <(find / -xdev \( -path "$checkout" -o -path "$directory" -o -path /proc \) -prune -o \
    \( -name '*hdpstereo*' -o -name 'hdp_*' \) -print)
[ ${#left[@]} -eq 0 ] || fail "left behind: ${left[*]}"
say "Done: all of them work, and nothing is left"
