#!/usr/bin/env bash
# Bodies of voxels, of cut cells and of random springs in parts: two processes, and for one model also one and three, find what
# `compare` finds, to 1e-9.
#   mpi_network.sh SPRINGPROOF-LATTICE SPRINGPROOF
set -u
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
"$springproof" compare "$work/bar.toml" --out "$work/compared" >"$work/out" 2>&1   # status 1: nothing is expected
[ -s "$work/compared/results.csv" ] || { echo "FAILED: compare"; cat "$work/out"; exit 1; }

# Values that compare found, as the program prints them.   compared MODEL NU
compared() {
  awk -F, -v model="$1" -v nu="$2" '$3 == model && $4 == nu && $6 ~ /^(force|displacement)/ { print $6 ": " $7 }' "$work/compared/results.csv"
}

# check MODEL NU PROCESSES ...
check() {
  local model=$1 nu=$2 numbers=("${@:3}")
  compared "$model" "$nu" | sort >"$work/expected"
  vectors "$work/expected" "^(force|displacement)[.]" >"$work/expected_vectors"
  for processes in "${numbers[@]}"; do
    mpirun -q -np $processes "$program" "$work/bar.toml" --model "$model" --poisson-ratio "$nu" --tolerance 1e-12 >"$work/out" 2>"$work/err" ||
      { echo "FAILED: $model, nu = $nu, $processes processes"; cat "$work/out" "$work/err"; failed=1; return; }
    sort "$work/out" >"$work/sorted"
    vectors "$work/sorted" "^(force|displacement)[.]" >"$work/found_vectors"
    same_numbers "$work/expected_vectors" "$work/found_vectors" . 1e-9 3 ||
      { echo "FAILED: $model, nu = $nu, $processes processes against compare"; failed=1; return; }
  done
  echo "same: $model, nu = $nu"
}
check hybmss_avg 0.3 1 2 3
check hybmss_avg 0.49 2
check "hybmss_avg cut=false" 0.3 2
for model in hybmss_b emsm emsm_random emsm_patch; do check "$model" 0.49 2; done
check msm_random 0.3 2

# What is wrong is said once, with exit status 2.   refuse WHAT MESSAGE ARGUMENTS
refuse() {
  local what=$1 message=$2
  shift 2
  timeout 60 mpirun -q -np 2 "$program" "$@" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq 2 ] && [ "$(grep -c -- "$message" "$work/err")" -eq 1 ] && { echo "refused: $what"; return; }
  echo "FAILED: $what ended with $status"
  cat "$work/out" "$work/err"
  failed=1
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
  { echo "FAILED: an error of one process ended with $status"; cat "$work/out" "$work/err"; failed=1; }
exit $failed
