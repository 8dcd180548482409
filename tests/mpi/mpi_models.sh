#!/usr/bin/env bash
# Blocks, bodies of voxels, of cut cells and of random springs on several processes: `compare --resume` reports what they found as
# what it would have found itself, to 1e-9; lattices with levels below them in few iterations.   mpi_models.sh SPRINGPROOF-MPI SPRINGPROOF
program=$1 springproof=$2
. "$(dirname "$0")/mpi_common"

# case_of BODY MODELS: clamped at one end, turned, bent and pulled at the other, under its weight.
case_of() {
  cat <<TOML
[body]
$1
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.3, 0.49]
density_kg_m3 = 1000
[[load]]
on = "$2"
displacement_m = [0, 0, 0]
[[load]]
on = "$3"
displacement_m = [0.002, "free", -0.004]
[[load]]
gravity_m_s2 = [0, 1, -1]
[[probe]]
name = "middle"
at_m = [0.02, 0.01, 0.09]
[compare]
models = [$4]
measures = ["reaction", "probe", "volume_change"]
[reference]
elements = []
TOML
}
round() { printf 'geo = "cylinder.geo"\nsize_m = [0.1, 0.1, 0.2]\nvoxels = [%s]' "$1"; }
block() { printf 'geo = "block.geo"\nsize_m = %s\ncells = [%s]' "$1" "$2"; }
cells='"hybmss_avg", { model = "hybmss_avg", cut = false }'
# Few enough cells for compare to factorise all lattices.
case_of "$(round 120)" bottom top "$cells, \"hybmss_b\", \"emsm\", \"emsm_random\", \"emsm_patch\"" >"$work/bar.toml"
# From more cells coarser lattices follow; compare solves them to a residual of 1e-10 only.
case_of "$(round 1200)" bottom top "$cells" >"$work/fine.toml"
case_of "$(block '[0.1, 0.1, 0.2]' '[4, 4, 8], [9, 9, 18]')" z_min z_max '"hybmss", "hybmss_avg", "hybmss_bt", "msm_18"' >"$work/block.toml"
case_of "$(block '[0.2, 0.1, 0.2]' '[8, 8, 12]')" x_min x_max '"hybmss_avg"' >"$work/boxes.toml"
# A stiff ball, and a soft layer whose nu is a list and below 1/4: bonds, and pressures in some materials only.
{
  case_of "$(round 1200)" bottom top "$cells, \"hybmss\"" | sed 's/^poisson_ratio = .*/poisson_ratio = 0.49/'
  cat <<TOML
[[region]]
name = "ball"
near = { point_m = [0.01, 0, 0.11], radius_m = 0.033 }
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
density_kg_m3 = 3000
[[region]]
name = "layer"
beyond = { point_m = [0, 0, 0.16], normal = [0, 0, 1] }
youngs_modulus_Pa = 1e3
poisson_ratio = [0.1, 0.45]
TOML
} >"$work/regions.toml"

# The rows of compare, and of compare --resume after PROCESSES processes have solved the models.
# check CASE TOLERANCE MOST-ITERATIONS PROCESSES ...
check() {
  local case=$1 tolerance=$2 most=$3 runs
  "$springproof" compare "$work/$case.toml" --quiet --out "$work/$case" >"$work/out" 2>&1   # status 1: nothing is expected
  for processes in "${@:4}"; do
    local out=$work/$case-$processes
    mpirun -q -np "$processes" "$program" "$work/$case.toml" --out "$out" --tolerance 1e-12 >"$work/found" 2>"$work/err" ||
      { fail "$case, $processes processes" "$work/found" "$work/err"; return; }
    "$springproof" compare "$work/$case.toml" --quiet --resume --out "$out" >"$work/out" 2>&1
    "$springproof" diff "$work/$case" "$out" --tolerance "$tolerance" >"$work/out" 2>&1 ||
      { fail "$case, $processes processes against compare" "$work/out"; return; }
    # Every run in the report is theirs.
    runs=$(grep -c ' iterations, ' "$work/found")
    [ "$runs" -ge 2 ] && [ "$(grep -oE "\"solver\": \"(CG|GMRES)[^\"]*, $processes process(es)?\"" "$out/results.json" | wc -l)" -eq "$runs" ] ||
      fail "$case, $processes processes: $runs runs, and in the report" "$work/found" "$out/results.csv"
    awk -v most="$most" '/ iterations, / { n = $0; sub(/ iterations, .*/, "", n); sub(/.* /, "", n); n += 0; if (!(n > 0 && n <= most)) { print; bad = 1 } } END { exit bad }' \
      "$work/found" || fail "$case, $processes processes: more than $most iterations"
  done
  echo "same: $case"
}
check bar 1e-9 1000 2
check fine 1e-8 40 1 2 3 4  # 13 to 15, or twice that where a residual of 1e-12 takes a second start; smoothed aggregation: 60 to 116
check block 1e-8 60 1 3
check boxes 1e-8 40 2
check regions 1e-8 100 3  # 22 to 26 to 1e-8

# A built-in case, which is judged as without mpirun.
mpirun -q -np 2 "$program" bodies/cylinder_compression --out "$work/built_in" >"$work/out" 2>"$work/err" || fail "a built-in case" "$work/out" "$work/err"
"$springproof" compare bodies/cylinder_compression --quiet --resume --out "$work/built_in" >"$work/out" 2>&1 || fail "the verdict on it" "$work/out"
grep -q ', 2 processes"' "$work/built_in/results.json" || fail "the built-in case is another's"

# What is wrong is said once.   refuse WHAT STATUS MESSAGE ARGUMENTS
refuse() {
  local what=$1 expected=$2 message=$3
  shift 3
  timeout 60 mpirun -q -np 2 "$program" --out "$work/refused" "$@" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq "$expected" ] && [ "$(grep -c -- "$message" "$work/err")" -eq 1 ] && { echo "refused: $what"; return; }
  fail "$what ended with $status" "$work/out" "$work/err"
}
sed 's/"hybmss_avg", {/{ model = "emsm", dispersion = "published" }, {/' "$work/bar.toml" >"$work/published.toml"
refuse "forces without an energy" 1 "^emsm dispersion=published, ν = 0.3, .* is left to springproof compare: .* no energy" "$work/published.toml" \
  --model "emsm dispersion=published" --poisson-ratio 0.3
sed 's/\[0, 0, 0\]/["free", "free", 0]/; s/\[0.002, "free", -0.004\]/["free", "free", 0]/' "$work/bar.toml" >"$work/loose.toml"
refuse "a body that is not held" 2 "motion" "$work/loose.toml"
refuse "an unknown model" 2 "those at rest: hybmss_avg, " "$work/bar.toml" --model emsm_rand
sed '1i kinematics = "hencky"' "$work/block.toml" >"$work/large.toml"
refuse "large displacements" 2 "its displacements are large" "$work/large.toml"
refuse "a tolerance of nothing" 2 "--tolerance" "$work/bar.toml" --tolerance 0
# An error of one process alone ends all: the file is not there on the second.
timeout 60 mpirun -q -np 1 "$program" "$work/bar.toml" : -np 1 "$program" "$work/missing.toml" >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 2 ] && [ "$(grep -c missing.toml "$work/err")" -eq 1 ] && echo "ended: an error of one process" ||
  fail "an error of one process ended with $status" "$work/out" "$work/err"
exit $((failures > 0))
