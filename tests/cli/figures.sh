#!/usr/bin/env bash
# The README's figure is of today's code: its points are those of the experiments that have just run.
#   figures.sh SOURCE-FOLDER FOLDER-OF-EXPERIMENTS
set -u
source=$1 experiments=$2
results=()
for case in bending compression shear tension torsion; do
  results+=("$experiments/golec_2019/$case/results.csv")
  [ -f "${results[-1]}" ] || { echo "no ${results[-1]}: the experiments have not run"; exit 77; }
done
drawn=$source/docs/error-against-poisson-ratio.csv
today=$(mktemp)
trap 'rm -f "$today"' EXIT
"$source/docs/figures.sh" points "${results[@]}" >"$today" || exit 1
[ "$(wc -l <"$today")" -ge 100 ] || { echo "FAILED: only $(wc -l <"$today") points"; exit 1; }
awk -F, '
  function size(x) { return x < 0 ? -x : x }
  { point = $1 "," $2 "," $3 }
  FNR == NR { drawn[point] = $4; next }
  !(point in drawn) { print "FAILED: not in the figure: " $0; bad = 1; next }
  size($4 - drawn[point]) > 0.02 * size($4) && size($4 - drawn[point]) > 1e-6 { print "FAILED: " $0 ", drawn " drawn[point]; bad = 1 }
  { delete drawn[point] }
  END {
    for (point in drawn) { print "FAILED: no result of today: " point; bad = 1 }
    if (bad) print "draw it anew: docs/figures.sh"
    exit bad
  }' "$drawn" "$today"
