#!/usr/bin/env bash
# The table of docs/models.md that names, for each kind of model and Poisson's ratio, the row whose largest error is the smallest: of
# displacements and reactions in the five experiments, from the tables of docs/measured/models.md.   docs/scripts/best_of_kind.sh PROGRAM [PAGE]
# At nu = 1/4 the terms of momentum dispersion and of volume vanish (q = 0, kappa = 0): what has no other is springs alone there.
set -euo pipefail
program=$1 page=${2:-$(dirname "$0")/../measured/models.md}
"$program" list | awk '
  function worst(cell,   x) {  # of "7.5", "0.42 (0.59)"; a dash: not known
    if (cell !~ /[0-9]/) return ""
    split(cell, x, /[ ()]+/)
    return x[2] + 0 > x[1] + 0 ? x[2] : x[1]
  }
  FNR == NR { if (/^Models/) inside = 1; else if (NF == 0) inside = 0; else if (inside) { made = substr($0, 19, 26); sub(/ +$/, "", made); kind[$1] = made; order[++rows] = $1 }; next }
  /^## / { row = $2 }
  row in kind && /^\| (compression|tension|shear|torsion|bending) \|/ {
    split($0, cell, / *\| */)
    for (k = 1; k <= 5; ++k)
      if ((x = worst(cell[k + 2])) != "" && x + 0 >= most[row, k] + 0) most[row, k] = x
  }
  END {
    split("−0.5 0 0.25 0.4 0.499", nu, " ")
    split("springs|springs + a term|a term per cell", kinds, "|")
    print "| ν | springs alone | springs + a term | a term per cell |\n|---|---|---|---|"
    for (k = 1; k <= 5; ++k) {
      line = "| " nu[k]
      for (m = 1; m <= 3; ++m) {
        best = ""
        for (r = 1; r <= rows; ++r) {
          row = order[r]
          own = kind[row] ~ /^springs \+/ ? kinds[2] : kind[row]
          if (k == 3 && row ~ /^(emsm|hybmss$|hybmss_fd$)/) own = kinds[1]
          if (own == kinds[m] && (row, k) in most && (best == "" || most[row, k] + 0 < most[best, k] + 0)) best = row
        }
        line = line " | `" best "` " most[best, k]
      }
      print line " |"
    }
  }' - "$page"
