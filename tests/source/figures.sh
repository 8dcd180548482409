#!/usr/bin/env bash
# The README's figure is of today's code: its points are those of the experiments that have just run, at the Poisson's
# ratios that all of them have.
#   figures.sh SOURCE-FOLDER FOLDER-OF-EXPERIMENTS
. "$(dirname "$0")/../cli/lib.sh"
source=$1 experiments=$2
results=()
for case in bending compression shear tension torsion; do
  results+=("$experiments/golec_2019/$case/results.csv")
  [ -f "${results[-1]}" ] || { echo "no ${results[-1]}: the experiments have not run"; exit 77; }
done
drawn=$work/drawn today=$work/today
awk -F, 'FNR == 1 { ++files; next }
         !seen[FILENAME, $4]++ { ++cases[$4] }
         END { for (nu in cases) if (cases[nu] == files) print nu }' "${results[@]}" >"$work/ratios"
of_all_cases() { awk -F, 'FNR == NR { ratios[$1]; next } $2 in ratios' "$work/ratios" "$1"; }
of_all_cases "$source/docs/pictures/error-against-poisson-ratio.csv" >"$drawn"
"$source/docs/scripts/figures.sh" points "${results[@]}" >"$work/points" || exit 1
of_all_cases "$work/points" >"$today"
[ "$(wc -l <"$today")" -ge 40 ] || { echo "FAILED: only $(wc -l <"$today") points"; exit 1; }
awk -F, '
  function size(x) { return x < 0 ? -x : x }
  { point = $1 "," $2 "," $3 }
  FNR == NR { drawn[point] = $4; next }
  !(point in drawn) { print "FAILED: not in the figure: " $0; bad = 1; next }
  size($4 - drawn[point]) > 0.02 * size($4) && size($4 - drawn[point]) > 1e-6 { print "FAILED: " $0 ", drawn " drawn[point]; bad = 1 }
  { delete drawn[point] }
  END {
    for (point in drawn) { print "FAILED: no result of today: " point; bad = 1 }
    if (bad) print "draw it anew: docs/scripts/figures.sh"
    exit bad
  }' "$drawn" "$today"
