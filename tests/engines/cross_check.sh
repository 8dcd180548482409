#!/usr/bin/env bash
# CalculiX and our reference on the same cases; exported decks run by themselves.   cross_check.sh PROGRAM [FEM-PROGRAM]
# Exit status 77, skipped, without ccx or springproof-fem.
. "$(dirname "$0")/../cli/lib.sh"
program=$1

# Without ccx: status 3 and the command that installs it.
mkdir "$work/empty"
PATH="$work/empty" "$program" cross-check cross_check/shear_st_venant_kirchhoff >"$work/out" 2>"$work/err"
[ $? -eq 3 ] && grep -q "apt-get install calculix-ccx" "$work/err" || fail "without ccx" "$work/err"

cat >"$work/ball.toml" <<'TOML'
[body]
geo = "sphere.geo"
size_m = [1, 1, 1]
voxels = 500
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[patch]]
name = "low"
beyond = { point_m = [0.5, 0.5, 0.2], normal = [0, 0, -1] }
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -1]
TOML
# The cells of a body of tetrahedra, and damping in steps of time: refused before anything is meshed.
export SPRINGPROOF_MESH_CACHE=$work/meshes
"$program" cross-check "$work/ball.toml" --cells 4 4 4 >"$work/out" 2>"$work/err"
[ $? -eq 2 ] && grep -q "edge_m" "$work/err" || fail "cells of a body of voxels" "$work/err"
sed 's/duration_s/damping_1_s = 1\nduration_s/' "$(dirname "$0")/../../comparisons/experiments/cross_check/struck_bar_st_venant_kirchhoff.toml" >"$work/damped.toml"
"$program" cross-check "$work/damped.toml" >"$work/out" 2>"$work/err"
[ $? -eq 2 ] && grep -q "damped.toml:33:1: dynamics: CalculiX' decks have no damping" "$work/err" || fail "damping" "$work/err"
[ ! -e "$work/meshes" ] || fail "it was meshed first"
unset SPRINGPROOF_MESH_CACHE

# A law that CalculiX does not have: status 2 and those it has.
sed 's/st_venant_kirchhoff/hencky/' "$(dirname "$0")/../../comparisons/experiments/cross_check/shear_st_venant_kirchhoff.toml" >"$work/case.toml"
for command in cross-check "export --to calculix --out $work/case.inp"; do
  "$program" $command "$work/case.toml" >"$work/out" 2>"$work/err"
  [ $? -eq 2 ] && grep -q "linear, neo_hooke_isochoric, st_venant_kirchhoff" "$work/err" || fail "hencky: $command" "$work/err"
  [ ! -e "$work/case.inp" ] || fail "a deck was written"
done
"$program" export golec_2019/bending --to calculix --poisson-ratio 0.3 --out "$work/case.inp" 2>"$work/err"
[ $? -eq 2 ] && grep -q "0.25" "$work/err" || fail "unknown Poisson's ratio" "$work/err"

command -v ccx >/dev/null || { echo "ccx is not installed (apt-get install calculix-ccx)"; exit $((failures > 0 ? 1 : 77)); }

# A deck by itself: the support carries the weight, 480 N, less the share that acts on its own nodes, 1/6 of an element's.
"$program" export cross_check/bending_st_venant_kirchhoff --to calculix --poisson-ratio 0.25 --cells 6 1 1 --out "$work/beam.inp" >"$work/out" ||
  fail "export" "$work/out"
(cd "$work" && ccx beam >ccx.log) || fail "ccx" "$work/ccx.log"
grep -q ERROR "$work/ccx.log" && fail "ccx found errors in the deck" "$work/ccx.log"
weight=$(awk '/total force.*X_MIN/ { getline; getline; print $3 }' "$work/beam.dat")
awk -v w="$weight" 'BEGIN { exit !(w > 466.66 && w < 466.67) }' || fail "the support carries $weight N, not 480 - 80/6 N"

"$program" cross-check cross_check/shear_st_venant_kirchhoff --poisson-ratio 0.25 --cells 4 4 4 >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 3 ] && { echo "springproof-fem is not built (deal.II: apt-get install libdeal.ii-dev)"; exit $((failures > 0 ? 1 : 77)); }

# agree NAME NU CELLS
agree() {
  "$program" cross-check "$1" --poisson-ratio "$2" --cells $3 >"$work/out" 2>"$work/err" || { cat "$work/out"; fail "$1, nu = $2" "$work/err"; }
}
agree golec_2019/compression 0.25 "4 4 4"
agree golec_2019/compression -0.5 "4 4 4"
agree golec_2019/compression 0.499 "8 8 8"
agree golec_2019/bending 0.25 "24 4 4"
agree golec_2019/torsion 0.25 "4 4 4"
for law in st_venant_kirchhoff neo_hooke_isochoric; do
  agree cross_check/compression_$law 0.25 "4 4 4"
  agree cross_check/torsion_$law 0.25 "4 4 4"
done

# A body of tetrahedra on the same meshes, with the same equations; frequencies, of two materials too; a motion.
SPRINGPROOF_MESH_CACHE=$work/meshes "$program" cross-check "$work/ball.toml" >"$work/out" 2>"$work/err" || { cat "$work/out"; fail "ball" "$work/err"; }
grep -q "the same, finest mesh .* yes" "$work/out" || fail "the same mesh" "$work/out"
"$program" cross-check regions/two_materials --modes 4 >"$work/out" 2>"$work/err" || { cat "$work/out"; fail "modes of two materials" "$work/err"; }
[ "$(grep -c "^frequency.* yes" "$work/out")" -eq 4 ] || fail "four frequencies" "$work/out"
sed 's/cells = \[16, 4, 4\]/cells = [8, 4, 4]/; s/samples = 80/samples = 30/' "$(dirname "$0")/../../comparisons/experiments/cross_check/struck_bar_st_venant_kirchhoff.toml" >"$work/struck.toml"
"$program" cross-check "$work/struck.toml" >"$work/out" 2>"$work/err" || { cat "$work/out"; fail "a motion" "$work/err"; }
grep -q "probes in time, rms .* yes" "$work/out" || fail "its history" "$work/out"

# A CalculiX with another material must be found out.
ccx=$(command -v ccx)
mkdir "$work/other"
cat >"$work/other/ccx" <<SH
#!/bin/sh
[ -e case.inp ] && sed -i '/^\*ELASTIC/ { n; s/^10000/10300/ }' case.inp
exec $ccx "\$@"
SH
chmod +x "$work/other/ccx"
PATH="$work/other:$PATH" "$program" cross-check golec_2019/compression --poisson-ratio 0.25 --cells 8 8 8 >"$work/out" 2>"$work/err"
[ $? -eq 1 ] && grep -q "force.z_max.z .* NO" "$work/out" || fail "another material was not found out" "$work/out"
PATH="$work/other:$PATH" "$program" cross-check "$work/ball.toml" >"$work/out" 2>"$work/err"
[ $? -eq 1 ] && grep -q "the same, finest mesh .* NO" "$work/out" || fail "another material of a ball" "$work/out"

# An interrupt ends ccx and leaves nothing behind.
mkdir "$work/tmp"
printf '#!/bin/sh\n[ "$1" = -v ] || exec sleep 100\n' >"$work/other/ccx"
PATH="$work/other:$PATH" TMPDIR="$work/tmp" "$program" cross-check golec_2019/compression >"$work/out" 2>"$work/err" &
pid=$!
for _ in $(seq 100); do
  [ -n "$(ls "$work/tmp")" ] && break
  sleep 0.1
done
kill -INT $pid
wait $pid
[ $? -eq 130 ] && [ -z "$(ls "$work/tmp")" ] || fail "an interrupt should end with 130 and an empty folder" "$work/err"

# So does the time limit, which counts as no answer.
PATH="$work/other:$PATH" TMPDIR="$work/tmp" "$program" cross-check golec_2019/compression --poisson-ratio 0.25 --cells 4 4 4 --time-limit 0.5 >"$work/out" 2>"$work/err"
[ $? -eq 1 ] && grep -q "longer than 0.5 s" "$work/err" && [ -z "$(ls "$work/tmp")" ] || fail "time limit" "$work/err"

[ $failures -eq 0 ] && echo "CalculiX and our reference agree"
exit $((failures > 0))
