#!/usr/bin/env bash
# The tables of docs/measured/models.md: errors of every model of the table that fills a body, in five experiments of Golec et al. (2019), and the
# moduli that all models have.   docs/scripts/models.sh [FOLDER]   (default build/models; a few minutes on two cores)
# Needs build/release/springproof; prints Markdown.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)
springproof=${SPRINGPROOF:-$repository/build/release/springproof}
folder=${1:-$repository/build/models}
mkdir -p "$folder"
rows=$("$springproof" list | awk '/^Models/ { inside = 1; next } inside && NF == 0 { exit } inside { print $1 }')
solid=$(grep -vE 'hexagonal|kirkwood' <<<"$rows")

# The case with these models, its coarser cells and five Poisson's ratios; disordered networks as means of three.
models=$(sed -E 's/.*/"&"/; s/^"(.*(random|patch))"$/{ model = "\1", seeds = 3, label = "\1" }/' <<<"$solid" | paste -sd,)
for load in compression tension shear torsion bending; do
  sed -E "s/^cells = \[(\[[0-9, ]*\]).*/cells = [\1]/; s/^poisson_ratio = \[.*/poisson_ratio = [-0.5, 0.0, 0.25, 0.4, 0.499]/
          s/^models = .*/models = [$models]/; s/^measures = .*/measures = [\"displacement_error\", \"volume_change\"]/
          /^# What must hold/,\$d" "$repository/comparisons/experiments/golec_2019/$load.toml" >"$folder/$load.toml"
done
"$springproof" compare "$folder"/{compression,tension,shear,torsion,bending}.toml --out "$folder/results" --resume >"$folder/log"

# A table per model, a row per load, a column per Poisson's ratio: per cent, of displacements and in brackets of the reaction.
awk -F, '
  function per_cent(x) { x = (x < 0 ? -x : x) * 100; return x < 0.005 ? "0" : x < 1 ? sprintf("%.2f", x) : x < 10 ? sprintf("%.1f", x) : sprintf("%.0f", x) }
  FNR > 1 && $11 != "" && ($6 == "displacement_error" || $6 == "reaction_error") { value[$3, $1, $4, $6] = per_cent($11) }
  END {
    split("compression tension shear torsion bending", load, " "); split("-0.5 0 0.25 0.4 0.499", nu, " ")
    count = split(rows, model, "\n")
    for (m = 1; m <= count; ++m) {
      printf "%s\n| ν = | −0.5 | 0 | 0.25 | 0.4 | 0.499 |\n|---|---|---|---|---|---|\n", model[m]
      for (l = 1; l <= 5; ++l) {
        line = "| " load[l]
        for (k = 1; k <= 5; ++k) {
          u = value[model[m], load[l], nu[k], "displacement_error"]; r = value[model[m], load[l], nu[k], "reaction_error"]
          line = line " | " (u == "" ? "–" : u) (r == "" ? "" : " (" r ")")
        }
        print line " |"
      }
      print ""
    }
  }' rows="$solid" "$folder/results/results.csv"

echo "moduli, measured back: ν for a wanted ν, and E over the wanted E"
for model in $rows; do
  line="| \`$model\`"
  for nu in -0.5 0 0.25 0.4 0.499; do
    line+=$("$springproof" material -E 1e4 --nu=$nu --cell-size 0.1 --model "$model" 2>/dev/null |
      awk '$1 == "E" && /relative/ { E = $3 / 1e4 } $1 == "nu" { nu = $3 } END { if (E != "") printf " | %.3f, %.3f", nu, E; else printf " | –" }') || true
  done
  echo "$line |"
done
