#!/usr/bin/env bash
# Numbers of a bar from values that the program itself has of it, with noise; what they do not tell; what is refused.
#   identify.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1

# bar E [MEASURED]: a bar under its weight and with a mass at its end.
bar() {
  cat <<TOML
[body]
geo = "block.geo"
size_m = [0.1, 0.03, 0.03]
cells = [[4, 1, 1], [8, 2, 2]]
[material]
youngs_modulus_Pa = $1
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[mass]]
name = "weight"
on = "x_max"
mass_kg = 0.05
[[load_case]]
name = "loaded"
[[load_case]]
name = "bare"
with = { mass = [] }
[compare]
models = ["hybmss_avg"]
measures = ["mean_displacement", "frequency"]
[reference]
elements = []
[[input]]
name = "width"
of = "body.size_m[1]"
u = 3e-4
[[measured]]
source = "this program"
licence = "none"
values = [
  { name = "sag", quantity = "mean_displacement.x_max.z", value = ${2:-1}, u = 1e-4 },
  { name = "bare sag", quantity = "mean_displacement.x_max.z", load_case = "bare", value = ${3:-1}, u = 2e-5 },
  { name = "frequency", quantity = "frequency.z", value = ${4:-1}, u = 0.05 },
  { name = "bare frequency", quantity = "frequency.z", load_case = "bare", value = ${5:-1}, u = 0.1 },
]
TOML
}

# what the last lines seek
sought() {
  cat <<'TOML'
[[identify]]
name = "modulus and density"
parameters = [{ of = "material.youngs_modulus_Pa", start = 3e4 }, { of = "material.density_kg_m3", start = 3000 }]
fit = ["sag", "frequency", "bare frequency"]
[[identify]]
name = "modulus and ratio"
parameters = [{ of = "material.youngs_modulus_Pa", start = 3e4 }, { of = "material.poisson_ratio" }]
fit = ["sag", "bare sag"]
TOML
}

# check WORDS PYTHON-EXPRESSION: of the list in identify.json, as `i`
check() {
  python3 - "$work/out/identify.json" "$2" <<'PY' || fail "$1" "$work/log"
import json, sys
i = json.load(open(sys.argv[1]))
sys.exit(0 if eval(sys.argv[2]) else 1)
PY
}

# The truth, E = 2e5 and 1000 kg/m3, is the limit of the same lattices.
bar 2e5 -0.001 -0.001 1 1 >"$work/truth.toml"
"$program" compare "$work/truth.toml" --out "$work/truth" --quiet >"$work/log" 2>&1
values=$(python3 - "$work/truth/results.json" <<'PY'
import json, sys
print(*[repr(v["simulated"]) for v in json.load(open(sys.argv[1]))["cases"][0]["validation"]])
PY
) || stop "the bar has no values"
{ bar 2e5 $values; sought; } >"$work/bar.toml"

"$program" identify "$work/bar.toml" --out "$work/out" --synthetic 20 >"$work/log" 2>&1 || stop "not identified"
check "the truth is found" 'abs(i[0]["parameters"][0]["value"] / 2e5 - 1) < 2e-3 and abs(i[0]["parameters"][1]["value"] / 1000 - 1) < 5e-3 and i[0]["chi2"] < 0.01'
check "its limits hold it" 'all(p["from"] < truth < p["to"] for p, truth in zip(i[0]["parameters"], (2e5, 1000)))'
check "the value that is not fitted is predicted" '[v["name"] for v in i[0]["values"] if v["ratio"] is not None] == ["bare sag"] and i[0]["values"][1]["ratio"] < 0.1'
check "synthetic sets hold the truth" 'i[0]["synthetic"]["sets"] == 20 and all(17 <= n for n in i[0]["synthetic"]["inside"])'
check "the width is uncertain, and shared out" 'i[0]["parameters"][0]["u_inputs"] > 0 and i[0]["parameters"][0]["inputs"][0]["input"] == "width"'
check "the ratio is held and said" 'i[1]["parameters"][1]["held"] and i[1]["parameters"][1]["value"] == 0.3 and any("do not tell poisson_ratio" in s for s in i[1]["sentences"])'
check "the modulus beside it is found" 'abs(i[1]["parameters"][0]["value"] / 2e5 - 1) < 2e-3 and not i[1]["parameters"][0]["held"]'
check "correlations are of what is found" 'abs(i[0]["correlation"][0][1]) < 0.999 and i[1]["correlation"][0][1] < -0.9'
check "what is not known of the fit's limits is in a prediction" 'i[0]["values"][1]["u_fit_numerical"] > 0 and i[0]["values"][1]["u_val"] > i[0]["values"][1]["u_fit_numerical"]'
grep -q "chi²" "$work/log" && grep -q "<svg" "$work/out/identify.html" && grep -q "Synthetic sets" "$work/out/identify.html" && grep -q "direction 2" "$work/out/identify.html" || fail "text and page"

# Every run is kept, from which it goes on.
runs=$(ls "$work/out/runs" | wc -l)
"$program" identify "$work/bar.toml" --out "$work/out" --synthetic 20 --resume >"$work/log" 2>&1 || fail "not resumed" "$work/log"
check "nothing is run again" 'all(one["runs"] == 0 and one["kept"] > 0 for one in i)'
rm "$(ls -d "$work/out/runs/"* | head -1)"
"$program" identify "$work/bar.toml" --out "$work/out" --synthetic 20 --resume >"$work/log" 2>&1 || fail "not resumed" "$work/log"
check "but for what is missing" 'sum(one["runs"] for one in i) == 1'
[ "$(ls "$work/out/runs" | wc -l)" -eq "$runs" ] || fail "a run that was made is not kept"

# From other starts the same is found.
"$program" identify "$work/bar.toml" --only "modulus and density" --start 1e6,400 --out "$work/out" --resume >"$work/log" 2>&1 || fail "from another start" "$work/log"
check "from another start" 'len(i) == 1 and abs(i[0]["parameters"][0]["value"] / 2e5 - 1) < 2e-3 and abs(i[0]["parameters"][1]["value"] / 1000 - 1) < 5e-3'

# Of a body of voxels the coarsest comes first, in whatever order the case has them.
python3 - >"$work/bar.stl" <<'PY'
from itertools import product
size = (0.1, 0.03, 0.03)
print("solid bar")
for axis, side in product(range(3), (0, 1)):
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]][:: 1 if side else -1]
    points = []
    for a, b in corners:
        p = [0, 0, 0]
        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, a, b
        points.append([x * s for x, s in zip(p, size)])
    for three in (points[:3], [points[0], *points[2:]]):
        print("facet normal 0 0 0 outer loop", *[f"vertex {p[0]} {p[1]} {p[2]}" for p in three], "endloop endfacet")
print("endsolid bar")
PY
for order in "0.015, 0.0075" "0.0075, 0.015"; do
  { bar 2e5 $values | sed -e '/^geo/d; /^size_m/d; s/^cells.*/geo = "bar.stl"\nvoxel_edge_m = ['"$order"']/' -e '/input/,/^u = 3e-4/d' \
      -e 's/on = "x_min"/on = "held"/; s/x_max/free/g' -e '/name = ".*frequency"/d'
    cat <<'TOML'
[[patch]]
name = "held"
beyond = { point_m = [0.001, 0, 0], normal = [-1, 0, 0] }
[[patch]]
name = "free"
beyond = { point_m = [0.099, 0, 0], normal = [1, 0, 0] }
[[identify]]
name = "modulus"
parameters = [{ of = "material.youngs_modulus_Pa", start = 1e5 }]
fit = ["sag", "bare sag"]
TOML
  } >"$work/voxels.toml"
  "$program" identify "$work/voxels.toml" --out "$work/out" >"$work/log" 2>&1 || fail "of voxels" "$work/log"
  check "the coarsest lattice is the first: $order" 'i[0]["cells"][0][0] < i[0]["cells"][1][0]'
  modulus=$(python3 -c 'import json, sys; print("%.6g" % json.load(open(sys.argv[1]))[0]["parameters"][0]["value"])' "$work/out/identify.json")
  [ "${first:=$modulus}" = "$modulus" ] || fail "the order of the lattices changes the modulus from $first to $modulus"
done

refused "seeks nothing .allowed: a case with ..identify" identify "$work/truth.toml" --out "$work/out"
refused "'mass' is no ..identify.. of the case .allowed: modulus and density, modulus and ratio" identify "$work/bar.toml" --only mass --out "$work/out"
refused "2 numbers of 'modulus and density'" identify "$work/bar.toml" --start 1e5 --only "modulus and density" --out "$work/out"
refused "poisson_ratio is to be from -0.99 to 0.4999" identify "$work/bar.toml" --start 1e5,0.7 --only "modulus and ratio" --out "$work/out"
sed 's/u = 1e-4/u = 0/' "$work/bar.toml" >"$work/no_u.toml"
refused "no_u.toml:[0-9]+:.*u: is 0 .allowed: a finite number > 0" identify "$work/no_u.toml" --out "$work/out"
sed 's/fit = .*/fit = ["sag"]/' "$work/bar.toml" >"$work/few.toml"
refused "few.toml:.*2 parameters for 1 fitted values" identify "$work/few.toml" --out "$work/out"
exit $((failures > 0))
