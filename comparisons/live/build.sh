#!/usr/bin/env bash
# Builds the live page: comparisons/live/build.sh [FOLDER]   (default: build/release/live; the page is FOLDER/live.html)
# Needs Debian's packages emscripten, node-acorn, libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libjs-three, cmake, ninja-build.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-$here/../../build/release/live}
mkdir -p "$out"
command -v em++ >/dev/null || { echo "The live page is compiled by Emscripten:  sudo apt-get install emscripten node-acorn" >&2; exit 77; }
export NODE_PATH=/usr/share/nodejs:/usr/lib/nodejs   # where Emscripten's optimiser finds acorn
cmake -S "$here" -B "$out" -G Ninja -DCMAKE_BUILD_TYPE=None \
      -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake >"$out/configure.log" 2>&1 || { cat "$out/configure.log" >&2; exit 1; }
cmake --build "$out" -j1
