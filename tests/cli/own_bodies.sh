#!/usr/bin/env bash
# Bodies of a user's own through the command line: good files run, broken ones are refused.
#   own_bodies.sh PROGRAM WRITE_BODIES
. "$(dirname "$0")/lib.sh"
program=$1 write_bodies=$2
fem=${SPRINGPROOF_FEM_PROGRAM:-$(dirname "$program")/springproof-fem}
[ -x "$fem" ] || fem=

# case_file FILE SCALE LOW HIGH VOXELS REFERENCE: held below z = LOW, pulled above z = HIGH
case_file() {
  cat <<TOML
[body]
geo = "$1"
$2
voxels = $5
[[patch]]
name = "held"
beyond = { point_m = [0, 0, $3], normal = [0, 0, -1] }
[[patch]]
name = "pulled"
beyond = { point_m = [0, 0, $4], normal = [0, 0, 1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "held"
displacement_m = [0, 0, 0]
[[load]]
on = "pulled"
force_N = [3, 0, 1]
[compare]
models = ["hybmss", "emsm", "emsm_random", "msm_18"]
measures = ["displacement_error", "volume_change", "reaction"]
[reference]
$6
[[expect]]
model = "hybmss"
measure = "force.held.x"
source = "analytic"
value = -3
within = 1e-6
TOML
}


# runs NAME RUNS: the case NAME.toml runs and leaves RUNS runs, all with a result; the supports bear the load
runs() {
  local out="$work/out-$1" start=$SECONDS
  "$program" compare "$work/$1.toml" --jobs 1 --vtu --out "$out" >"$work/stdout" 2>"$work/stderr" || { fail "$1: status $?" "$work/stderr"; return; }
  [ -s "$out/report.html" ] && [ -s "$out/results.json" ] && [ -s "$out/results.csv" ] || fail "$1: no report"
  ls "$out"/vtu/*/*.vtu >/dev/null || fail "$1: no VTU file"
  local ok
  ok=$(grep -c '"ok": true' "$out/results.json")
  [ "$ok" -eq "$2" ] || fail "$1: $ok runs with a result, not $2" "$work/stdout"
  grep -q '"ok": false' "$out/results.json" && fail "$1: a run without a result" "$work/stdout"
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) { if ($i == "measure") m = i; if ($i == "value") v = i }; next }
           $m == "force.held.x" { ++n; if ($v < -3.000001 || $v > -2.999999) bad = 1 }
           $m == "force.held.z" { ++n; if ($v < -1.000001 || $v > -0.999999) bad = 1 }
           END { exit bad || n < 8 }' "$out/results.csv" || fail "$1: the supports do not bear the load" "$out/results.csv"
  echo "$1: $((SECONDS - start)) s"
}

"$write_bodies" "$work" || { fail "write_bodies"; exit 1; }

# Each form of body: springs alone, and beside finite elements.  Runs: 4 models; 3 tetrahedral meshes, 3 grids of cubes.
body() {
  local name=$1 file=$2 scale=$3 low=$4 high=$5 edge=$6
  case_file "$file" "$scale" "$low" "$high" 800 "elements = []
edge_m = $edge" >"$work/$name.toml"
  runs "$name" 4
}
body_with_fem() {
  local name=$1 file=$2 scale=$3 low=$4 high=$5 edge=$6
  [ -n "$fem" ] || return
  case_file "$file" "$scale" "$low" "$high" 800 "edge_m = $edge" >"$work/$name-fem.toml"
  runs "$name-fem" 8
  compgen -G "$work/out-$name-fem/vtu/*/reference_p2_nu0.3.vtu" >/dev/null || fail "$name-fem: no file of the reference on its own mesh"
}

body trefoil trefoil.stl "" -0.9 0.9 0.3
body noisy_sphere noisy_sphere.stl "" -0.6 0.6 0.2
[ -n "$fem" ] || body scan scan.stl "" -0.9 0.9 0.4
body_with_fem scan scan.stl "" -0.9 0.9 0.5
if [ -n "$fem" ]; then
  "$fem" "$work/scan-fem.toml" >"$work/stdout" 2>"$work/stderr"
  [ $? -eq 2 ] && grep -qF body.voxels "$work/stderr" || fail "springproof-fem on its own, of a body of voxels" "$work/stderr"
fi

# The same body as gmsh saves it, in every form.
cat >"$work/make.geo" <<GEO
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 2};
Cylinder(2) = {0.5, 0.5, 2, 0, 0, 1, 0.4};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.25;
Mesh 3;
Mesh.MshFileVersion = 2.2; Save "$work/form_2.msh";
Mesh.MshFileVersion = 4.1; Save "$work/form_4.msh";
Save "$work/form.step";
Save "$work/form.brep";
GEO
sed 's/^geo.*/&\nsize_m = [1, 1, 1]/' <(case_file make.geo "" 0.3 2.7 800 "elements = []") >"$work/make.toml"
"$program" compare "$work/make.toml" --out "$work/out" >/dev/null 2>&1  # for the files that it saves
for form in form_2.msh form_4.msh form.step form.brep; do
  [ -s "$work/$form" ] || fail "gmsh saved no $form"
  scale=
  [ $form = form.step ] && scale="scale = 1000"  # gmsh's STEP is in millimetres
  body ${form/./_} $form "$scale" 0.3 2.7 0.3
done
body_with_fem form_step form.step "scale = 1000" 0.3 2.7 0.4

# Another size than was meant is said, with the size: a STEP file states its unit, and scale converts it once more.
of_size() {  # NAME WORDS
  "$program" compare "$work/$1.toml" --jobs 1 --quiet --out "$work/out" >"$work/stdout" 2>"$work/stderr"
  grep -qF "$2" "$work/stderr" || fail "$1: not '$2'" "$work/stderr"
}
case_file form.step "scale = 0.001" 3e-7 27e-7 800 "elements = []
edge_m = 3e-7" >"$work/twice.toml"
of_size twice "the body spans 3e-06 m: a STEP file states its unit, and scale = 0.001 multiplies that; is scale one too many?"
grep -qF '"the body is 1e-06 x 1e-06 x 3e-06 m' "$work/out/results.json" || fail "the size of the body is not in the notes"
case_file trefoil.stl "scale = 1e-4" -9e-5 9e-5 800 "elements = []
edge_m = 3e-5" >"$work/small.toml"
of_size small "m; is it so small?"
case_file noisy_sphere.stl "scale = 0.001" -6e-4 6e-4 100 "edge_m = 0.0015" >"$work/round.toml"
[ -z "$fem" ] || of_size round "remeshing with edges of 0.0015 m changes the volume by"  # not in the file's millimetres

# A case by `new`: of an upright body its ends; of one that lies askew no corners of its box, but ends across its own length.
cat >"$work/askew.geo" <<GEO
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 3};
Rotate {{1, 2, 0}, {0, 0, 0}, 0.7} { Volume{1}; }
Save "$work/askew.step";
GEO
"$program" new "$work/askew.geo" --size 1 1 1 >/dev/null 2>&1
"$program" new "$work/form.step" --scale 1000 | grep -q '^side = "top"' || fail "new: no sides of an upright body"
"$program" new "$work/askew.step" --scale 1000 >"$work/askew.toml"
awk '/^name = "high"/ { getline; gsub(/.*normal = |[][{},]/, ""); print }' "$work/askew.toml" |
  awk '{ ok = 0.5762 * $1 - 0.2881 * $2 + 0.7648 * $3 > 0.99 } END { exit !ok }' || fail "new: ends of a body that lies askew" "$work/askew.toml"

# Half of a script's cells are in no physical volume: they are left out, which is said.
cat >"$work/half.geo" <<'GEO'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1, 1, 1, 1};
Coherence;
Transfinite Curve "*" = 3;
Transfinite Surface "*";
Recombine Surface "*";
Transfinite Volume "*";
Physical Surface("z_min") = {5};
Physical Volume("lower") = {1};
GEO
{ printf '[body]\ngeo = "half.geo"\nsize_m = [1, 1, 1]\ncells = [2, 2, 2]\n'; block_case 0.3 | sed '1,4d; s/z_max/z_min/; s/0\.01/0/'; } >"$work/half.toml"
printf '[compare]\nmodels = ["hybmss"]\n[reference]\nelements = []\n' >>"$work/half.toml"
"$program" compare "$work/half.toml" --jobs 1 --quiet --out "$work/out" >"$work/stdout" 2>"$work/stderr"
grep -qF "8 of the file's 16 cells are in no physical volume" "$work/out/results.json" || fail "cells that are left out unsaid" "$work/stderr"

# Broken files: mended with a note in the report, or refused in one line that names the file.
while IFS=$'\t' read -r name fate said; do
  case_file "broken/$name.stl" "" -0.5 0.5 200 "elements = []
edge_m = 0.4" >"$work/$name.toml"
  [ "$name" = without_area ] && sed -i 's/-0\.5\]/0.2]/; s/, 0\.5\]/, 0.8]/' "$work/$name.toml"  # a cube from 0 to 1
  rm -rf "$work/out"
  start=$SECONDS
  "$program" compare "$work/$name.toml" --jobs 1 --out "$work/out" >"$work/stdout" 2>"$work/stderr"
  status=$?
  [ $((SECONDS - start)) -le 10 ] || fail "$name took $((SECONDS - start)) s"
  if [ "$fate" = refused ]; then
    [ $status -eq 2 ] && [ "$(wc -l <"$work/stderr")" -eq 1 ] && grep -qF "$name.stl" "$work/stderr" && grep -qF -- "$said" "$work/stderr" && [ ! -e "$work/out" ] ||
      fail "$name: status $status" "$work/stderr"
  else
    [ $status -eq 0 ] && grep -qF -- "$said" "$work/out/results.json" || fail "$name: status $status, not '$said'" "$work/stderr"
  fi
done <"$work/broken.txt"

[ -n "$fem" ] || echo "without finite elements: no springproof-fem"
[ $failures -eq 0 ] && echo "every body ran or was refused as it should be"
exit $((failures > 0))
