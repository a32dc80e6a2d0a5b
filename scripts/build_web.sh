#!/bin/bash
# Builds the web page, a folder for any static host, in build/web/page: OpenCV's core and imgproc and this module by
# Debian's emscripten, and the page around them. Installs what is missing. A quarter of an hour of processor time the
# first time, seconds when nothing has changed.
#   scripts/build_web.sh           builds it
#   scripts/build_web.sh --serve   and serves it on the loopback address, to look at it
# OPENCV_SOURCE_DIR=<OpenCV's source> in the environment: builds that one instead of Debian's source package. It may be
# read-only.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(cmake emscripten libopencv-dev ninja-build python3 xz-utils)
command -v npm >/dev/null || packages+=(npm)
install_packages "${packages[@]}"
command -v emcc >/dev/null || fail "nothing can be built without emscripten"
# Debian's emscripten needs modules of Debian's node, also if another one comes first.
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}

directory=$build/web
mkdir -p "$directory"
log=$directory/build.log
: >"$log"

# run WHAT COMMAND...: messages go to the log.
run()
{
    local what=$1
    shift
    "$@" >>"$log" 2>&1 || { tail -n 20 "$log" | cut -c1-300 >&2; fail "could not $what (all of the messages: $log)"; }
}

if [ ! -e "${OPENCV_SOURCE_DIR:-}/modules/imgproc/src" ]; then
    fetch_tarball || fail "nothing to build without OpenCV's source"
    OPENCV_SOURCE_DIR=$directory/${tarball##*/}
    OPENCV_SOURCE_DIR=${OPENCV_SOURCE_DIR%.orig.tar.xz}
    unpack_tarball "$OPENCV_SOURCE_DIR" '*/CMakeLists.txt' '*/LICENSE' '*/cmake/*' '*/include/*' '*/platforms/*' \
        '*/modules/core/*' '*/modules/imgproc/*' '*/modules/calib3d/*'
fi
OPENCV_SOURCE_DIR=$(realpath "$OPENCV_SOURCE_DIR")
# Its v_round() for WebAssembly adds a half and cuts off: wrong by one below 0, and halves do not become even. The
# source is only read: the compiler finds a corrected copy of the header first. What is the same is not written again,
# nor built.
header=opencv2/core/hal/intrin_wasm.hpp
overlay=$directory/overlay
corrected=$(sed '/v_round(const v_float32x4/,/^}/{
    /splat(0.5)/d
    s/wasm_f32x4_add(a.val, h)/wasm_f32x4_nearest(a.val)/
}' "$OPENCV_SOURCE_DIR/modules/core/include/$header")
if [ "$corrected" != "$(cat "$overlay/$header" 2>/dev/null)" ]; then
    mkdir -p "$overlay/${header%/*}"
    printf '%s\n' "$corrected" >"$overlay/$header"
fi

# OpenCV with nothing that those two modules do not need. Its tests of the compiler do without links, which take a
# second each.
# shellcheck disable=SC2054  # a list of modules
opencv_options=(-DBUILD_LIST=core,imgproc -DBUILD_SHARED_LIBS=OFF -DENABLE_PIC=OFF -DCPU_BASELINE= -DCPU_DISPATCH=
    -DCV_ENABLE_INTRINSICS=ON -DCV_TRACE=OFF -DENABLE_CCACHE=OFF -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY
    -DBUILD_ZLIB=OFF "-DZLIB_INCLUDE_DIR=$checkout/web/no_zlib" -DZLIB_LIBRARY=m
    "-DOPENCV_DOWNLOAD_PATH=$directory/downloads")
for part in BUILD_{TESTS,PERF_TESTS,EXAMPLES,DOCS,JAVA,opencv_apps} \
    WITH_{IPP,ITT,QUIRC,ADE,PROTOBUF,CAROTENE,OPENCL,LAPACK,EIGEN,TBB,VA,VULKAN,WEBNN,OPENGL,1394,FFMPEG,GSTREAMER} \
    WITH_{V4L,GTK,JPEG,PNG,TIFF,WEBP,JASPER,OPENJPEG,OPENEXR}; do
    opencv_options+=("-D$part=OFF")
done

# configure DIRECTORY SOURCE FLAGS [OPTION...]: once for these
configure()
{
    local target=$1 source=$2 flags=$3 arguments="$*"
    shift 3
    [ "$(cat "$target/.configured" 2>/dev/null)" != "$arguments" ] || return 0
    rm -rf "$target"
    run "configure $source" emcmake cmake -S "$source" -B "$target" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        "-DCMAKE_C_FLAGS=$flags" "-DCMAKE_CXX_FLAGS=$flags" "$@"
    echo "$arguments" >"$target/.configured"
}

# build_matcher NAME FLAGS [OPTION of OpenCV...]: NAME.mjs and NAME.wasm in build/web/NAME/matcher. Exceptions and SIMD
# of WebAssembly are in all browsers since 2023.
build_matcher()
{
    local name=$1 flags="-iquote '$overlay' -msimd128 -fwasm-exceptions $2"
    shift 2
    say "Building OpenCV and $name"
    configure "$directory/$name/opencv" "$OPENCV_SOURCE_DIR" "-w $flags" "${opencv_options[@]}" "$@"
    run "build OpenCV" ninja -C "$directory/$name/opencv" -j "$jobs" opencv_core opencv_imgproc
    configure "$directory/$name/matcher" "$checkout/web" "$flags" "-DOpenCV_DIR=$directory/$name/opencv" \
        "-DOPENCV_MODULES=$OPENCV_SOURCE_DIR/modules" "-DPython3_EXECUTABLE=$python" -DHDPSTEREO_INSTALL=OFF \
        "-DHDPSTEREO_WEB_NAME=$name"
    run "build the matcher" ninja -C "$directory/$name/matcher" -j "$jobs"
}

# Two of them: browsers allow threads only to pages that are isolated from others, which the host has to ask for.
build_matcher hdpstereo "" -DWITH_PTHREADS_PF=OFF
build_matcher hdpstereo-threads "-pthread" -DWITH_PTHREADS_PF=ON

# From npm: three.js and fast-png for the page, esbuild to put each into one file, playwright-core for the tests
npm_directory=$directory/npm
if ! cmp -s "$checkout/web/package-lock.json" "$npm_directory/.installed"; then
    say "Installing packages from npm"
    mkdir -p "$npm_directory"
    cp "$checkout"/web/package{,-lock}.json "$npm_directory"
    run "install packages from npm" npm ci --prefix "$npm_directory" --ignore-scripts --no-audit --no-fund
    cp "$checkout/web/package-lock.json" "$npm_directory/.installed"
fi

# bundle FILE TARGET: with the packages that it imports
bundle()
{
    run "bundle $1" env "NODE_PATH=$npm_directory/node_modules" "$npm_directory/node_modules/.bin/esbuild" "$1" \
        --bundle --format=esm --minify --legal-comments=none "--outfile=$2"
}

page=$directory/page
rm -rf "$page.part"
cp -r "$checkout/web/page" "$page.part"
mkdir "$page.part/vendor" "$page.part/licenses"
for library in three png; do
    bundle "$checkout/web/vendor/$library.mjs" "$page.part/vendor/$library.mjs"
done
for package in three fast-png fflate iobuffer; do
    cp "$npm_directory/node_modules/$package/LICENSE" "$page.part/licenses/$package.txt"
done
cp "$OPENCV_SOURCE_DIR/LICENSE" "$page.part/licenses/opencv.txt"
cp "$checkout/LICENSE" "$page.part/licenses/hdpstereo.txt"

# The pair that is built in
if ! cmp -s "$checkout/web/tools/scene.mjs" "$directory/pair/scene.mjs"; then
    say "Making a pair of pictures"
    cp "$checkout/web/tools/scene.mjs" "$npm_directory" # where it finds packages
    run "make pictures" node "$npm_directory/scene.mjs" "$directory/pair"
    cp "$checkout/web/tools/scene.mjs" "$directory/pair/scene.mjs"
fi
mkdir "$page.part/pair"
cp "$directory"/pair/{left,right}.png "$page.part/pair"
cp "$directory"/hdpstereo/matcher/{hdpstereo.mjs,hdpstereo.wasm,parameters.json} "$page.part"
cp "$directory"/hdpstereo-threads/matcher/hdpstereo-threads.{mjs,wasm} "$page.part"
# With emscripten before 3.1.58, threads have a file of their own.
find "$directory/hdpstereo-threads/matcher" -maxdepth 1 -name '*.worker.*js' -exec cp {} "$page.part" \;
rm -rf "$page"
mv "$page.part" "$page"

size=$(cat "$page"/hdpstereo.{mjs,wasm} | gzip -9 | wc -c)
say "Done: $page. The matcher has $((size / 1000)) kB gzipped"
[ "$size" -le 4000000 ] || fail "that is more than 4 MB"
[ "${1:-}" != --serve ] || exec node "$checkout/web/test/server.mjs" "$page" 8080
