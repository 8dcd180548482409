#!/usr/bin/env bash
# Builds the live page, holds its library to the native one, and uses the page in Chromium.   page.sh SOURCE BUILD
set -u
source=$1
build=$2
here=$source/tests/live
command -v em++ >/dev/null || { echo "no em++: the live page is not built (apt-get install emscripten node-acorn)"; exit 77; }
command -v node >/dev/null || { echo "no node"; exit 77; }
[ -d /usr/share/nodejs/acorn ] || { echo "no node-acorn, which Emscripten's optimiser needs"; exit 77; }
failed=0
check() {   # check WHAT COMMAND...
  local what=$1
  shift
  if "$@"; then echo "ok: $what"; else echo "FAILED: $what"; failed=1; fi
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$source/comparisons/live/build.sh" "$build/live" >"$work/log" 2>&1 || { tail -n 40 "$work/log" | cut -c1-300; echo "FAILED: the page does not build"; exit 1; }
size=$(stat -c %s "$build/live/live.html")
echo "live.html: $size bytes"
check "one file below 5 MB" [ "$size" -lt 5000000 ]

# The same positions by both, of a cube of 0.1 m that a pull folds where it is of springs alone: in numbers of 64 bits to
# 1e-9 m, and in those that the page takes to 1e-6 m of the native library's in 64 bits.
"$build/live_positions" 64 >"$work/native" || failed=1
for numbers in "64 1e-9" "0 1e-6"; do
  read -r digits most <<<"$numbers"
  node "$here/positions.js" "$build/live" "$digits" >"$work/wasm" || failed=1
  difference=$(paste "$work/native" "$work/wasm" | awk '{d = $1 - $2; if (d < 0) d = -d; if (d > most) most = d} NF != 2 {bad = 1} END {print bad || NR < 100 ? "nan" : most + 0}')
  what="$digits bits"
  [ "$digits" -eq 0 ] && what="the page's bits"
  check "positions of both libraries, $what: $difference m apart, allowed $most m" awk -v d="$difference" -v most="$most" 'BEGIN {exit !(d + 0 == d && d < most)}'
done

chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$chromium" ]; then
  [ $failed -eq 0 ] && { echo "no Chromium: the page itself is not used"; exit 77; }
  exit 1
fi
node "$here/page.js" "$chromium" "$build/live/live.html" "$build/live" || failed=1
exit $failed
