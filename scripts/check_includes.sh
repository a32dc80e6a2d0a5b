#!/bin/bash
# Checks that includes between the folders of src/ go one way.
#
#   scripts/check_includes.sh
#
# A folder uses those that are named behind it here, and files of its own; CONTRIBUTING.md says what each is for. What is
# in no folder puts them together, and may use all.
set -euo pipefail

declare -A uses=(
    [base]=""
    [pair]="base"
    [cost]="base"
    [forest]="base cost"
    [scanlines]="base cost forest"
    [map]="base pair cost"
    [video]="base pair cost forest"
    [paper]="base cost forest"
    [rig]="base"
    [plan]="base pair cost forest scanlines map video paper"
)

cd "$(dirname "${BASH_SOURCE[0]}")/../src"
found=0
for folder in */; do
    folder=${folder%/}
    if [ -z "${uses[$folder]+known}" ]; then
        echo "src/$folder: not in scripts/check_includes.sh"
        found=1
        continue
    fi
    while IFS=: read -r file line used; do
        [[ " $folder ${uses[$folder]} " == *" $used "* ]] && continue
        echo "src/$file:$line: $folder must not use $used"
        found=1
    done < <(grep -noE '#include "\.\./[a-z]+/' "$folder"/* -r | sed -E 's|:#include "\.\./([a-z]+)/|:\1|')
done
[ $found -eq 0 ] || exit 1
echo "${#uses[@]} folders: includes go one way"
