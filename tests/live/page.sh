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

# The same positions by both: to 1e-9 m of a cube of 0.1 m in numbers of 64 bits.  Those of 32 bits, which the page takes,
# are only stated: springs alone, which a pull can fold, amplify their round-off.
for digits in 64 32; do
  "$build/live_positions" $digits >"$work/native" || failed=1
  node "$here/positions.js" "$build/live" $digits >"$work/wasm" || failed=1
  difference=$(paste "$work/native" "$work/wasm" | awk '{d = $1 - $2; if (d < 0) d = -d; if (d > most) most = d} NF != 2 {bad = 1} END {print bad || NR < 100 ? "nan" : most + 0}')
  echo "largest difference of positions, $digits bits: $difference m in $(wc -l <"$work/native") numbers"
  [ $digits -eq 32 ] || check "equal to 1e-9 m" awk -v d="$difference" 'BEGIN {exit !(d + 0 == d && d < 1e-9)}'
done

chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$chromium" ]; then
  [ $failed -eq 0 ] && { echo "no Chromium: the page itself is not used"; exit 77; }
  exit 1
fi
node "$here/page.js" "$chromium" "$build/live/live.html" "$build/live" || failed=1
exit $failed
