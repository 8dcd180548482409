#!/usr/bin/env bash
# springproof reproduce: a figure from its case to its files, again from the results alone, and what is refused.
#   reproduce.sh PROGRAM SOURCE-FOLDER
. "$(dirname "$0")/lib.sh"
program=$1 source=$2

refused 'allowed: golec_2019, kot_2014, kot_2015' reproduce golec
refused 'allowed: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13' reproduce kot_2015 --figure 14
refused 'no results.json here' reproduce kot_2015 --from "$work"
refused 'PAPER is required' reproduce

fem=${SPRINGPROOF_FEM_PROGRAM:-$(dirname "$program")/springproof-fem}
"$program" reproduce kot_2014 --figure 1,13 --out "$work/out" --jobs 1 --quiet >"$work/said" 2>&1 || [ ! -x "$fem" ] || fail "Fig. 13: status $?"
for file in reproduce.html results.json figures/fig_13.svg figures/fig_13.csv; do
  [ -s "$work/out/$file" ] || fail "no $file"
done
if command -v rsvg-convert >/dev/null; then
  head -c 5 "$work/out/figures/fig_13.pdf" | grep -q '%PDF-' || fail "fig_13.pdf is no PDF"
else
  grep -q 'librsvg2-bin' "$work/said" || fail "nothing is said of the missing PDF"
fi
grep -q 'deflection' "$work/out/figures/fig_13.svg" || fail "no axis in fig_13.svg"
# Superposed cells are too stiff by 1.22 and 1.06; a line per probe, one of the fixed end, and those of the formula.
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
         NR > 1 && $1 == 4 { ++n; formula = $at["eq._25"]; two = $at["superposed_cubes_2_across"]; four = $at["superposed_cubes_4_across"] }
         END { exit !(n == 1 && formula == 0.1024 && two > 0.080 && two < 0.086 && four > 0.095 && four < 0.1) }' \
  "$work/out/figures/fig_13.csv" || fail "fig_13.csv: not the tips of the superposed cells"
grep -qE '^Fig\. 13 .*runs of medium random networks scatter: at most [0-9.]+ % \(allowed 5 %, the paper.s\).*medium random networks beside \(25\): off by at most [0-9.]+ % \(not judged\)' \
  "$work/said" || fail "it does not say whose the bounds are: $(cat "$work/said")"

word=$(sed -nE 's/^Fig\. 13 +(agrees in part|agrees|differs|drawn) .*/\1/p' "$work/said")
documented=$(awk -F'|' '/^## / { paper = $2 ? $2 : substr($0, 4) } paper == "kot_2014" && $2 == " Fig. 13 " { split($6, part, ":"); sub(/^ /, "", part[1]); print part[1] }' "$source/docs/measured/reproducing.md")
[ -n "$word" ] && [ "$word" = "$documented" ] || fail "the verdict on Fig. 13 is \"$word\", in docs/measured/reproducing.md \"$documented\""

"$program" reproduce kot_2014 --from "$work/out" --out "$work/again" >"$work/said" 2>&1 || fail "--from: status $?"
cmp "$work/out/figures/fig_13.svg" "$work/again/figures/fig_13.svg" || fail "--from draws another figure"
[ ! -e "$work/again/results.json" ] || fail "--from computes"
grep -qE '^Fig\. 14 +not run' "$work/said" || fail "a figure without results is not said to lack them"
echo "reproduce: $failures failures"
exit $((failures > 0))
