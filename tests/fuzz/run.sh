#!/usr/bin/env bash
# Builds a fuzz target with clang, holds it against its seeds, then against new inputs made from them: for a minute, or as libFuzzer's
# options say (-runs=1000000).  What it finds stands in BUILD-FOLDER/findings.     run.sh BUILD-FOLDER TARGET [OPTION ...]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1 target=$2
shift 2
[ $# -gt 0 ] || set -- -max_total_time=60
if ! clang++ -x c++ -fsanitize=fuzzer -o /dev/null - 2>/dev/null <<<'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }'; then
  echo "skipped: no clang++ with libFuzzer here (Debian: clang and libclang-rt-dev)"
  exit 77
fi
mkdir -p "$build/findings" "$build/corpus/$target"
(
  flock 9  # targets share their libraries
  [ -f "$build/build.ninja" ] || cmake -S "$here/../.." -B "$build" --preset fuzz
  cmake --build "$build" --target "fuzz_$target"
) 9>"$build/lock" >"$build/$target.log" 2>&1 || { cat "$build/$target.log"; exit 1; }

fuzz=$build/fuzz_$target seeds=$here/seeds/$target
options=(-artifact_prefix="$build/findings/$target-" -timeout=60 -print_final_stats=1)
[ ! -f "$here/$target.dict" ] || options+=(-dict="$here/$target.dict")
if [ -d "$seeds" ]; then
  read=("$seeds"/read/*)
else  # of no format to be written by hand
  SPRINGPROOF_FUZZ_WRITE=$build/$target.seed "$fuzz"
  read=("$build/$target.seed")
  cp "$build/$target.seed" "$build/corpus/$target"
fi
SPRINGPROOF_FUZZ_READ=1 "$fuzz" "${options[@]}" "${read[@]}" 2>"$build/$target.log" || { cat "$build/$target.log"; exit 1; }
folders=("$build/corpus/$target")
[ ! -d "$seeds" ] || folders+=("$seeds"/*)
# gmsh is not held to anything: what it dies of is counted, what our code dies of is a finding.  It leaks in each run, and the
# sanitizer takes a second to see that those leaks are not ours.
[ "$target" != msh ] || options+=(-detect_leaks=0 -fork=1 -ignore_crashes=1 -ignore_ooms=1 -ignore_timeouts=1)
"$fuzz" "${options[@]}" "$@" "${folders[@]}" 2>&1 | { grep --line-buffered -vE '^#[0-9]+\s+(NEW|REDUCE|RELOAD)' || true; }
[ "$target" = msh ] || exit 0
ours=0
for input in "$build"/findings/msh-crash-*; do
  [ -f "$input" ] || continue
  if trace=$("$fuzz" "$input" 2>&1); then  # alone it is read or refused: gmsh had spoilt the memory in an earlier run
    rm "$input"
    continue
  fi
  case $(grep -E '^ +#[0-9]+ ' <<<"$trace" | grep -oE 'libgmsh|springproof::' | head -1) in
    libgmsh) rm "$input" ;;
    *) ours=1; echo "FINDING in $input"; echo "$trace" ;;
  esac
done
exit $ours
