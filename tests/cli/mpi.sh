#!/usr/bin/env bash
# Two processes find what one finds, to 1e-9.   mpi.sh SPRINGPROOF-FEM
set -u
program=$1
. "$(dirname "$0")/mpi_common"

# A block held at both ends, under its weight.   make_case NAME KINEMATICS
make_case() {
  cat >"$work/$1.toml" <<TOML
kinematics = "$2"
[body]
geo = "block.geo"
size_m = [1, 1, 2]
cells = [4, 4, 8]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
density_kg_m3 = 1000
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0.05, 0.02, -0.2]
[[load]]
gravity_m_s2 = [0, 1, 0]
[[probe]]
name = "middle"
at_m = [0.5, 0.5, 1]
[[probe]]
name = "corner"
at_m = [1, 0, 0.75]
[[probe]]
name = "inside"
at_m = [0.31, 0.77, 1.23]
TOML
}

# Curved hexahedra under a pressure.
cat >"$work/cylinder.toml" <<TOML
[body]
geo = "thick_cylinder.geo"
size_m = [9, 9, 1]
cells = [12, 6, 1]
[material]
youngs_modulus_Pa = 1000
poisson_ratio = 0.25
[[load]]
on = ["z_min", "z_max"]
displacement_m = ["free", "free", 0]
[[load]]
on = "x_min"
displacement_m = [0, "free", "free"]
[[load]]
on = "y_min"
displacement_m = ["free", 0, "free"]
[[load]]
on = "inner"
pressure_Pa = 1
[[probe]]
name = "middle"
at_m = [6, 0, 0.5]
[[probe]]
name = "inside"
at_m = [3, 3, 0.25]
TOML

compare() { same_numbers "$1" "$2" "volume|reaction|middle|corner|inside" 1e-9 9; }

check() {
  local name=$1
  shift
  "$program" "$work/$name.toml" --tolerance 1e-12 --digits 14 "$@" >"$work/one" 2>&1 || { echo "FAILED: one process, $name $*"; cat "$work/one"; failed=1; return; }
  mpirun -np 2 "$program" "$work/$name.toml" --tolerance 1e-12 --digits 14 "$@" >"$work/two" 2>&1 || { echo "FAILED: two processes, $name $*"; cat "$work/two"; failed=1; return; }
  compare "$work/one" "$work/two" || { echo "FAILED: $name $*"; failed=1; return; }
  echo "same: $name $*"
}

make_case block linear
make_case hencky hencky
check block --cells 6 6 12
check block --cells 6 6 12 --poisson-ratio 0.499
check block --cells 6 6 8 --grading 1.5 --element q1
check hencky --cells 4 4 8
check hencky --cells 4 4 8 --poisson-ratio 0.499
check block --cells 4 4 8 --element p2
check block --cells 4 4 8 --element p2 --poisson-ratio 0.499
check hencky --cells 3 3 4 --element p2
check block --cells 4 4 8 --solver assembled
check cylinder --poisson-ratio 0.499

# What one process alone can see is told to all: one message, exit status 2.
refuse() {
  mpirun -q -np 2 "$program" "$work/$1.toml" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq 2 ] && [ "$(grep -c "$2" "$work/err")" -eq 1 ] && { echo "refused: $1"; return; }
  echo "FAILED: $1 ended with $status"
  cat "$work/err"
  failed=1
}
make_case outside linear
sed -i 's/at_m = \[0.31, .*/at_m = [0.31, 0.77, 3]/' "$work/outside.toml"
refuse outside "is outside the body"
make_case conflict linear
printf '[[load]]\non = "x_min"\ndisplacement_m = ["free", "free", 0]\n' >>"$work/conflict.toml"
refuse conflict "prescribe different"
make_case loose linear
sed -i -e 's/displacement_m = \[0, 0, 0\]/displacement_m = ["free", "free", 0]/' -e 's/displacement_m = \[0.05, 0.02, -0.2\]/displacement_m = ["free", "free", -0.2]/' "$work/loose.toml"
refuse loose "is not held"
exit $failed
