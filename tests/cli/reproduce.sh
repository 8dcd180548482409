#!/usr/bin/env bash
# springproof reproduce: a figure from its case to its files, again from the results alone, and what is refused.
#   reproduce.sh PROGRAM SOURCE-FOLDER
set -u
program=$1 source=$2
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# refused STATUS TEXT ARGUMENT...: ends with that status and says so.
refused() {
  local status=$1 text=$2 got
  shift 2
  "$program" reproduce "$@" --out "$work/none" >"$work/said" 2>&1
  got=$?
  [ $got -eq "$status" ] || fail "reproduce $*: status $got"
  grep -qF "$text" "$work/said" || fail "reproduce $* does not say: $text"
}
refused 2 'allowed: golec_2019, kot_2014, kot_2015' golec
refused 2 'allowed: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13' kot_2015 --figure 14
refused 2 'no results.json here' kot_2015 --from "$work"
refused 2 'PAPER is required'

"$program" reproduce kot_2015 --figure 1,7 --out "$work/out" --jobs 1 --quiet >"$work/said" 2>&1 || fail "Fig. 7: status $?"
for file in reproduce.html results.json figures/fig_7.svg figures/fig_7.csv; do
  [ -s "$work/out/$file" ] || fail "no $file"
done
if command -v rsvg-convert >/dev/null; then
  head -c 5 "$work/out/figures/fig_7.pdf" | grep -q '%PDF-' || fail "fig_7.pdf is no PDF"
else
  grep -q 'librsvg2-bin' "$work/said" || fail "nothing is said of the missing PDF"
fi
grep -q 'obtained less wanted' "$work/out/figures/fig_7.svg" || fail "no second axes in fig_7.svg"
# The 4-cell column is wrong at the surface, the symmetric one is exact; a line per Poisson's ratio, and two of theory.
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "difference_symmetric_ours") at = i }
         NR > 1 && $at != "" { ++n; if ($at > 1e-6 || $at < -1e-6) exit 1 }
         END { exit n != 10 }' "$work/out/figures/fig_7.csv" || fail "fig_7.csv: not the ten exact points of the symmetric form"

word=$(sed -nE 's/^Fig\. 7 +(agrees in part|agrees|differs|drawn) .*/\1/p' "$work/said")
documented=$(awk -F'|' '/^## / { paper = $2 ? $2 : substr($0, 4) } paper == "kot_2015" && $2 == " Fig. 7 " { split($6, part, ":"); sub(/^ /, "", part[1]); print part[1] }' "$source/docs/reproducing.md")
[ -n "$word" ] && [ "$word" = "$documented" ] || fail "the verdict on Fig. 7 is \"$word\", in docs/reproducing.md \"$documented\""

"$program" reproduce kot_2015 --from "$work/out" --out "$work/again" >"$work/said" 2>&1 || fail "--from: status $?"
cmp "$work/out/figures/fig_7.svg" "$work/again/figures/fig_7.svg" || fail "--from draws another figure"
[ ! -e "$work/again/results.json" ] || fail "--from computes"
grep -qE '^Fig\. 8 +not run' "$work/said" || fail "a figure without results is not said to lack them"
echo "reproduce: $failures failures"
exit $((failures > 0))
