#!/usr/bin/env bash
# Draws the figures of README and docs anew, from results that it keeps in a folder and computes where there are none: empty the
# folder after a change of the numbers.
#   docs/scripts/figures.sh [FOLDER]           FOLDER (default build/figures): golec_2019, rabbit, cost, rabbit_measured; without any an hour on two cores
#   docs/scripts/figures.sh points FILE...     the points of error-against-poisson-ratio, from the results.csv of its cases
# Needs build/release/springproof and Chromium, no display.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)

# model, Poisson's ratio, measure, largest error of all cases, each at its finest resolution.
points() {
  awk -F, '
    function cells(text,  n, part, i, product) { n = split(text, part, "x"); product = 1; for (i = 1; i <= n; ++i) product *= part[i]; return product }
    FNR == 1 { next }
    $6 != "displacement_error" && $6 != "volume_change" { next }
    {
      rows[++count] = $0
      if (cells($5) > finest[$1]) finest[$1] = cells($5)
    }
    END {
      for (i = 1; i <= count; ++i) {
        split(rows[i], field, ",")
        error = field[11] < 0 ? -field[11] : field[11] + 0
        point = field[3] "," field[4] "," field[6]
        if (field[11] != "" && cells(field[5]) == finest[field[1]] && error >= largest[point] + 0) largest[point] = error
      }
      for (point in largest) printf "%s,%.3g\n", point, largest[point]
    }' "$@" | LC_ALL=C sort
}

# results NAME ARGUMENT...: the folder of a run; its parts are computed unless they are there, its page is that of today.
results() {
  "$springproof" compare "${@:2}" --out "$folder/$1" --resume
}

# draw NAME PICTURE TARGET: one picture of a run becomes a figure.
draw() {
  "$springproof" pictures "$folder/$1" --only "$2"
  cp "$folder/$1"/png/*"$2.png" "$repository/docs/pictures/$3.png"
}

if [ "${1:-}" = points ]; then
  shift
  points "$@"
  exit
fi
folder=${1:-$repository/build/figures}
springproof=$repository/build/release/springproof
mkdir -p "$folder"
results golec_2019 golec_2019
results rabbit bodies/rabbit --poisson-ratio 0.4
results cost cost
results rabbit_measured cost/rabbit_measured
draw golec_2019 error-against-poisson-ratio error-against-poisson-ratio
draw rabbit shapes-displacement-smooth-nu0.4 rabbit
draw cost error-against-time error-against-cost
draw rabbit_measured error-against-unknowns error-against-unknowns
points "$folder/golec_2019/results.csv" >"$repository/docs/pictures/error-against-poisson-ratio.csv"
