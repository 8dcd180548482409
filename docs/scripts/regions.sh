#!/usr/bin/env bash
# The tables of several materials in docs/measured/cut_cells.md: balls and beams of two materials at random places in the lattice, beside
# closed forms and finite elements.   docs/scripts/regions.sh [FOLDER]   (default build/regions; ten minutes on two cores)
# Needs build/release/springproof; prints Markdown.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)
springproof=${SPRINGPROOF:-$repository/build/release/springproof}
folder=${1:-$repository/build/regions}
mkdir -p "$folder"
: >"$folder/places"
random() { awk -v seed="$1" -v from="$2" -v to="$3" 'BEGIN { srand(seed); rand(); printf "%.5f", from + (to - from) * rand() }'; }

# A ball, four and eight cells across, in a block of three diameters that is pulled along z; finite elements where it is in the middle.
# ball NAME NU-AROUND E-INSIDE NU-INSIDE PLACE
ball() {
  local at="0.03, 0.03, 0.03" elements='["p2"]'
  [ "$5" = 0 ] || elements='[]'
  [ "$5" = 0 ] || at="$(random "$5"1 0.0275 0.0325), $(random "$5"2 0.0275 0.0325), $(random "$5"3 0.0275 0.0325)"
  cat >"$folder/$1_$5.toml" <<TOML
[body]
geo = "block.geo"
size_m = [0.06, 0.06, 0.06]
voxel_edge_m = [0.005, 0.0025]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = $2
[[region]]
name = "ball"
near = { point_m = [$at], radius_m = 0.01 }
youngs_modulus_Pa = $3
poisson_ratio = $4
[[load]]
on = "x_min"
displacement_m = [0, "free", "free"]
[[load]]
on = "y_min"
displacement_m = ["free", 0, "free"]
[[load]]
on = "z_min"
displacement_m = ["free", "free", 0]
[[load]]
on = "z_max"
traction_Pa = [0, 0, 100]
[compare]
models = ["hybmss_avg"]
measures = ["region"]
[reference]
edge_m = 0.006
elements = $elements
TOML
}

# A bar of two parts without transverse strain, bent to a circle: layers along it, or halves that follow each other.
# beam NAME NORMAL E-BEYOND PLACE
beam() {
  local at
  at=$([ "$2" = 0,0,1 ] && random "$4" 0.007 0.013 || random "$4" 0.03 0.05)
  echo "$1_$4,$at" >>"$folder/places"
  cat >"$folder/$1_$4.toml" <<TOML
kinematics = "linear"
[body]
geo = "block.geo"
size_m = [0.08, 0.02, 0.02]
voxel_edge_m = [0.01, 0.005]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.0
[[region]]
name = "stiff"
beyond = { point_m = [$at, 0, $at], normal = [$2] }
youngs_modulus_Pa = $3
poisson_ratio = 0.0
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
rotation_deg = 0.1
axis = [0, 1, 0]
about_m = [$(about "$2" "$at" "$3"), 0.01, 0.01]
[compare]
models = ["hybmss_avg"]
measures = ["reaction"]
[reference]
elements = []
TOML
}

# How far along the bar its end turns about, so that no force acts on it.
about() {
  awk -v normal="$1" -v at="$2" -v E="$3" 'BEGIN {
    L = 0.08; k1 = 1; k2 = 1e4 / E
    if (normal == "0,0,1") print L / 2
    else printf "%.8f", L - (k1 * (L * at - at * at / 2) + k2 * (L - at) ^ 2 / 2) / (k1 * at + k2 * (L - at)) }'
}

# A layer THICKNESS in a bar of cells of EDGE, bent along it (b) or pulled across it (s); without one if it is 0.
# layer KIND EDGE THICKNESS PLACE
layer() {
  local name=layer_$1_$2_$3_$4 from to load='displacement_m = [8e-5, 0, 0]' region=
  [ "$1" = s ] || load=$'rotation_deg = 0.1\naxis = [0, 1, 0]\nabout_m = [0.04, 0.01, 0.01]'
  from=$([ "$1" = b ] && random "$4" 0 "$(awk "BEGIN { print 0.02 - $3 }")" || random "$4" 0.02 0.05)
  to=$(awk "BEGIN { print $from + $3 }")
  local box="[$from, 0, 0], [$to, 0.02, 0.02]"
  [ "$1" = s ] || box="[0, 0, $from], [0.08, 0.02, $to]"
  [ "$3" = 0 ] || region=$'[[region]]\nname = "layer"\nyoungs_modulus_Pa = [1e2, 1e3, 1e5, 1e6]\npoisson_ratio = 0.0\nbox_m = ['$box]
  echo "$name,$from" >>"$folder/places"
  cat >"$folder/$name.toml" <<TOML
[body]
geo = "block.geo"
size_m = [0.08, 0.02, 0.02]
voxel_edge_m = $2
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.0
$region
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
$load
[compare]
models = ["hybmss_avg"]
measures = ["reaction"]
[reference]
elements = []
TOML
}

for edge in 0.005 0.0025; do
  for kind in b s; do
    layer $kind $edge 0 1
    for place in 1 2 3 4; do
      layer $kind $edge $edge $place
      layer $kind $edge "$(awk "BEGIN { print $edge / 2 }")" $place
    done
  done
done
for place in 0 1 2 3 4 5 6; do
  ball contrast 0.3 '[1e2, 1e5, 1e6, 1e8]' 0.3 $place
  ball inside_499 0.3 1e4 0.499 $place
  ball around_499 0.499 1e4 0.3 $place
done
for place in 1 2 3 4; do
  for contrast in 10 10000; do
    beam "layers_$contrast" 0,0,1 ${contrast}e4 $place
    beam "halves_$contrast" 1,0,0 ${contrast}e4 $place
  done
done
# A ball with a soft, nearly incompressible core under pressure, without supports: Lame's pressure in the core is 1200 Pa.
cat >"$folder/sphere.toml" <<'TOML'
[body]
geo = "sphere.geo"
size_m = [0.04, 0.04, 0.04]
voxel_edge_m = [0.005, 0.0025]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
[[region]]
name = "core"
near = { point_m = [0.02, 0.02, 0.02], radius_m = 0.01 }
youngs_modulus_Pa = 1e4
poisson_ratio = 0.499
[[load]]
on = "surface"
pressure_Pa = 1e3
[compare]
models = [{ model = "hybmss_avg", hold_rigid_motions = true, label = "hybmss_avg" }]
measures = ["region"]
[reference]
elements = []
TOML
"$springproof" compare "$folder"/*.toml --jobs 1 --out "$folder/results" --resume >"$folder/log"

# Eshelby's mean stress along z in a ball under a pull of 1: of all-round pressure and of shear.
awk -F, '
  function modulus(E, nu) { return E / (2 * (1 + nu)) }
  function eshelby(nu, E, nu_inside,   K, K1, G, G1, a, b) {
    K = 1e4 / (3 * (1 - 2 * nu)); K1 = E / (3 * (1 - 2 * nu_inside)); G = modulus(1e4, nu); G1 = modulus(E, nu_inside)
    a = (1 + nu) / (3 * (1 - nu)); b = 2 * (4 - 5 * nu) / (15 * (1 - nu))
    return K1 / (K + a * (K1 - K)) / 3 + 2 / 3 * G1 / (G + b * (G1 - G))
  }
  function off(x, exact) { return 100 * (x / exact - 1) }
  function add(key, error) { n[key]++; sum[key] += error; square[key] += error * error }
  function mean_and_rms(key) { return n[key] ? sprintf("%+.1f (%.1f)", sum[key] / n[key], sqrt(square[key] / n[key])) : "–" }
  FNR == NR { place_of[$1] = $2; next }
  FNR == 1 || $3 != "hybmss_avg" { next }
  { name = $1; sub(/_[0-9]$/, "", name); place = $1; sub(/.*_/, "", place) }
  $6 == "region.ball.mean_stress.zz" && place == 0 && $9 != "" { fem[name, $4] = $9; at[name, $4] = 1 }
  { line[++lines] = $0 }
  END {
    for (i = 1; i <= lines; ++i) {
      split(line[i], f, ","); name = f[1]; sub(/_[0-9]$/, "", name); split(f[5], cells, "x")
      if (f[6] == "region.ball.mean_stress.zz") add(name SUBSEP f[4] SUBSEP (cells[1] > 15 ? 8 : 4), off(f[7], fem[name, f[4]]))
      if (f[6] == "torque.x_max.y") {
        stiff = name ~ /10000/ ? 1e4 : 10; point = place_of[f[1]]
        if (name ~ /layers/) { h = 0.02 - point; EI = bending(1e4, 0, point) + bending(1e4 * stiff, point, 0.02) }
        angle = 0.1 * 3.14159265358979 / 180
        exact = name ~ /layers/ ? EI * angle / 0.08 : angle * 1e4 * 0.02 ^ 4 / 12 / (point + (0.08 - point) / stiff)
        add(name SUBSEP (cells[1] > 10 ? 4 : 2), off(f[7] < 0 ? -f[7] : f[7], exact))
      }
    }
    print "| ball, mean stress along the pull | closed form, no end | finite elements | 4 cells across | 8 cells across |\n|---|---|---|---|---|"
    count = split("100 100000 1000000 100000000", E, " ")
    for (k = 1; k <= count; ++k) row("contrast", E[k], "E × " E[k] / 1e4, eshelby(0.3, E[k], 0.3))
    row("inside_499", 0.3, "ν 0.499 in 0.3", eshelby(0.3, 1e4, 0.499))
    row("around_499", 0.499, "ν 0.3 in 0.499", eshelby(0.499, 1e4, 0.3))
    print "\n| bent bar of two parts, torque | 2 cells across | 4 cells across |\n|---|---|---|"
    split("layers_10 layers_10000 halves_10 halves_10000", beam, " ")
    for (k = 1; k <= 4; ++k) print "| " beam[k] " | " mean_and_rms(beam[k] SUBSEP 2) " | " mean_and_rms(beam[k] SUBSEP 4) " |"
  }
  function bending(E, from, to) { return E * 0.02 * ((to - 0.01) ^ 3 - (from - 0.01) ^ 3) / 3 }
  function row(name, setting, words, exact) {
    printf "| %s | %.3f | %.3f | %s | %s |\n", words, exact, fem[name, setting] / 100, mean_and_rms(name SUBSEP setting SUBSEP 4), mean_and_rms(name SUBSEP setting SUBSEP 8)
  }
' "$folder/places" "$folder/results/results.csv"
printf '\n| bar with a thin layer: along (b) or across (s), cells, thickness, E | mean | rms |\n|---|---|---|\n'
awk -F, '
  function bending(E, from, to) { return E * 0.02 * ((to - 0.01) ^ 3 - (from - 0.01) ^ 3) / 3 }
  FNR == NR { place[$1] = $2; next }
  $1 !~ /^layer/ || $3 != "hybmss_avg" { next }
  { split($1, of, "_"); from = place[$1]; to = from + of[4]; E = of[4] == 0 ? 1e4 : $4; x = $7 < 0 ? -$7 : $7 }
  $6 == "torque.x_max.y" && of[2] == "b" {
    exact = (bending(1e4, 0, from) + bending(E, from, to) + bending(1e4, to, 0.02)) * 0.1 * 3.14159265358979 / 180 / 0.08
  }
  $6 == "force.x_max.x" && of[2] == "s" { exact = 8e-5 * 4e-4 / ((0.08 - of[4]) / 1e4 + of[4] / E) }
  exact { key = of[2] ", " of[3] ", " of[4] ", " E; d = 100 * (x / exact - 1); n[key]++; sum[key] += d; square[key] += d * d; exact = 0 }
  END { for (key in n) printf "| %s | %+.2f | %.2f |\n", key, sum[key] / n[key], sqrt(square[key] / n[key]) }
' "$folder/places" "$folder/results/results.csv" | sort
awk -F, '$1 == "sphere" && $3 == "hybmss_avg" && $6 == "region.core.pressure" { printf "layered ball, pressure in the core, %s: %+.1f %%\n", $5, 100 * ($7 / 1200 - 1) }' \
  "$folder/results/results.csv"
