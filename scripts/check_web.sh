#!/bin/bash
# Builds the web page and tests it: the maps in node, and the page in Chromium. Prints how long FAST takes beside this
# machine's own code, and leaves screenshots in build/web/test.
#   scripts/check_web.sh BUILD   a build of this module with its samples and tools
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

module_build=$(realpath "$1")
unset OPENCV_SAMPLES_DATA_PATH OPENCV_TEST_DATA_PATH
"$checkout/scripts/build_web.sh"
export HDPSTEREO_PAGE=$build/web/page HDPSTEREO_WEB_WORK=$build/web/test
export HDPSTEREO_NATIVE=$module_build/bin/hdpstereo
HDPSTEREO_BROWSER=$(command -v chromium) || fail "there is no chromium"
export HDPSTEREO_BROWSER

tests=$build/web/npm/test # where they find packages
rm -rf "$tests" "$HDPSTEREO_WEB_WORK"
cp -r "$checkout/web/test" "$tests"
say "Testing"
node --test "$tests"/*.test.mjs
say "Times"
node "$tests/benchmark.mjs"
