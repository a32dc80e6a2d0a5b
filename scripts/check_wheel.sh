#!/bin/bash
# Builds a wheel of the Python package against the installed OpenCV, by pip and without a network, installs it in a virtual
# environment, and runs its tests. Installs what is missing.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

backend=python3-scikit-build-core
! grep -q '^VERSION_ID="12"' /etc/os-release || backend=python3-skbuild
install_packages build-essential cmake ninja-build libopencv-dev pybind11-dev mypy \
    python3-dev python3-numpy python3-setuptools python3-venv python3-wheel "$backend"

directory=$build/wheel
rm -rf "$directory"
mkdir -p "$directory"
"$python" -m venv --system-site-packages "$directory/venv"
say "Building a wheel"
"$directory/venv/bin/pip" wheel --no-build-isolation --no-deps --no-index -w "$directory" "$checkout" >"$directory/log" 2>&1 ||
    { tail -n 20 "$directory/log" >&2; fail "could not build it (all of the messages: $directory/log)"; }
ls "$directory"/hdpstereo-*.whl
say "Testing it"
"$directory/venv/bin/pip" install --no-deps --no-index "$directory"/hdpstereo-*.whl >>"$directory/log" 2>&1
cd "$directory"
venv/bin/python3 "$checkout/python/test/test_hdpstereo.py"
