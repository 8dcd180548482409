#!/usr/bin/env bash
# Natural frequencies of a free and of a held cube, beside the reference's, and what is refused.   frequencies.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1

cat >"$work/cube.toml" <<'TOML'
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [6, 6, 6]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = [0.49, 0.25]
density_kg_m3 = 1000
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
force_N = [0, 0, -1]
[compare]
models = ["hybmss_bt"]
[reference]
cells = [8, 8, 8]
TOML

# check NAME PYTHON-EXPRESSION: of the tables in frequencies.json
check() {
  python3 - "$work/out/frequencies.json" "$2" <<'PY' || fail "$1"
import json, sys
case = json.load(open(sys.argv[1]))
tables = case["tables"]
ok = eval(sys.argv[2])
if not ok: print(json.dumps([[t["reference"]["rigid_motions"], [(m["mass_consistency"], m["rms_error"], m["largest_error"]) for m in t["models"]]] for t in tables]))
sys.exit(not ok)
PY
}

"$program" frequencies "$work/cube.toml" --free --poisson-ratio 0.49 --modes 8 --out "$work/out" --vtu >"$work/stdout" 2>"$work/stderr" ||
  fail "free: status $?: $(cat "$work/stdout" "$work/stderr")"
check "free: six rigid motions" 'len(tables) == 1 and all(t["reference"]["rigid_motions"] == 6 for t in tables) and case["supports"] == "free"'
# Lumped masses are slow by (k h)^2/16 and more, at least; half consistent ones by a third of that.
check "free: errors of lumped masses" 'all(0.02 < t["models"][0]["rms_error"] < 0.06 for t in tables)'
check "free: errors of half consistent masses" 'all(t["models"][1]["rms_error"] < 0.022 for t in tables)'
check "free: every mode has its partner" 'all(p["mac"] > 0.95 for t in tables for m in t["models"] for p in m["pairs"]) and len(tables[0]["models"][0]["pairs"]) == 8'
check "free: the reference knows itself to 1e-3" 'all(r["uncertainty_Hz"] < 1e-3 * r["frequency_Hz"] for t in tables for r in t["reference"]["modes"])'
[ -s "$work/out/cube-nu0.49-6x6x6-fem.vtu" ] || fail "no VTU of the reference: $(ls "$work/out")"
[ -s "$work/out/cube-nu0.49-6x6x6-hybmss_bt-theta0.5.vtu" ] || fail "no VTU of the model: $(ls "$work/out")"

"$program" frequencies "$work/cube.toml" --modes 5 --poisson-ratio 0.25 --mass-consistency 0.6 --out "$work/out" >"$work/stdout" 2>"$work/stderr" ||
  fail "held: status $?: $(cat "$work/stdout" "$work/stderr")"
check "held: no rigid motion, the force is no support" 'len(tables) == 1 and tables[0]["reference"]["rigid_motions"] == 0 and case["supports"] == "held on z_min"'
check "held: errors" 'tables[0]["models"][0]["rms_error"] < 0.02 and tables[0]["models"][0]["mass_consistency"] == 0.6'
check "held: no mode is less uncertain than most: grids may agree by accident" 'all(min(u) > 0.999 * sorted(u)[len(u) // 2]
   for t in tables for u in [[m["uncertainty_Hz"] / m["frequency_Hz"] for m in t["reference"]["modes"]]])'
grep -q "held on z_min" "$work/stdout" || fail "the table does not say what is held: $(cat "$work/stdout")"

# Columns have heads with units, within 80 letters.
head=$(grep -m1 '^mode' "$work/stdout")
[ "$(echo $head)" = "mode FEM [Hz] +- [Hz] [Hz] error [%] MAC" ] || fail "the heads of the table: '$head'"
[ "$(awk '/^mode/ { table = 1 } table && length > most { most = length } END { print most }' "$work/stdout")" -le 80 ] || fail "wide: $(cat "$work/stdout")"
check "modes are in ascending order" 'all(fs == sorted(fs) for t in tables for fs in [[m["frequency_Hz"] for m in t["reference"]["modes"]]] + [m["frequencies_Hz"] for m in t["models"]])'

# Tetrahedra at the Poisson ratio of tissue.  A sphere: the torsional mode T2, 2.50113 c_s/(2 pi a), five times, and S2 (Lamb 1882).
cat >"$work/sphere.toml" <<'TOML'
[body]
geo = "sphere.geo"
size_m = [0.1, 0.1, 0.1]
voxels = 60
[material]
youngs_modulus_Pa = 3000
poisson_ratio = 0.49
density_kg_m3 = 1000
[[load]]
gravity_m_s2 = [0, 0, -1]
[compare]
models = ["hybmss_avg"]
[reference]
edge_m = 0.016
TOML
"$program" frequencies "$work/sphere.toml" --free --modes 10 --mass-consistency 1 --out "$work/out" >"$work/stdout" 2>"$work/stderr" ||
  fail "sphere: status $?: $(cat "$work/stdout" "$work/stderr")"
check "sphere: the mixed form of tetrahedra, six rigid motions" '"P2-P1 mixed" in tables[0]["reference"]["form"] and tables[0]["reference"]["rigid_motions"] == 6'
check "sphere: T2 and S2 within their uncertainty and 2 %" 'all(abs(r["frequency_Hz"] / (eta * (3000 / 2.98 / 1000)**.5 / (2 * 3.14159265 * 0.05)) - 1) < min(0.02, r["uncertainty_Hz"] / r["frequency_Hz"])
   for eta, r in zip(5 * [2.501134] + 5 * [2.664831], tables[0]["reference"]["modes"]))'

# A mass on the end of a slender cantilever, twice its own: 1 + cos b cosh b + 2 b (cos b sinh b - sin b cosh b) = 0, b = 1.076196,
# f = b^2/(2 pi L^2) sqrt(E I/(rho A)); shear and rotation take a thousandth off.
"$program" frequencies verification/tip_mass --modes 4 --poisson-ratio 0 --out "$work/out" >"$work/stdout" 2>"$work/stderr" ||
  fail "tip mass: status $?: $(cat "$work/stdout" "$work/stderr")"
check "tip mass: both bending modes of the reference" 'all(0.998 < r["frequency_Hz"] / 13.47255 < 1 for r in tables[0]["reference"]["modes"][:2])'
check "tip mass: those of the models" 'all(abs(m["frequencies_Hz"][0] / 13.47255 - 1) < 0.004 for m in tables[0]["models"])'

# An interrupt is heard between the iterations of a model.  Without a reference, which is interrupted as everywhere.
sed 's/cells = \[6, 6, 6\]/cells = [24, 24, 24]/' "$work/cube.toml" >"$work/fine.toml"
SPRINGPROOF_FEM_PROGRAM=/bin/false "$program" frequencies "$work/fine.toml" --modes 60 >"$work/stdout" 2>"$work/stderr" &
pid=$!
sleep 3
kill -INT $pid
wait $pid
status=$?
[ $status -eq 130 ] && ! grep -q hybmss "$work/stdout" || fail "an interrupt: status $status: $(cat "$work/stdout" "$work/stderr")"

# refused PATTERN ARGUMENTS...
refused "none of the case's .allowed: 0.49, 0.25" frequencies "$work/cube.toml" --poisson-ratio 0.3
refused "needs a folder" frequencies "$work/cube.toml" --vtu
refused "mass-consistency" frequencies "$work/cube.toml" --mass-consistency 1.5
sed 's/z_min/z_top/' "$work/cube.toml" >"$work/mistaken.toml"
refused "mistaken.toml:9:.*z_top" frequencies "$work/mistaken.toml"
exit $((failures > 0))
