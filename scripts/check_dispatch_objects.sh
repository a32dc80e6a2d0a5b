#!/bin/bash
# Checks the objects that are compiled for wider instruction sets than the baseline.
#
#   scripts/check_dispatch_objects.sh BUILD_DIR      of an optimised build
#
# The linker keeps one copy of a weak symbol, such as a member of std::vector, for the whole program. If it is the copy
# that was compiled for AVX2, the program stops on a processor without it. So these objects may define weak symbols in
# their own namespaces only (opt_MODE, and hal_MODE of OpenCV's intrinsics), and the baseline allocates their memory.
set -euo pipefail

[ $# -eq 1 ] || { echo "Usage: $0 BUILD_DIR" >&2; exit 2; }
nm --version >/dev/null # what it finds is nothing if it is missing
stages=$(dirname "${BASH_SOURCE[0]}")/../src
objects=()
while read -r object; do
    stage=$(basename "$object")
    # One without a source is left from an older build.
    [ -z "$(find "$stages" -name "${stage%%.*}.simd.hpp")" ] || objects+=("$object")
done < <(find "$1" -ipath '*hdpstereo*' -iregex '.*[.]\(avx\|sse\)[^/.]*[.]cpp[.]o' | sort)
[ ${#objects[@]} -gt 0 ] || { echo "$1 has no objects of dispatched stages" >&2; exit 2; }

found=0
report() # OBJECT WHAT: the names are read from standard input
{
    local name
    while read -r name; do
        echo "$(basename "$1"): $2: $name"
        found=1
    done
}
for object in "${objects[@]}"; do
    report "$object" "weak symbol" < <(nm -C --defined-only "$object" | sed -n 's/^[0-9a-f]* [VWu] //p' |
        grep -Ev '(^|[^A-Za-z0-9_])(opt|hal)_[A-Z0-9_]+::|^DW[.]ref[.]' || true) # GCC 10's are addresses, no code
    report "$object" "allocation" < <(nm -C --undefined-only "$object" | sed 's/^ *U //' |
        grep -E '^(operator (new|delete)|malloc|calloc|realloc|free$|cv::fast(Malloc|Free)|cv::Mat::create)' || true)
done
[ $found -eq 0 ] || exit 1
echo "${#objects[@]} objects: no weak symbols but their own, no allocation"
