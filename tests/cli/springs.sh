#!/usr/bin/env bash
# Springs files: written in every form, by the schema, with our forces in another program; read back as a model of a case.
#   springs.sh PROGRAM SOURCE-FOLDER
# Without numpy, jsonschema or lmp what needs them is left out, and said.
. "$(dirname "$0")/lib.sh"
program=$1 source=$2
cd "$work" || exit 1
python_with() { for p in python3 /usr/bin/python3; do "$p" -W ignore -c "import $1" 2>/dev/null && { echo "$p"; return; }; done; }
numpy=$(python_with numpy) jsonschema=$(python_with jsonschema) lmp=${SPRINGPROOF_LAMMPS:-$(command -v lmp)}

cat >case.toml <<'END'
[body]
geo = "block.geo"
size_m = [0.2, 0.1, 0.1]
cells = [[4, 2, 2], [8, 4, 4]]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.25, 0.4]
density_kg_m3 = 1100
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
force_N = [0, 0, -0.1]
[compare]
models = ["hybmss", { model = "hybmss", face_to_cube = 1, label = "A1" }]
END
export_to() { "$program" export "$@" >log 2>&1 || fail "export $*: status $?: $(cat log)"; }

# Every model of the table, in every form.
cp "$source/examples/springs.py" .
for model in $("$program" list | awk '/^Models/ { inside = 1; next } /^$/ { inside = 0 } inside { print $1 }'); do
  cells="4 2 2"
  [[ $model != *hexagonal && $model != kirkwood ]] || cells="4 2 1"
  [[ $model != *patch ]] || cells="8 4 4"  # fewer nodes cannot hold every strain
  forms="json npz"
  [[ $model == emsm || $model == hybmss_bt || $model == kirkwood ]] || forms=json  # the forms differ in how arrays are written
  for form in $forms; do
    # shellcheck disable=SC2086
    export_to case.toml --to springs --model "$model" --nu 0.4 --cells $cells --out "$model.$form"  # every constant differs from 0
    made=$("$program" list | awk -v m="$model" '$1 == m { print substr($0, 19, 26) }' | sed 's/ *$//')
    [ -n "$made" ] && grep -qF "nodes, $made (" log || fail "$model is '$made' in the list, and exported: $(cat log)"
    if [ -n "$numpy" ]; then
      off=$("$numpy" springs.py "$model.$form" | awk '{ print $3 }')
      awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-9) }' || fail "forces of $model.$form by examples/springs.py: off by '$off'"
    fi
  done
done
for options in '' ', weights = "kL"'; do  # momentum dispersion of finite strain
  sed "s/^models.*/models = [{ model = \"emsm\", dispersion = \"finite_strain\"$options }]/" case.toml >finite.toml
  export_to finite.toml --to springs --nu 0.4 --cells 4 2 2 --out finite.json
  if [ -n "$numpy" ]; then
    off=$("$numpy" springs.py finite.json | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-9) }' || fail "forces of finite strain$options by examples/springs.py: off by '$off'"
  fi
done
# A body that is no block: cut cells, of the models that take them; whole cubes on demand.
cp "$source/comparisons/experiments/calibration/icosahedron.stl" .
body=(icosahedron.stl -E 5e3 --nu 0.45 --density 900 --scale 0.01 --voxels 100 --to springs)
export_to "${body[@]}" --out cut.json
grep -q '"model": "hybmss_avg"' cut.json || fail "a body alone gets another model than the recommended one"
grep -q '"version": 7' cut.json && grep -q '"fraction": ' cut.json && grep -q '"anchors": ' cut.json || fail "a body has no cut cells"
grep -qE 'nodes, a term per cell \(no springs, [0-9]+ cut cells\)' log && ! grep -q '^note:' log || fail "what cut cells are: $(cat log)"
export_to "${body[@]}" --out cut.npz
# The vertices of another file, in its order, inside of the body too: a mesh of 10^5 vertices follows the springs by the file alone.
if [ -n "$numpy" ]; then
  "$numpy" - <<'END'
import numpy as np
points = np.random.default_rng(1).normal(size=(100000, 3))
points *= np.linspace(0.1, 0.75, len(points))[:, None] / np.linalg.norm(points, axis=1)[:, None]
with open("many.obj", "w") as out:
    for p in points: out.write("v %.9g %.9g %.9g\n" % tuple(p))
    for i in range(1, len(points), 3): out.write(f"f {i} {i + 1} {i + 2}\n")
END
  export_to "${body[@]}" --carry many.obj --out many.npz
  "$numpy" - <<'END' || fail "the vertices of a file are not carried"
import numpy as np
from springs import load, embed
s, points = load("many.npz"), 0.01 * np.loadtxt((line[2:] for line in open("many.obj") if line[0] == "v"))
surface, X = s["surface"], s["nodes"]["position_m"]
assert surface["facets"].shape == (33333, 3) and abs(surface["position_m"] - points).max() < 1e-12
entries = np.repeat(np.arange(len(points)), np.diff(surface["first"]))
x = X @ np.array([[1.1, 0.2, 0], [0, 0.9, 0.1], [0.3, 0, 1]])  # every affine motion is exact
moved = np.zeros(points.shape)
np.add.at(moved, entries, surface["weights"][:, None] * x[surface["nodes"]])
nodes, weights = embed(s, points)
for there in moved, np.einsum("pn,pni->pi", weights, x[nodes]):
    assert abs(there - points @ np.array([[1.1, 0.2, 0], [0, 0.9, 0.1], [0.3, 0, 1]])).max() < 1e-9
END
  awk '$1 == "v" { $2 += 100 } 1' many.obj >far.obj
  "$program" export "${body[@]}" --carry far.obj --out far.json >log 2>&1 && fail "vertices far from the body are carried"
  grep -q -- "--carry: far.obj lies from" log || fail "vertices far from the body: $(cat log)"
fi
export_to "${body[@]}" --model hybmss_bt --out cut_bt.json
grep -qE '^note: hybmss_bt is springs \+ a term per cell on whole cubes; cut cells hold its springs averaged' log && grep -q '"cut": true' cut_bt.json ||
  fail "averaged cells under the name of springs: $(cat log)"
export_to "${body[@]}" --model hybmss_bt --whole-cubes --out whole.json
grep -qE 'nodes, springs \+ a term per cell \([0-9]+ springs, [0-9]+ cells\)' log && ! grep -q '^note:' log || fail "what whole cubes are: $(cat log)"
grep -q '"version": 1' whole.json && ! grep -q '"fraction": ' whole.json || fail "--whole-cubes gives cut cells"
export_to "${body[@]}" --out cut.vtu
grep -q 'Name="fraction"' cut.vtu || fail "cut.vtu"
grep -q '"density_kg_m3": 900.0' cut.json || fail "the density is another"
if [ -n "$numpy" ]; then
  for file in cut.json cut.npz cut_bt.json whole.json; do
    off=$("$numpy" springs.py $file | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-12) }' || fail "forces of $file by examples/springs.py: off by '$off'"
  done
fi
# Patches of a body alone, by side or rule: of cut cells anchors, of a block nodes.
export_to "${body[@]}" --hold bottom --load 'near = { point_m = [0, 0, 0.01], radius_m = 0.003 }' --out held.json
grep -q '"bottom": ' held.json && grep -q '"loaded": ' held.json || fail "no patches of --hold and --load"
export_to block.geo --size 0.2 0.1 0.1 --cells 4 2 2 -E 1e4 --nu 0.3 --hold left --to springs --out held_block.json
grep -q '"left": ' held_block.json || fail "no patch of --hold on a block"
for wrong in below 'beyond = { point_m = [0, 0, 9], normal = [0, 0, -1] }' 'beyond = { point_m = [0, 0, 9], normal = [0, 0, 1] }' 'near = {'; do
  "$program" export "${body[@]}" --hold "$wrong" --out refused.json >log 2>&1
  [ $? -eq 2 ] && grep -q -- "--hold" log && [ ! -e refused.json ] || fail "--hold $wrong: $(cat log)"
done
# Cells of several sizes, refined for the loads of a case.
{ sed -e 's/^geo = .*/geo = "icosahedron.stl"\nscale = 0.01/; s/^size_m = .*/voxels = 30\naccuracy = 0.05/; /^cells = /d; s/x_min/low/; s/x_max/high/' \
      -e 's/^models = .*/models = ["hybmss_avg"]/; s/0\.25, 0\.4/0.4/' case.toml
  printf '[[patch]]\nname = "low"\nbeyond = { point_m = [0, 0, -0.005], normal = [0, 0, -1] }\n[[patch]]\nname = "high"\nbeyond = { point_m = [0, 0, 0.005], normal = [0, 0, 1] }\n'; } >refined.toml
for form in json npz vtu; do export_to refined.toml --to springs --out "refined.$form"; done
grep -q '"version": 7' refined.json && grep -q '"carried": ' refined.json || fail "no cells of several sizes"
if [ -n "$numpy" ]; then
  for form in json npz; do
    off=$("$numpy" springs.py "refined.$form" | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-12) }' || fail "forces of refined.$form by examples/springs.py: off by '$off'"
  done
fi
# Boxes, of the model that has them.
for form in json npz; do
  export_to case.toml --to springs --model hybmss_avg --nu 0.4 --cells 4 3 1 --out "boxes.$form"
  if [ -n "$numpy" ]; then
    off=$("$numpy" springs.py "boxes.$form" | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-12) }' || fail "forces of boxes.$form by examples/springs.py: off by '$off'"
  fi
done
grep -q '"version": 4' boxes.json && grep -q '"proportions": ' boxes.json || fail "no boxes"
"$program" export case.toml --to springs --model hybmss --nu 0.4 --cells 4 3 1 --out refused.json >log 2>&1
[ $? -eq 2 ] && grep -q "hybmss: needs cubes.*a model of boxes: hybmss_avg" log || fail "boxes of hybmss: $(cat log)"
# A material that relaxes, in cells of every kind: branches and the check of their forces.
branches='[material.relaxation]\nbranches = [{ share = 0.25, time_s = 0.02 }, { share = 0.15, time_s = 0.3 }]'
sed "s/^density_kg_m3.*/&\n$branches/" refined.toml >relaxing_refined.toml
sed -e 's/0\.25, 0\.4/0.4/' -e "s/^density_kg_m3.*/&\n$branches/" -e 's/^models = .*/models = ["hybmss_avg"]/' case.toml >relaxing.toml
for form in json npz; do
  export_to relaxing_refined.toml --to springs --out "relaxing_refined.$form"
  export_to relaxing.toml --to springs --out "relaxing.$form"
  export_to relaxing.toml --to springs --cells 4 3 1 --out "relaxing_boxes.$form"
  export_to relaxing.toml --to springs --model hybmss --out "relaxing_springs.$form"
  for file in relaxing_refined relaxing relaxing_boxes relaxing_springs; do
    [ -n "$numpy" ] || break
    off=$("$numpy" springs.py "$file.$form" | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-11) }' || fail "forces of $file.$form by examples/springs.py: off by '$off'"
  done
done
grep -q '"version": 6' relaxing.json && grep -q '"branch_force_N": ' relaxing.json || fail "no branches"
for form in lammps jolt; do
  "$program" export relaxing.toml --to $form --out "refused.$form" >log 2>&1
  [ $? -eq 2 ] && grep -qE "relaxing.toml:.*material.relaxation: has no place in this file, --to $form|--out: is refused" log && [ ! -e "refused.$form" ] || fail "--to $form: $(cat log)"
done
# It moves as the model by name, in a case of the same branches alone.
{ sed '1s/^/kinematics = "hencky"\n/; s/^cells = .*/cells = [4, 2, 2]/; s/^models = .*/models = ["hybmss_avg", { file = "relaxing.json", label = "mine" }]/' relaxing.toml
  printf '[reference]\nelements = []\n[[probe]]\nname = "tip"\nat_m = [0.2, 0.05, 0.05]\n[dynamics]\nduration_s = 0.3\nequilibrium = false\nsamples = 30\n'; } >moving.toml
"$program" compare moving.toml --out moving --quiet >log 2>&1
python3 - <<'END' || fail "a file with branches moves otherwise than the model: $(cat log)"
import json
ours, mine = json.load(open("moving/results.json"))["cases"][0]["histories"]
ours, mine = (h["values"][h["names"].index("displacement.tip.z")] for h in (ours, mine))
assert len(ours) > 20 and max(abs(a - b) for a, b in zip(ours, mine)) < 1e-9 * max(map(abs, ours))
END
# refused_as PATTERN SED-SCRIPT: the case, changed
refused_as() {
  sed "$2" moving.toml >refused.toml
  "$program" compare refused.toml --out refused >log 2>&1
  [ $? -eq 2 ] && [ "$(wc -l <log)" -eq 1 ] && grep -qE -- "$1" log || fail "$2: $(head -c 600 log)"
}
refused_as 'refused.toml:.*mine.*: /relaxation: is not that of the case' 's/share = 0.15/share = 0.16/'
refused_as 'mine.*: /relaxation: the springs of the file relax' '/relaxation/d; /branches/d'
refused_as 'mine.*: the springs of the file do not relax' 's/relaxing.json/hybmss_avg.json/'
models=$(ls -- *.json | wc -l)
[ "$models" -ge 15 ] || fail "only $models models"
[ -n "$numpy" ] || echo "without numpy: forces in Python are not checked"
if [ -n "$jsonschema" ]; then
  "$jsonschema" -W ignore - "$source/docs/springs.schema.json" ./*.json <<'END' || fail "a file is not what the schema says"
import json, sys, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
for name in sys.argv[2:]:
    jsonschema.validate(json.load(open(name)), schema)
text = open("hybmss.json").read()
for spoil in ('d["nodes"]["mass_kg"][0] = 0',  # version 1: no node follows others
              'd["nodes"]["position_m"][0][0] = 2e9', 'd["springs"]["nodes"][0] = [1, 1]', 'd["springs"]["stiffness_N_m"][0] = 1e31',
              'd["cells"]["edge_m"] = 0', 'd["cells"]["proportions"] = [2, 1, 0.5]', 'd["laws"]["angular_springs"] = {"beta_Nm": 1}',
              'd["laws"]["averaged_springs"] = {}', 'd["relaxation"] = {"share": [1], "time_s": [1]}', 'd["bonds"] = {}', 'del d["cells"]'):
    d = json.loads(text)
    exec(spoil)
    try:
        jsonschema.validate(d, schema)
        sys.exit(f"the schema accepts {spoil}")
    except jsonschema.ValidationError:
        pass
END
else
  echo "without jsonschema: the schema is not checked"
fi
export_to case.toml --to springs --model msm_18 --out lines.vtu
grep -q 'Name="stiffness_N_m"' lines.vtu && grep -q 'NumberOfPoints="45"' lines.vtu || fail "lines.vtu"

# Of a case the model by its label, a Poisson's ratio and a resolution; of a body alone its material.
export_to case.toml --to springs --model A1 --nu 0.4 --cells 8 4 4 --out a1.json
grep -q '"face_to_cube": 1.0' a1.json || fail "the model by its label has not its options"
grep -q '"poisson_ratio": 0.4' a1.json || fail "the Poisson's ratio is another"

# As a model of a case: the same rows as the built-in model that it was exported from.
cat >template.toml <<'END'
[body]
geo = "block.geo"
size_m = [0.2, 0.1, 0.1]
cells = [4, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.4
density_kg_m3 = 1100
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
force_N = [0, 0, -0.1]
[compare]
models = ["MODEL", { file = "MODEL.json", label = "mine" }]
measures = ["displacement_error", "volume_change", "reaction", "network"]
[reference]
elements = []
END
# same_rows TEMPLATE MODEL: exported from the template's case and run beside the built-in model
same_rows() {
  sed "s/MODEL/$2/g" "$1" >own.toml
  export_to own.toml --model "$2" --to springs --out "$2.json"
  "$program" compare own.toml --out own --quiet >log 2>&1
  rows=$(awk -F, -v model="$2" '
    $6 == "promised_error" { next }  # of the built-in model alone
    $3 == model { built_in[$6] = $7 } $3 == "mine" { own[$6] = $7 }
    END { for (m in built_in) { ++n; d = own[m] - built_in[m]; if (!(m in own) || d > 1e-10 || d < -1e-10) print m, built_in[m], own[m] } print n }' own/results.csv)
  [ "$(wc -l <<<"$rows")" -eq 1 ] && [ "$rows" -ge 8 ] || fail "$1: $2 from its file has other rows: $rows"
}
for model in hybmss hybmss_bt emsm emsm_random msm_centred; do same_rows template.toml $model; done
sed -e 's/^geo = .*/geo = "icosahedron.stl"/; s/^size_m = .*/voxels = 300\ncut = false/; /^cells = /d; s/x_min/low/; s/x_max/high/' \
  -e 's/^\[material\]/[[patch]]\nname = "low"\nbeyond = { point_m = [0, 0, -0.5], normal = [0, 0, -1] }\n[[patch]]\nname = "high"\nbeyond = { point_m = [0, 0, 0.5], normal = [0, 0, 1] }\n&/' template.toml >voxels.toml
for model in hybmss_bt emsm_random emsm_centred; do same_rows voxels.toml $model; done
sed '/^cut = false/d' voxels.toml >cut.toml
same_rows cut.toml hybmss_avg
grep -q '"version": 7' hybmss_avg.json || fail "a case of a body has no cut cells"
sed 's/^voxels = .*/voxels = 30\naccuracy = 0.05/' cut.toml >several.toml
same_rows several.toml hybmss_avg
grep -q '"version": 7' hybmss_avg.json || fail "a refined body has no cells of several sizes"
cp hybmss_avg.json several.json
# Measured cells, on the supports of the case: 171 numbers of each.
sed -e 's/^geo = .*/geo = "l_bracket.geo"/; s/^size_m = .*/size_m = [0.1, 0.05, 0.1]\nvoxel_edge_m = 0.01\ncoarsened = true/; /^cells = /d; s/x_min/wall/; s/x_max/end/' template.toml >measured.toml
same_rows measured.toml hybmss_avg
grep -q '"form_N_m": ' hybmss_avg.json && ! grep -q '"averaged_springs": ' hybmss_avg.json || fail "measured cells are not in their file"
cp hybmss_avg.json measured.json
export_to own.toml --model hybmss_avg --to springs --out measured.npz
if [ -n "$numpy" ]; then
  for form in json npz; do
    off=$("$numpy" springs.py measured.$form | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-12) }' || fail "forces of measured.$form by examples/springs.py: off by '$off'"
  done
fi
export_to own.toml --model hybmss_avg --whole-cubes --to springs --out whole_bracket.json

# Statics by the file alone, in another program: the body hangs from its anchors as compare says.
if [ -n "$numpy" ]; then
  sed -e 's/MODEL/hybmss_avg/; s/, { file = [^}]*}//; s/^on = "high"/gravity_m_s2 = [1, 2, -9.81]/; /^force_N/d; s/^measures = .*/measures = ["probe"]/; s/^voxels = .*/voxels = 100/' cut.toml >hang.toml
  printf '[[probe]]\nname = "%s"\nat_m = %s\n' a '[0.31, 0.2, 0.4]' b '[-0.2, 0.1, 0.05]' >>hang.toml
  export_to hang.toml --to springs --out hang.json
  "$program" compare hang.toml --out hang --quiet >log 2>&1  # there is nothing to compare with
  "$numpy" - <<'END' || fail "the equilibrium by the file is another than compare's"
import csv, sys
import numpy as np
sys.argv = ["", "hang.json"]
from springs import load, averaged, anchor, step, support_mass, time_step
s = load("hang.json")
X, cells, a = s["nodes"]["position_m"], s["cells"]["nodes"], s["anchors"]["low"]
n, h = X.size, 1e-5 * s["cells"]["edge_m"]
unknowns = lambda nodes: (3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), -1)
apart = dict(s["cells"], nodes=np.arange(cells.size).reshape(cells.shape))  # cells without common nodes, all moved at once
K = np.zeros((n, n))
for d in range(24):
    f = {}
    for sign in (1, -1):
        x = X[cells]
        x[:, d // 3, d % 3] += sign * h
        f[sign] = np.zeros((cells.size, 3))
        averaged(s["laws"]["averaged_springs"], apart, x.reshape(-1, 3), f[sign])
    np.add.at(K, (unknowns(cells), unknowns(cells)[:, d, None]), -(f[1] - f[-1]).reshape(-1, 24) / (2 * h))
for nodes, w, k in zip(a["nodes"], a["weights"], a["stiffness_N_m"]):
    at = (3 * nodes[:, None] + np.arange(3)).ravel()
    K[np.ix_(at, at)] += np.kron(np.outer(w, w), k.reshape(3, 3))
u = np.linalg.solve(K, (s["nodes"]["weight_kg"][:, None] * (1, 2, -9.81)).ravel()).reshape(-1, 3)
rows = {row["measure"]: float(row["value"]) for row in csv.DictReader(open("hang/results.csv"))}
checked = 0
for name, at in ("a", (0.31, 0.2, 0.4)), ("b", (-0.2, 0.1, 0.05)):
    xi = (np.array(at) - X[cells[:, 0]]) / s["cells"]["edge_m"]
    c = np.flatnonzero(((xi >= 0) & (xi <= 1)).all(axis=1))[0]
    corner = np.array([[0,0,0], [1,0,0], [1,1,0], [0,1,0], [0,0,1], [1,0,1], [1,1,1], [0,1,1]])
    ours = np.where(corner, xi[c], 1 - xi[c]).prod(axis=1) @ u[cells[c]]
    theirs = np.array([rows[f"displacement.{name}.{axis}"] for axis in "xyz"])
    assert abs(ours - theirs).max() < 1e-6 * abs(theirs).max(), (ours, theirs)
    checked += 1
assert checked == 2
# In explicit steps, damped, it comes to rest there.
small = 1e-5 * s["nodes"]["weight_kg"][:, None] * np.array([1, 2, -9.81])
damping = np.sqrt(9.81 / abs(u).max())
x, v, mu = X.copy(), np.zeros(X.shape), support_mass(s, "low")
for _ in range(int(24 / (damping * time_step(s)))):
    step(s, x, v, small + anchor(s, "low", x), mu)
    v /= 1 + damping * time_step(s)
assert abs(x - X - 1e-5 * u).max() < 1e-3 * abs(1e-5 * u).max(), abs(x - X - 1e-5 * u).max() / abs(1e-5 * u).max()
assert abs(anchor(s, "low", x).sum(axis=0) + small.sum(axis=0)).max() < 1e-3 * abs(small.sum())
END
fi

# Several materials: the file's statics by hang_springs.py are compare's.
cat >regions.toml <<'END'
[body]
geo = "icosahedron.stl"
scale = 0.01
voxels = 200
[[patch]]
name = "low"
beyond = { point_m = [0, 0, -0.005], normal = [0, 0, -1] }
[[patch]]
name = "high"
beyond = { point_m = [0, 0, 0.005], normal = [0, 0, 1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.4
density_kg_m3 = 1100
[[region]]
name = "core"
near = { point_m = [0.001, 0, 0.001], radius_m = 0.004 }
youngs_modulus_Pa = 1e6
poisson_ratio = 0.48
density_kg_m3 = 1900
[[region]]
name = "side"
beyond = { point_m = [0.0045, 0, 0], normal = [1, 0, 0] }
youngs_modulus_Pa = 1e3
poisson_ratio = 0.3
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
on = "high"
force_N = [1e-6, 0, -1e-5]
[[probe]]
name = "a"
at_m = [0.001, 0.0001, 0.001]
[compare]
models = ["hybmss_avg"]
measures = ["probe", "reaction"]
[reference]
elements = []
END
for form in json npz; do export_to regions.toml --to springs --out "regions.$form"; done
grep -q '"version": 7' regions.json && grep -q '"bonds": ' regions.json && grep -q '"name":"core"' regions.json || fail "no file of several materials"
sed 's/"hybmss_avg"/"hybmss_avg", { file = "regions.json", label = "mine" }/' regions.toml >both.toml
"$program" compare both.toml --out both --quiet >log 2>&1 || fail "a file of several materials as a model: $(cat log)"
sed '/name = "core"/,/^near/s/radius_m = [0-9.e-]*/radius_m = 0.005/' both.toml >moved.toml
"$program" compare moved.toml --out refused --quiet >log 2>&1 && fail "a file of a larger region is a model"
grep -q "/cells/material: 'core' has .* about .* (allowed: the case's" log || fail "a larger region: $(cat log)"
for measure in displacement.a.z force.low.z; do
  awk -F, -v m="$measure" '$6 == m { v[$3] = $7 } END { d = v["mine"] / v["hybmss_avg"] - 1; exit !(d < 1e-9 && d > -1e-9) }' both/results.csv ||
    fail "$measure of a file of several materials is another"
done
"$program" export regions.toml --to mujoco --out refused.xml >log 2>&1 && fail "an engine takes several materials"
grep -q "region: 'core': export --to mujoco of whole cubes is for bodies of one material" log || fail "an engine: $(cat log)"
sed 's/"hybmss_avg"/"msm_18"/; s/poisson_ratio = 0.48*$/poisson_ratio = 0.25/' regions.toml >quarter.toml
"$program" export quarter.toml --poisson-ratio 0.25 --to jolt --out refused.json >log 2>&1 && fail "springs alone are of any ratio"
grep -q "region: 'side': poisson_ratio: is 0.3, and springs alone" log || fail "a ratio of a region: $(cat log)"
sed -i 's/poisson_ratio = 0.3$/poisson_ratio = 0.25/' quarter.toml
export_to quarter.toml --poisson-ratio 0.25 --to jolt --out quarter.json
if [ -n "$numpy" ]; then
  for form in json npz; do
    off=$("$numpy" springs.py "regions.$form" | awk '{ print $3 }')
    awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-12) }' || fail "forces of regions.$form by examples/springs.py: off by '$off'"
  done
  if "$numpy" -c "import scipy" 2>/dev/null; then
    cp "$source/examples/hang_springs.py" .
    "$program" compare regions.toml --out regions --quiet >log 2>&1
    "$numpy" - <<'END' || fail "several materials: the equilibrium by hang_springs.py is another than compare's"
import csv, sys
import numpy as np
from springs import load, embed
from hang_springs import rest
s = load("regions.json")
share, f = np.zeros(len(s["nodes"]["mass_kg"])), 1e-5 * np.array([0.1, 0, -1])
share[s["loads"]["high"]["nodes"]] = s["loads"]["high"]["area_m2"] / s["loads"]["high"]["area_m2"].sum()
x = [rest(s, "low", sign * np.outer(share, f), say=lambda line: None) for sign in (1, -1)]  # their difference is linear in the load
rows = {row["measure"]: float(row["value"]) for row in csv.DictReader(open("regions/results.csv"))}
theirs = np.array([rows[f"displacement.a.{axis}"] for axis in "xyz"])
nodes, weights = embed(s, np.array([[0.001, 0.0001, 0.001]]))
ours = np.einsum("pn,pni->pi", weights, (x[0] - x[1])[nodes] / 2)[0]
assert abs(ours - theirs).max() < 1e-6 * abs(theirs).max(), (ours, theirs)
mass = s["nodes"]["mass_kg"].sum()
assert abs(s["nodes"]["weight_kg"].sum() - mass) < 1e-9 * mass, mass
END
  fi
fi

# Without a material it runs in any.
sed 's/MODEL/hybmss/g; s/poisson_ratio = 0.4/poisson_ratio = [0.3, 0.4]/' template.toml >own.toml
export_to own.toml --model hybmss --nu 0.4 --to springs --out whole.json
sed '/^ "material": {/,/^ },/d' whole.json >hybmss.json
"$program" compare own.toml --out own --quiet >log 2>&1
[ "$(awk -F, '$3 == "mine" && $6 == "volume_change"' own/results.csv | wc -l)" -eq 2 ] || fail "without a material it runs at $(tail -3 log)"
cp whole.json hybmss.json

# Cells of several sizes, spoilt: what carries a node, and its mass.
sed 's/MODEL/hybmss_avg/g' several.toml >carried.toml
# carried PATTERN PYTHON-STATEMENT on the file d
carried() {
  [ -n "$numpy" ] || return
  "$numpy" -c "import json
d = json.load(open('several.json'))
$2
json.dump(d, open('hybmss_avg.json', 'w'))"
  "$program" compare carried.toml --out refused >log 2>&1
  local status=$?
  [ $status -eq 2 ] && [ "$(wc -l <log)" -eq 1 ] && grep -qE -- "$1" log || fail "$2: status $status: $(head -c 600 log)"
}
carried '/carried/by: node [0-9]+ is not in the mean of its four' "d['carried']['by'][0][0] = d['carried']['by'][-1][0]"
carried '/carried: node [0-9]+ has a mass' "d['nodes']['mass_kg'][d['carried']['nodes'][0]] = 1e-3"
carried '/carried/nodes: node [0-9]+ is carried twice' "d['carried']['nodes'][1] = d['carried']['nodes'][0]"
carried '/nodes/mass_kg: has nodes of 0 kg that nothing carries' "d['carried'] = {'nodes': d['carried']['nodes'][:-1], 'by': d['carried']['by'][:-1]}"
carried '/cells/edge_m: ' "d['version'] = 2"
carried '/patches/low: node [0-9]+ follows others' "d['patches'] = {'low': [d['carried']['nodes'][0]]}"
carried '/cells/nodes: cell [0-9]+ is no cube' "d['cells']['edge_m'] = d['cells']['edge_m'][0]"
carried '/carried: is beside cells of one size' "d = json.load(open('cut.json')); d['carried'] = {'nodes': [0], 'by': [[1, 2, 3, 4]]}"
carried '/cells/edge_m: has [0-9]+ numbers' "d['cells']['edge_m'] = d['cells']['edge_m'][:-1]"

# A changed file is another input: its part is not taken back.
sed 's/MODEL/hybmss/g' template.toml >own.toml
"$program" compare own.toml --out own --quiet >log 2>&1
"$program" compare own.toml --out own --resume 2>&1 | grep -q 'kept from before' || fail "an unchanged part is computed again"
sed -i 's/"version": 1/"version":  1/' hybmss.json
"$program" compare own.toml --out own --resume 2>&1 | grep -q 'kept from before' && fail "a part of another springs file is kept"

# spoilt PATTERN SED-EXPRESSION: the file of hybmss, spoilt
cp hybmss.json good.json
spoilt() {
  sed -E "$2" good.json >hybmss.json
  cmp -s good.json hybmss.json && fail "nothing is spoilt by $2"
  "$program" compare own.toml --out refused >log 2>&1
  local status=$?
  [ $status -eq 2 ] && [ "$(wc -l <log)" -eq 1 ] && grep -qE -- "$1" log && [ ! -e refused ] || fail "$2: status $status: $(head -c 600 log)"
}
spoilt 'own.toml:16:.*hybmss.json:[0-9]+:[0-9]+: not valid JSON' 's/"density_kg_m3": 1100.0/"density_kg_m3": NaN/'
spoilt 'own.toml:16:.*hybmss.json: /version: is 8 \(allowed' 's/"version":  1/"version": 8/'
spoilt 'hybmss.json: /springs/nodes/0/1: is 45 \(allowed: a whole number from 0 to 44' 's/(^  "nodes": \[\[)0,[0-9]+\]/\10,45]/'
spoilt 'hybmss.json: /springs/nodes/0/1: is 1.5 \(allowed: a whole number' 's/(^  "nodes": \[\[)0,[0-9]+\]/\10,1.5]/'
spoilt 'hybmss.json: /nodes/mass_kg/0: is 0.0 \(allowed: a finite number >= 1e-30' 's/("mass_kg": \[)[^,]*/\10.0/'
spoilt 'hybmss.json: /nodes/mass_kg: has 44 numbers \(allowed: 45, as there are nodes' 's/("mass_kg": \[)[^,]*,/\1/'
spoilt 'hybmss.json: /springs/rest_length_m/0: is -0.05 ' 's/("rest_length_m": \[)[^,]*/\1-0.05/'
spoilt 'hybmss.json: /springs/stiffness_N_m/0: is null ' 's/("stiffness_N_m": \[)[^,]*/\1null/'
spoilt 'hybmss.json: /nodes: node 0 is not at rest' 's/("rest_length_m": \[)[^,]*/\10.06/'
spoilt 'hybmss.json: /material: the springs are those of E = 10000 Pa, nu = 0.3.*nu = 0.4' 's/"poisson_ratio": 0.4/"poisson_ratio": 0.3/'
spoilt "hybmss.json: /laws/volume_corection: is an unknown key.*did you mean 'volume_correction'" 's/volume_correction/volume_corection/'
spoilt 'hybmss.json: /density: is an unknown key' 's/density_kg_m3/density/'
cp good.json hybmss.json
sed -i 's/hybmss.json/none.json/' own.toml
"$program" compare own.toml --out refused >log 2>&1
[ $? -eq 2 ] && grep -q 'none.json: no such file' log || fail "a file that is missing: $(cat log)"
sed -i 's/none.json/hybmss.json/; s/0\.2, 0\.1, 0\.1/20, 10, 10/' own.toml
"$program" compare own.toml --out refused >log 2>&1
[ $? -eq 2 ] && grep -q 'the network reaches from .* the body from' log || fail "a body outside the network: $(cat log)"
"$program" export case.toml --to springs --out springs.txt >log 2>&1
[ $? -eq 2 ] && grep -q 'allowed: a name that ends in .json, .npz or .vtu' log || fail "another ending: $(cat log)"
# bad PATTERN ARGUMENTS...: status 2, a line (of the command line's own checks: and where help is), no file
bad() {
  local pattern=$1
  shift
  rm -f bad.json
  "$program" export "$@" --to springs --out bad.json >log 2>errors
  local status=$?
  [ $status -eq 2 ] && [ "$(wc -l <errors)" -le 2 ] && grep -qE -- "$pattern" errors && [ ! -e bad.json ] || fail "export $*: status $status: $(head -c 600 errors)"
}
bad 'a body alone needs -E and --nu' icosahedron.stl
bad 'poisson_ratio.*0\.5' icosahedron.stl -E 5e3 --nu 0.5
bad "unknown model 'hybmss_av' .*did you mean 'hybmss_avg'" icosahedron.stl -E 5e3 --nu 0.45 --model hybmss_av
bad '--voxels.*4000000' icosahedron.stl -E 5e3 --nu 0.45 --voxels 100000000
sed '2,8d' icosahedron.stl >open.stl  # without its first facet
bad 'open.stl' open.stl -E 5e3 --nu 0.45
bad 'none.stl' none.stl -E 5e3 --nu 0.45
bad 'scale: 1e\+200 is no factor .allowed: 1e-30 to 1e\+30' icosahedron.stl -E 5e3 --nu 0.45 --scale 1e200
bad 'the body spans 1.7e\+12 x .* m.*allowed: a longest side of 1e-06 to 1e\+09 m' icosahedron.stl -E 5e3 --nu 0.45 --scale 1e12
bad 'nodes.mass_kg of the springs file: .*allowed' icosahedron.stl -E 5e3 --nu 0.45 --density 1e29 --scale 1e3
# Loads that no body can obey, though a springs file has none.
{ sed '/^accuracy/d' refined.toml; printf '[[load]]\non = "surface"\ndisplacement_m = [0.001, 0, 0]\n'; } >twice.toml
bad "twice.toml:[0-9]+:1: load: 'surface' has the displacement x = 0.001 m at .*, where 'low' of the load in line [0-9]+ has 0 m" twice.toml
cp icosahedron.stl CAPITALS.STL
"$program" export CAPITALS.STL -E 5e3 --nu 0.45 --voxels 30 --to springs --out capitals.json >log 2>&1 || fail "an ending in capitals: $(cat log)"
mkdir taken.json
for out in taken.json none/body.json; do
  "$program" export icosahedron.stl -E 5e3 --nu 0.45 --to springs --out $out >log 2>errors
  [ $? -eq 2 ] && [ "$(wc -l <errors)" -eq 1 ] && grep -q -- "--out: cannot write $out.*allowed" errors && [ ! -e $out.part ] || fail "an unwritable file: $(cat errors)"
done
# Through a symbolic link, which stays one.
ln -s linked.json link.json
"$program" export icosahedron.stl -E 5e3 --nu 0.45 --to springs --out link.json >log 2>&1
[ $? -eq 0 ] && [ -L link.json ] && [ -s linked.json ] || fail "a symbolic link: $(cat log)"

# LAMMPS: its forces are ours, at a state that it has moved to.
"$program" export case.toml --to lammps --model emsm --out springs.data >log 2>&1
[ $? -eq 2 ] && grep -q 'emsm has forces that LAMMPS does not compute (allowed: msm_18, .*kirkwood, hybmss_cf' log || fail "a model that LAMMPS has not: $(cat log)"
for model in msm_18 hybmss_cf msm_random kirkwood; do
  cells="4 2 2"
  [ $model != kirkwood ] || cells="4 2 1 --nu 0.4"  # at 1/4 its angles have no stiffness
  # shellcheck disable=SC2086
  export_to case.toml --to lammps --model $model --cells $cells --out springs.data
  # shellcheck disable=SC2086
  export_to case.toml --to springs --model $model --cells $cells --out springs.npz
  if [ -z "$lmp" ] || [ -z "$numpy" ]; then echo "without lmp or numpy: LAMMPS' forces are not checked"; break; fi
  sed 's/^run 0$//' springs.in >moved.in
  cat >>moved.in <<'END'
displace_atoms all ramp x 0.0 0.01 z 0.0 0.1 units box
displace_atoms all ramp y 0.0 0.02 x 0.0 0.2 units box
dump 1 all custom 1 moved id x y z fx fy fz mass
dump_modify 1 sort id format float %.17g
run 0
END
  "$lmp" -in moved.in -log none >log 2>&1 || fail "lmp: $(tail -3 log)"
  "$numpy" - <<'END' || fail "LAMMPS has other forces of $model"
import numpy as np, sys
sys.argv = ["", "springs.npz"]
from springs import load, forces
s = load("springs.npz")
theirs = np.loadtxt("moved", skiprows=9)
ours = forces(s, theirs[:, 1:4])
assert abs(ours).max() > 1e-3
assert abs(theirs[:, 4:7] - ours).max() < 1e-9 * abs(ours).max(), abs(theirs[:, 4:7] - ours).max() / abs(ours).max()
END
done
if [ -z "$numpy$jsonschema" ] && [ $failures -eq 0 ]; then exit 77; fi
exit $((failures > 0))
