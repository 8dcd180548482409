#!/usr/bin/env bash
# Unusable input: exit status 2, one clear line on stderr, nothing written.   bad_input.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

good=$(block_case 0.25; printf '[compare]\nmodels = ["hybmss"]\n')

# expect NAME PATTERN ARGUMENTS...: status 2, one line that matches, no output folder
expect() {
  local name=$1 pattern=$2
  shift 2
  rm -rf "$work/out"
  "$program" "$@" >"$work/stdout" 2>"$work/stderr"
  local status=$?
  if [ $status -ne 2 ] || [ "$(wc -l <"$work/stderr")" -ne 1 ] || ! grep -qE "$pattern" "$work/stderr" || [ -e "$work/out" ]; then
    fail "$name: status $status, stderr:" "$work/stderr"
  fi
}

# edited NAME PATTERN SED-EXPRESSION: the good case, spoilt
edited() {
  sed -E "$3" <<<"$good" >"$work/case.toml"
  expect "$1" "$2" compare "$work/case.toml" --out "$work/out"
}

edited "unknown key" "case.toml:4:1: .*cell.*did you mean 'cells'" 's/^cells/cell/'
edited "E of the trade" "case.toml:6:1: material.E: unknown key .*; youngs_modulus_Pa is Young's modulus" 's/^youngs_modulus_Pa/E/'
edited "a fixed patch" "load.fixed: unknown key .*; displacement_m = .0, 0, 0. in a ..load.. holds a patch" 's/^displacement_m = \[0, 0, 0\]/fixed = true/'
edited "contact of bodies" "contact: unknown key .*; there is no contact but with a plane: plane of .dynamics." '$s/$/\n[contact]/'
edited "nu = 0.5" "case.toml:7:.*poisson_ratio.*0\.5" 's/0\.25/0.5/'
edited "nu = 0.6" "case.toml:7:.*poisson_ratio.*0\.6" 's/0\.25/0.6/'
edited "E < 0" "case.toml:6:.*youngs_modulus" 's/1e4/-1e4/'
edited "E is text" "case.toml:6:.*youngs_modulus" 's/1e4/"soft"/'
edited "cells = 0" "case.toml:4:.*cells" 's/\[2, 2, 2\]/[2, 0, 2]/'
edited "not cubes" "cubes" 's/\[2, 2, 2\]/[2, 2, 3]/'
edited "gravity without density" "case.toml:5:1: material.density_kg_m3: is missing" 's/^on = "z_max"$/gravity_m_s2 = [0, 0, -9.81]/; s/^displacement_m = \[0, 0, 0.01\]$//'
edited "model off its kinematics" "case.toml:16:.*hybmss_bt.*linear.*hencky.*allowed: msm_18.*hybmss_cf" 's/^\[body\]/kinematics = "hencky"\n[body]/; s/"hybmss"/"hybmss_bt"/'
edited "parts of a block" "case.toml:15:9: compare.parts: is for bodies that are cut out of a lattice" 's/^models/parts = true\nmodels/'
edited "no such patch" "z_top" 's/z_max/z_top/'
edited "unconstrained body" "not held" 's/\[0, 0, 0\]/["free", "free", 0]/; s/\[0, 0, 0\.01\]/["free", "free", 0.01]/'
edited "no such model" "hybms.*did you mean 'hybmss'" 's/"hybmss"/"hybms"/'
edited "no such body" "ball.geo" 's/block.geo/ball.geo/'
edited "three moduli" "material" 's/^poisson_ratio/shear_modulus_Pa = 1\npoisson_ratio/'
edited "truncated" "case.toml:[0-9]+:[0-9]+" 's/0\.01\]//'
edited "empty" "case.toml" 's/.*//'
expect "missing file" "nothing.toml" compare "$work/nothing.toml" --out "$work/out"
head -c 300 /dev/urandom >"$work/noise.toml"
expect "noise" "noise.toml" compare "$work/noise.toml" --out "$work/out"
echo "$good" >"$work/good.toml"
touch "$work/file"
expect "none of the Poisson ratios" "none of those wanted .allowed: 0.25" compare "$work/good.toml" --poisson-ratio 0.3 --out "$work/out"
expect "unwritable output" "cannot write" compare "$work/good.toml" --out "$work/file/out"
expect "material: nu = 0.5" "poisson_ratio" material -E 1 --nu 0.5
expect "material: one modulus" "two" material -E 1
expect "material: no such model" "did you mean" material -E 1 --nu 0.3 --model hybms
expect "homogenise: no such model" "did you mean" homogenise -E 1 --nu 0.3 --model hybms
expect "homogenise: planar" "planar" homogenise -E 1 --nu 0.3 --model msm_hexagonal
expect "homogenise: seeds of a lattice" "unknown option 'seeds'" homogenise -E 1 --nu 0.3 --model hybmss --seeds 3
expect "homogenise: half a seed" "whole number" homogenise -E 1 --nu 0.3 --seed 1.5
expect "homogenise: box too small" "three times" homogenise -E 1 --nu 0.3 --nodes 8

touch "$work/UPPER.STL"
expect "a body in place of a case" "UPPER.STL is a body .allowed: a case, NAME.toml, in which .body. has geo = \"UPPER.STL\"" compare "$work/UPPER.STL" --out "$work/out"
for none in /dev/zero /proc/self/mem; do expect "$none" "$none: .*allowed: a case file" compare $none --out "$work/out"; done

# Names: loops of links, thousands of letters, other encodings.
long=$(printf 'x%.0s' $(seq 5000))
ln -s loop.toml "$work/loop.toml"
ln -s loop "$work/loop"
expect "loop of links" "loop.toml: .*no such case file" compare "$work/loop.toml" --out "$work/out"
expect "folder in a loop of links" "no such case file" compare "$work/loop/case.toml" --out "$work/out"
expect "name of 5000 letters" "5[0-9]{3} letters" compare "$long.toml" --out "$work/out"
expect "output in a loop of links" "cannot write into" compare "$work/good.toml" --out "$work/loop/out"
expect "output of 5000 letters" "cannot write into.*letters" compare "$work/good.toml" --out "$work/$long"
edited "body of 5000 letters" "case.toml:2:7: .*50[0-9]+ letters" "s/block.geo/$long.geo/"
edited "label of 5000 letters" "case.toml:15.*cannot name a file" "s/\"hybmss\"\]/{ model = \"hybmss\", label = \"$long\" }]/"
cp "$work/good.toml" "$work/${long:0:200}.toml"
expect "case of 200 letters" "name too long" compare "$work/${long:0:200}.toml" --out "$work/out"
latin=$(printf 'K\xf6rper')
mkdir "$work/$latin"
sed 's/^cells/cell/' "$work/good.toml" >"$work/$latin/case.toml"
expect "mistake in a Latin-1 folder" "case.toml:4:1: " compare "$work/$latin/case.toml" --out "$work/out"

# More than a parser, a machine or a person can hold.
{ printf 'a.%.0s' $(seq 50000); echo 'a = 1'; echo "$good"; } >"$work/case.toml"
expect "50,000 dotted keys" "case.toml:1:1: more than 16 parts of a key" compare "$work/case.toml" --out "$work/out"
expect "fewer jobs than none" "jobs: is -1 .allowed: 0 to 1024" compare "$work/good.toml" --jobs -1 --out "$work/out"
"$program" material -E 1 --nu 0.3 --cell-size -1 2>&1 | grep -qxF -e "--cell-size: is -1 (allowed: a finite number > 0)" ||
  fail "cells of no size"
expect "100,000 jobs" "jobs.*1024" compare "$work/good.toml" --jobs 100000 --out "$work/out"
mkdir "$work/thing.stl"
expect "export of a folder" "thing.stl is a folder" export "$work/thing.stl" --to springs -E 1 --nu 0.3
expect "export of a thousand million cells" "1e\+09 cells .allowed: up to" export "$work/good.toml" --to calculix --cells 1000 1000 1000 --out "$work/out"
edited "a lattice of a thousand million cells" "case.toml:2:7: cells: .*1e\+09 cells .allowed" 's/\[2, 2, 2\]/[1000, 1000, 1000]/'
edited "a reference of a thousand million cells" "case.toml:17:9: reference.cells: .*GB" '$s/$/\n[reference]\ncells = [1000, 1000, 1000]/'
edited "a reference that cannot be refined" "case.toml:17:9: reference.cells: is 1 along x, which cannot be refined" '$s/$/\n[reference]\ncells = [1, 1, 1]/'
edited "E = 1e300" "case.toml:6:21: .*is 1e\+300 .allowed" 's/1e4/1e300/'
edited "a force of 1e300" "load.displacement_m: is 1e\+300" 's/0\.01/1e300/'
edited "contradictory loads" "case.toml:14:1: load: the displacement of 'z_min' along x is prescribed by the load in line 8 too" '$s/$/\n/; s/^\[compare\]/[[load]]\non = "z_min"\ndisplacement_m = [1, 0, 0]\n[compare]/'
jaw='s/^\[compare\]/[[patch]]\nname = "jaw"\nbox_m = [[0, 0, 0.9], [0.5, 0.5, 1.1]]\nfacing = { direction = [0, 0, 1], within_deg = 5 }\n[[load]]\non = "jaw"\nHOW\n[compare]/'
edited "a force on a part of a held face" "case.toml:18:1: load: the force on 'jaw' acts where the load in line 11 holds 'z_max'" "${jaw/HOW/force_N = [0, 0, 1]}"
edited "a part of a held face that moves otherwise" "case.toml:18:1: load: 'jaw' has the displacement z = 0.02 m at .*, where 'z_max' of the load in line 11 has 0.01 m" "${jaw/HOW/displacement_m = [0, 0, 0.02]}"

# A drying body.
drying='s/^displacement_m = \[0, 0, 0.01\]$/displacement_m = [0, 0, 0]/; s/"hybmss"/"msm_18"/; $s/$/\n[fracture]\nshrinkage = 0.1\nthreshold = 0.05\nscatter = 0.1\nsteps = 50/'
edited "threshold = 0" "case.toml:18:13: fracture.threshold: is 0 .allowed: a number > 0, up to 1" "${drying/0.05/0}"
edited "scatter < 0" "case.toml:19:11: fracture.scatter: is -0.1 .allowed: a number from 0 to 0.5" "${drying/scatter = 0.1/scatter = -0.1}"
edited "no steps" "case.toml:20:9: fracture.steps: is 0 .allowed: a whole number from 1" "${drying/steps = 50/steps = 0}"
edited "drying in steps beyond the threshold" "case.toml:17:13: fracture.shrinkage: is 0.1 in each of 1 steps, beyond the threshold .allowed: shrinkage / steps up to the threshold, 0.05" "${drying/steps = 50/steps = 1}"
edited "a drying body that is pulled" "case.toml:8:1: load: cannot act on a body that dries .allowed beside .fracture.: displacement_m = .0, 0, 0." "s/\[0, 0, 0\]/[0, 0, 1]/; $drying"
edited "a drying body of a model that cannot break" "case.toml:15:11: compare.models: hybmss has forces that no breaking spring takes away.*allowed beside .fracture.: msm_18" "${drying/s?\"hybmss\"?\"msm_18\"?; /}"

# Scripts, where they are not wanted, and files that are scripts under another name.
echo "SystemCall \"touch $work/trace\";" >"$work/own.geo"
sed 's/block.geo/own.geo/' "$work/good.toml" >"$work/script.toml"
expect "a script of one's own" "script.toml:2:7: body.geo: 'own.geo' is a script, which may run any command" compare --no-scripts "$work/script.toml" --out "$work/out"
expect "a script of one's own, exported" "is a script" export --no-scripts "$work/script.toml" --to calculix --out "$work/out"
for name in own.msh own.step own.brep own.stl; do
  cp "$work/own.geo" "$work/$name"
  sed -e "s/block.geo/$name/" -e 's/^size_m.*/voxels = 100/' -e '/^cells/d' "$work/good.toml" >"$work/script.toml"
  expect "a script called $name" "$name: " compare "$work/script.toml" --out "$work/out"
done
[ -e "$work/trace" ] && fail "a command was run"

# Cells of one's own that share an edge and nothing else.
cat >"$work/hinge.geo" <<'GEO'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 1, 0, 1, 1, 1};
Coherence;
Transfinite Curve "*" = 3;
Transfinite Surface "*";
Recombine Surface "*";
Transfinite Volume "*";
Physical Surface("z_min") = {5};
GEO
sed -e 's/block.geo/hinge.geo/' -e 's/z_max/z_min/' -e 's/0.01/0/' "$work/good.toml" >"$work/hinge.toml"
expect "a hinge of cells" "hinge.geo: the mesh has 2 parts that meet in edges or points only, as at \(1, 1, [0-9.]+\)" compare "$work/hinge.toml" --out "$work/out"

moving=$(printf 'kinematics = "hencky"\n%s\n[dynamics]' "$good")
printf '%s\nduration_s = 0\n' "$moving" >"$work/no_time.toml"
expect "no duration" "no_time.toml:[0-9]+:14: dynamics.duration_s: is 0 .allowed: a finite number > 0" compare "$work/no_time.toml" --out "$work/out"
printf '%s\nduration_s = 1\ndamping_ratio = 0.05\n' "$moving" >"$work/ratio.toml"
expect "a damping ratio" "ratio.toml:[0-9]+:1: dynamics.damping_ratio: unknown key .*; loss_factor with band_Hz is twice the damping ratio" compare "$work/ratio.toml" --out "$work/out"
printf '%s\nduration_s = 2\ntime_step_s = 1\n' "$moving" >"$work/long_step.toml"
expect "an unsafe step" "long_step.toml:[0-9]+:15: dynamics.time_step_s: 1 s is not safe .* up to 0.[0-9]+ s" compare "$work/long_step.toml" --out "$work/out"

expect "differences of no results" "/nowhere: no results.json here" diff /nowhere "$work"
echo '{"cases": 1}' >"$work/results.json"
expect "differences of other files" "results.json: not the results" diff "$work" "$work"

echo '{"program": {"version": "0.1.0"}, "generated": "now", "cases": []}' >"$work/results.json"
expect "differences of no numbers" "^error: .*: holds no number" diff "$work" "$work"

# Measured values, histories, masses and branches.
printf 'time_s,value_m,u_m\n0.5,-0.0061,1e-5\n1,-0.0062,1e-5\n' >"$work/creep.csv"
measured='kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [0.1, 0.03, 0.03]
cells = [[4, 1, 1], [8, 2, 2]]
[material]
youngs_modulus_Pa = 2e5
poisson_ratio = 0.3
density_kg_m3 = 1000
[material.relaxation]
branches = [{ share = 0.1, time_s = 0.3 }, { share = 0.05, time_s = 3 }]
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[mass]]
name = "weight"
at_m = [0.1, 0.015, 0.015]
mass_kg = 0.05
[compare]
models = ["hybmss_avg"]
measures = ["mean_displacement"]
[reference]
elements = []
[[measured]]
source = "here"
licence = "none"
values = [{ name = "sag", quantity = "mean_displacement.x_max.z", value = -0.01, u = 1e-4 }]
histories = [{ name = "creep", quantity = "mean_displacement.x_max.z", file = "creep.csv" }]'
# measured_as NAME PATTERN SED-EXPRESSION [CSV]: that case, spoilt; or its history, by the lines beside the columns
measured_as() {
  sed -E "$3" <<<"$measured" >"$work/bar.toml"
  printf "${4:-time_s,value_m,u_m\\n0.5,-0.0061,1e-5\\n}" >"$work/creep.csv"
  expect "$1" "$2" compare "$work/bar.toml" --out "$work/out"
}
measured_as "a value without u" 'bar.toml:29:11: measured.values.u: is missing .allowed: a finite number > 0' 's/, u = 1e-4//'
measured_as "u = 0" 'bar.toml:29:[0-9]+: measured.values.u: is 0 ' 's/u = 1e-4/u = 0/'
measured_as "a value in another unit" 'bar.toml:29:.*measured.values.value: is -10 m, more than twice the size' 's/-0.01/-10/'
measured_as "a patch of a value that is not there" "bar.toml:29:.*the body has no patch 'x_mx' .*did you mean" 's/x_max.z", value/x_mx.z", value/'
measured_as "no licence" 'bar.toml:26:1: measured.licence: is missing' '/^licence/d'
measured_as "no such history" 'bar.toml:30:.*measured.histories.file: there is no file .*none.csv .allowed: a history' 's/creep.csv/none.csv/'
measured_as "a name twice" "bar.toml:30:.*measured.histories.name: 'sag' is the name of another" 's/"creep"/"sag"/'
measured_as "a gap" 'creep.csv:3:1: a field is empty .allowed: a number in each' '' 'time_s,value_m,u_m\n0.5,-1e-3,1e-5\n1,,1e-5\n'
measured_as "other columns" 'creep.csv:1:1: the columns are time,value,u .allowed: time_s,value_m,u_m' '' 'time,value,u\n1,2,3\n'
measured_as "other units" 'creep.csv:1:1: the columns are time_s,value_cm,u_cm ' '' 'time_s,value_cm,u_cm\n1,2,3\n'
measured_as "times that descend" 'creep.csv:3:1: 0.5 s is not after 1 s ' '' 'time_s,value_m,u_m\n1,-1e-3,1e-5\n0.5,-1e-3,1e-5\n'
measured_as "u = 0 in a history" 'creep.csv:2:1: u is 0 ' '' 'time_s,value_m,u_m\n1,-1e-3,0\n'
measured_as "a mass beside the body" "bar.toml:17:1: mass 'weight': at_m: the point .0.2, .*lies outside the body .allowed: a point of the body" 's/^at_m = .0.1/at_m = [0.2/'
measured_as "a mass below 0" 'bar.toml:20:.*mass.mass_kg: is -1 ' 's/mass_kg = 0.05/mass_kg = -1/'
measured_as "a share below 0" 'bar.toml:11:.*relaxation.branches.share: is -0.1 ' 's/share = 0.1,/share = -0.1,/'
measured_as "two branches of one time" 'bar.toml:11:.*branches.time_s: 3 s is that of another branch ' 's/time_s = 0.3/time_s = 3/'

# What is no fault of the case.
SPRINGPROOF_MESH_CACHE=$work/cache TMPDIR=/nowhere expect "no temporary folder" "^error: TMPDIR: cannot write /nowhere" compare "$work/good.toml" --out "$work/out"

if "$program" bench gpu --quick 2>&1 | grep -q "built without SPRINGPROOF_CUDA"; then
  SPRINGPROOF_DEVICE=gpu expect "a GPU of a build without" "^error: SPRINGPROOF_DEVICE = .gpu. cannot be used here: built without SPRINGPROOF_CUDA" compare "$work/good.toml" --out "$work/out"
fi
SPRINGPROOF_DEVICE=abacus expect "an unknown device" "^error: SPRINGPROOF_DEVICE = .abacus. is unknown .allowed: processor, gpu" compare "$work/good.toml" --out "$work/out"

[ $failures -eq 0 ] && echo "all refused as they should be"
exit $((failures > 0))
