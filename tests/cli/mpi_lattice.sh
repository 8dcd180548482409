#!/usr/bin/env bash
# A lattice in slabs: two and three processes find what one finds, to 1e-10.   mpi_lattice.sh SPRINGPROOF-LATTICE
program=$1
. "$(dirname "$0")/mpi_common"

# A block pulled at its side, under its weight.   make_case NAME DENSITY
make_case() {
  cat >"$work/$1.toml" <<TOML
[body]
geo = "block.geo"
size_m = [1, 1, 2]
cells = [4, 4, 8]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
density_kg_m3 = $2
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
traction_Pa = [100, 20, 0]
[[load]]
gravity_m_s2 = [0, 1, -1]
[[probe]]
name = "middle"
at_m = [0.41, 0.52, 1.03]
TOML
}
make_case standing 10
make_case block 1000
printf '[[load]]\non = "z_max"\ndisplacement_m = [0.05, 0.02, -0.2]\n' >>"$work/block.toml"

run() { mpirun -q -np "$@" --tolerance 1e-13 --json "$work/json" >"$work/out" 2>"$work/err" && cat "$work/out"; }

measured="^(force|displacement|kinetic)"
compare() {
  vectors "$1" "$measured" >"$work/a" && vectors "$2" "$measured" >"$work/b" &&
    same_numbers "$work/a" "$work/b" "displacement|force|energy" 1e-10 2
}

check() {
  local name=$1
  shift
  run 1 "$program" "$work/$name.toml" "$@" >"$work/one" || { fail "one process, $*" "$work/err"; return; }
  for processes in 2 3; do
    run $processes "$program" "$work/$name.toml" "$@" >"$work/more" || { fail "$processes processes, $*" "$work/err"; return; }
    compare "$work/one" "$work/more" || { fail "$processes processes, $*"; return; }
  done
  echo "same: $name $*"
}
check block
check block --cells 9 9 18
check block --cells 16 16 32 --poisson-ratio 0.4
check block --cells 15 15 30 --poisson-ratio -0.5 --model msm_18
check block --cells 20 20 40 --poisson-ratio 0.3 --model hybmss_bt
check standing --cells 8 8 16 --poisson-ratio 0.3 --steps 500 --damping 2
check standing --cells 6 6 12 --poisson-ratio 0.3 --model hybmss_bt --steps 300 --damping 2

# What is wrong is said once, with exit status 2.   refuse WHAT MESSAGE ARGUMENTS
refuse() {
  local what=$1 message=$2
  shift 2
  mpirun -q -np 2 "$program" "$@" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq 2 ] && [ "$(grep -c -- "$message" "$work/err")" -eq 1 ] && { echo "refused: $what"; return; }
  fail "$what ended with $status" "$work/out" "$work/err"
}
refuse "cells that are no cubes" "needs cubes" "$work/block.toml" --cells 4 4 9
refuse "steps of a model without cells" "no lattice of cells" "$work/block.toml" --model emsm --steps 1
sed 's/\[0, 0, 0\]/["free", "free", 0]/; s/\[0.05, 0.02, -0.2\]/["free", "free", -0.2]/' "$work/block.toml" >"$work/loose.toml"
refuse "a body that is not held" "is not held" "$work/loose.toml"
printf '[[load]]\non = "z_max"\ndisplacement_m = ["free", "free", 0]\n' | cat "$work/block.toml" - >"$work/conflict.toml"
refuse "two values at one node" "conflict.toml:.*is prescribed by the load in line" "$work/conflict.toml"
printf '[[load]]\non = "x_min"\nforce_N = [1, 0, 0]\n' | cat "$work/block.toml" - >"$work/force.toml"
refuse "steps under a force over a patch" "not shared out" "$work/force.toml" --steps 1
refuse "no cubes" "^--voxels: Value -3 not in range 1 to 4000000" "$work/block.toml" --voxels -3
refuse "cells of a negative number" "^--cells: Value -1 not in range 1 to 1000" "$work/block.toml" --cells 4 -1 4
refuse "no iterations" "^--max-iterations: Value 0 not in range 1 to 1000000" "$work/block.toml" --max-iterations 0
refuse "steps back" "^--steps: Value -1 not in range 0 to 1000000000" "$work/block.toml" --steps -1
for damping in -1 nan; do
  refuse "a damping of $damping" "^--damping: is $damping (allowed: a finite number >= 0)" "$work/block.toml" --damping $damping
done
check force --poisson-ratio 0.3   # in equilibrium: in parts instead of slabs
exit $((failures > 0))
