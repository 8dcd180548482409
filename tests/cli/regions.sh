#!/usr/bin/env bash
# Bodies of several materials: lists in a region, and what is refused.   regions.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1

# ball_case E-OF-THE-CORE NU-OF-THE-CORE: a ball with another ball in it, low and high part held and pulled.
ball_case() {
  cat <<TOML
[body]
geo = "sphere.geo"
size_m = [0.02, 0.02, 0.02]
voxel_edge_m = 0.004
[[patch]]
name = "low"
beyond = { point_m = [0, 0, 0.002], normal = [0, 0, -1] }
[[patch]]
name = "high"
beyond = { point_m = [0, 0, 0.018], normal = [0, 0, 1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.4
[[region]]
name = "core"
near = { point_m = [0.011, 0.01, 0.0105], radius_m = 0.005 }
youngs_modulus_Pa = $1
poisson_ratio = $2
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
on = "high"
force_N = [0, 0.001, 0.002]
[compare]
models = ["hybmss_avg"]
measures = ["displacement_error", "mean_displacement", "region"]
[reference]
edge_m = 0.008
elements = ["p2"]
TOML
}

# results NAME E NU: of that case
results() {
  ball_case "$2" "$3" >"$work/$1.toml"
  "$program" compare "$work/$1.toml" --out "$work/$1" >"$work/$1.log" 2>&1
  [ $? -le 1 ] && [ -e "$work/$1/results.csv" ] || fail "$1 has no results" "$work/$1.log"
}

results nus 1e5 '[0.2, 0.499]'
results stiff 1e5 0.499
results moduli '[1e3, 1e6]' 0.3
results soft 1e3 0.3
# same LIST SINGLE SETTING OF: the numbers of a list at a setting are those of a case of it alone
same() {
  local rows='$5 != "" && $4 == s { print $3, $5, $6, $7, $9, $10 }'
  awk -F, -v s="$3" "$rows" "$work/$1/results.csv" >"$work/some"
  awk -F, -v s="$4" "$rows" "$work/$2/results.csv" >"$work/all"
  [ -s "$work/some" ] && cmp -s "$work/some" "$work/all" || fail "$1 at $3 is not $2" "$work/some" "$work/all"
}
same nus stiff 0.499 0.4
same moduli soft 1000 0.4
[ "$(awk -F, 'NR > 1 { print $16 }' "$work/nus/results.csv" | sort -u)" = "Poisson's ratio of core" ] || fail "nus: not named" "$work/nus/results.csv"
grep -qF "E of core = 1e+06 Pa" "$work/moduli.log" || fail "moduli: not named" "$work/moduli.log"
"$program" diff "$work/moduli" "$work/soft" >"$work/log" && fail "diff of other cases" "$work/log"
grep -q "nu of .*moduli is Young.s modulus of core" "$work/log" || fail "diff does not name the list" "$work/log"

# A springs file of the body is a model like the one that it was written by, and of these regions alone.
"$program" export "$work/soft.toml" --to springs --out "$work/soft.json" >"$work/log" 2>&1 || stop "no springs file"
sed 's/models = .*/models = ["hybmss_avg", { file = "soft.json", label = "own" }]/; s/elements = .*/elements = []/' "$work/soft.toml" >"$work/own.toml"
"$program" compare "$work/own.toml" --out "$work/own" >"$work/log" 2>&1 || stop "a springs file of two materials is no model"
awk -F, '$6 ~ /^region/ { if ($3 == "own") own[$6] = $7; else built[$6] = $7 }
  END { for (m in own) { d = built[m] - own[m]; ++n; if (d < 0) d = -d; if (!(m in built) || d > 1e-9 * (own[m] < 0 ? -own[m] : own[m])) { print m, built[m], own[m]; bad = 1 } }
        exit bad || n < 10 }' "$work/own/results.csv" >"$work/log" || fail "a springs file moves otherwise than its model" "$work/log"
sed 's/^youngs_modulus_Pa = 1e3/youngs_modulus_Pa = 2e3/' "$work/own.toml" >"$work/other.toml"
refused "other.toml:[0-9]+:[0-9]+: compare.models: soft.json: /regions: core .E = 1000 Pa, nu = 0.3, .*allowed: the ..region..s of the case, core .E = 2000 Pa" compare "$work/other.toml" --out "$work/none"

# Whole cubes of each region are counted.
sed '/^\[\[expect/,$d; s/^models = .*/models = ["msm_18"]/; s/^cells = \[32.*/elements = []/' \
  "$(dirname "$0")/../../comparisons/experiments/regions/layered_block.toml" >"$work/cubes.toml"
"$program" compare "$work/cubes.toml" --out "$work/cubes" >"$work/log" 2>&1
[ "$(tr -d ' \n' <"$work/cubes/results.json" | grep -o '"regions":\[.*' | grep -o '"cells":\[[0-9]*\]' | head -2 | tr '\n' ' ')" = '"cells":[96] "cells":[32] ' ] ||
  fail "cells of regions in whole cubes" "$work/log" "$work/cubes/results.json"

# spoilt NAME PATTERN SED-EXPRESSION: one line that says file, line, key, what is allowed
spoilt() {
  ball_case 1e5 0.3 | sed -E "$3" >"$work/case.toml"
  "$program" compare "$work/case.toml" --out "$work/none" >"$work/stdout" 2>"$work/log"
  local status=$?
  [ $status -eq 2 ] && grep -v 'so far' "$work/log" | grep -qE "case.toml:[0-9]+:[0-9]+: $2" || fail "$1: status $status" "$work/log"
}

printf 'solid a\nfacet normal 0 0 1\nouter loop\n' >"$work/open.stl"
spoilt "outside" "region: 'core' holds no part of the body .allowed: a place in the body, of 0.0" 's/point_m = \[0.011, 0.01, 0.0105\]/point_m = [1, 1, 1]/'
spoilt "no cell" "region: 'core', of .* m³, fills less than 1/1000 of a cube of 0.004 m .allowed: voxel_edge_m up to" 's/radius_m = 0.005/radius_m = 1e-5/'
spoilt "in no cell enough" "region: 'core', of .* m³, fills less than 1/1000 of every cube of 0.004 m .allowed: voxel_edge_m up to" 's/point_m = .0.011.*/point_m = [0.012, 0.012, 0.012], radius_m = 0.0004 }/; s/sphere.geo/block.geo/'
spoilt "no such volume" "region.volume: .*has no physical volume 'tumour', which a ..region.. names .allowed: 'body'" 's/^near.*0.005.*/volume = "tumour"/'
spoilt "no such file" "region 'core': .*nothing.stl: no such file" 's/^near.*0.005.*/stl = "nothing.stl"/'
spoilt "open surface" "region 'core': .*open.stl:.*cut off" 's/^near.*0.005.*/stl = "open.stl"/'
spoilt "flat box" "region.box_m: .*allowed: the lower corner, then the higher one" 's/^near.*0.005.*/box_m = [[0, 0, 0], [0, 1, 1]]/'
spoilt "nu = 0.5" "region.poisson_ratio: is 0.5 .allowed: -1 < poisson_ratio < 0.5" 's/^poisson_ratio = 0.3/poisson_ratio = 0.5/'
spoilt "two lists" "region.poisson_ratio: of 'core' is a list, and material.poisson_ratio in line 13 is one" 's/^poisson_ratio = 0.3/poisson_ratio = [0.1, 0.2]/; s/^poisson_ratio = 0.4/poisson_ratio = [0.4, 0.3]/'
spoilt "springs of one material" "compare.models: emsm is of one material in a body: at an interface its springs cross, or its nodes have one dilatation .allowed beside ..region..: lattices of cells" 's/"hybmss_avg"/"emsm"/'
spoilt "cells measured for a list" "compare.models: .*cells are measured for one material of each region" 's/^poisson_ratio = 0.3/poisson_ratio = [0.1, 0.2]/; s/"hybmss_avg"/{ model = "hybmss_avg", coarsened = true }/; s/, "region"//'
spoilt "glue" "region.bond_Pa_per_m: unknown key" 's/^poisson_ratio = 0.3/poisson_ratio = 0.3\nbond_Pa_per_m = 1/'
exit "$failures"
