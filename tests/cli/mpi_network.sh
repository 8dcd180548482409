#!/usr/bin/env bash
# Bodies of voxels, of cut cells and of random springs in parts: two processes, and for one model also one and three, find what
# `compare` finds, to 1e-9; lattices with levels below them in few iterations.
#   mpi_network.sh SPRINGPROOF-LATTICE SPRINGPROOF
program=$1 springproof=$2
. "$(dirname "$0")/mpi_common"

# A round bar that is turned, bent and pulled, under its weight.
cat >"$work/bar.toml" <<TOML
[body]
geo = "cylinder.geo"
size_m = [0.1, 0.1, 0.2]
voxels = [120]   # few enough for compare to factorise all lattices
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.3, 0.49]
density_kg_m3 = 1000
[[load]]
on = "bottom"
displacement_m = [0, 0, 0]
[[load]]
on = "top"
displacement_m = [0.002, "free", -0.004]
[[load]]
gravity_m_s2 = [0, 1, -1]
[[probe]]
name = "middle"
at_m = [0.02, 0.01, 0.09]
[compare]
models = ["hybmss_avg", { model = "hybmss_avg", cut = false }, "hybmss_b", "emsm", "emsm_random", "emsm_patch", "msm_random"]
measures = ["reaction", "probe"]
[reference]
elements = []
TOML
# The same of more cells, from which coarser lattices follow; compare solves it to a residual of 1e-10 only.
sed 's/^voxels.*/voxels = [1200]/; s/^models.*/models = ["hybmss_avg", { model = "hybmss_avg", cut = false }]/' "$work/bar.toml" >"$work/fine.toml"
for case in bar fine; do
  "$springproof" compare "$work/$case.toml" --out "$work/$case" >"$work/out" 2>&1   # status 1: nothing is expected
  [ -s "$work/$case/results.csv" ] || { echo "FAILED: compare"; cat "$work/out"; exit 1; }
done

# Values that compare found, as the program prints them.   compared CASE MODEL NU
compared() {
  awk -F, -v model="$2" -v nu="$3" '$3 == model && $4 == nu && $6 ~ /^(force|displacement)/ { print $6 ": " $7 }' "$work/$1/results.csv"
}

# At most so many iterations; empty: any number.   bounded MOST
bounded() {
  [ -z "$1" ] || awk -v most="$1" '/ iterations, / { n = $(NF - 3) } END { exit !(n > 0 && n <= most) }' "$work/out"
}

# check_case CASE FRACTION ITERATIONS MODEL NU PROCESSES ...
check_case() {
  local case=$1 fraction=$2 most=$3 model=$4 nu=$5 numbers=("${@:6}")
  compared "$case" "$model" "$nu" | sort >"$work/expected"
  vectors "$work/expected" "^(force|displacement)[.]" >"$work/expected_vectors"
  for processes in "${numbers[@]}"; do
    mpirun -q -np $processes "$program" "$work/$case.toml" --model "$model" --poisson-ratio "$nu" --tolerance 1e-12 >"$work/out" 2>"$work/err" ||
      { fail "$model, nu = $nu, $processes processes" "$work/out" "$work/err"; return; }
    sort "$work/out" >"$work/sorted"
    vectors "$work/sorted" "^(force|displacement)[.]" >"$work/found_vectors"
    same_numbers "$work/expected_vectors" "$work/found_vectors" . "$fraction" 3 ||
      { fail "$model, nu = $nu, $processes processes against compare"; return; }
    bounded "$most" || { fail "$model, nu = $nu, $processes processes: more than $most iterations" "$work/out"; return; }
  done
  echo "same: $case, $model, nu = $nu"
}
check() { check_case bar 1e-9 "" "$@"; }
check hybmss_avg 0.3 1 2 3
check hybmss_avg 0.49 2
check "hybmss_avg cut=false" 0.3 2
for model in hybmss_b emsm emsm_random emsm_patch; do check "$model" 0.49 2; done
check msm_random 0.3 2
# With smoothed aggregation 60 and 116, of whole cubes 22 and 64.
check_case fine 1e-8 14 hybmss_avg 0.3 1 2 3
check_case fine 1e-8 20 hybmss_avg 0.49 1 2 3
check_case fine 1e-8 14 "hybmss_avg cut=false" 0.3 2
check_case fine 1e-8 20 "hybmss_avg cut=false" 0.49 2

# Boxes are no slabs, but parts.
cat >"$work/boxes.toml" <<TOML
[body]
geo = "block.geo"
size_m = [2, 1, 2]
cells = [8, 8, 12]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.3, 0.49]
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
displacement_m = [0.02, "free", -0.04]
[[probe]]
name = "middle"
at_m = [1.1, 0.2, 0.3]
[compare]
models = ["hybmss_avg"]
measures = ["reaction", "probe"]
[reference]
elements = []
TOML
"$springproof" compare "$work/boxes.toml" --out "$work/boxes" >"$work/out" 2>&1
check_case boxes 1e-8 30 hybmss_avg 0.3 1 2
check_case boxes 1e-8 40 hybmss_avg 0.49 2

# What is wrong is said once, with exit status 2.   refuse WHAT MESSAGE ARGUMENTS
refuse() {
  local what=$1 message=$2
  shift 2
  timeout 60 mpirun -q -np 2 "$program" "$@" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq 2 ] && [ "$(grep -c -- "$message" "$work/err")" -eq 1 ] && { echo "refused: $what"; return; }
  fail "$what ended with $status" "$work/out" "$work/err"
}
sed 's/"hybmss_avg", {/{ model = "emsm", dispersion = "published" }, {/' "$work/bar.toml" >"$work/published.toml"
refuse "forces without an energy" "have no energy" "$work/published.toml" --model "emsm dispersion=published"
sed 's/\[0, 0, 0\]/["free", "free", 0]/; s/\[0.002, "free", -0.004\]/["free", "free", 0]/' "$work/bar.toml" >"$work/loose.toml"
refuse "a body that is not held" "motion" "$work/loose.toml" --model emsm
refuse "explicit steps of such a body" "no full block" "$work/bar.toml" --model emsm --steps 10
refuse "cells of a body of voxels" "allowed: --voxels" "$work/bar.toml" --cells 4 4 4
refuse "an unknown model" "emsm_rand" "$work/bar.toml" --model emsm_rand
# An error of one process alone ends all: the file is not there on the second.
timeout 60 mpirun -q -np 1 "$program" "$work/bar.toml" : -np 1 "$program" "$work/missing.toml" >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 2 ] && [ "$(grep -c missing.toml "$work/err")" -eq 1 ] && echo "ended: an error of one process" ||
  fail "an error of one process ended with $status" "$work/out" "$work/err"
exit $((failures > 0))
