#!/usr/bin/env bash
# Bodies for real-time engines: what is written, and what an engine cannot have.   engines.sh PROGRAM
. "$(dirname "$0")/../cli/lib.sh"
program=$1
cd "$work" || exit 1
cat >bar.toml <<'TOML'
[body]
geo = "block.geo"
size_m = [1, 0.5, 0.5]
cells = [4, 2, 2]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = [0.25, 0.4]
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "y_min"
displacement_m = ["free", 0, "free"]
[[load]]
on = "x_max"
force_N = [0, 0, -1]
[compare]
models = ["hybmss", "msm_18"]
TOML
for engine in jolt bullet; do
  "$program" export bar.toml --to $engine --out $engine.json >log 2>&1 || fail "$engine: $(cat log)"
  grep -q 'pinned: x_min$' log || fail "$engine: what is pinned: $(cat log)"
  grep -q "\"format\": \"springproof $engine\"" $engine.json || fail "$engine.json: no format"
done
grep -q 'edges.*E = 1e+06 Pa, nu = 0.25' <("$program" export bar.toml --to jolt --out jolt.json) || fail "a line about it"
"$program" export bar.toml --to mujoco --nu 0.4 >log 2>&1 && [ -s bar.xml ] || fail "mujoco: $(cat log)"
grep -q '<elasticity young="1000000" poisson="0.4" damping="0"/>' bar.xml || fail "bar.xml"
[ "$(grep -c '<body name="n[0-9]*" pos="0 [^/]*/>' bar.xml)" -eq 9 ] || fail "the pins of bar.xml: $(grep '<body' bar.xml | head -3)"

refused 'hybmss has more than springs.*lock \(allowed: msm_18, msm_14, hybmss_cf\)' export bar.toml --to jolt --model hybmss --out no.json
refused 'is 0.4, and springs alone.*\(allowed: 0.25;' export bar.toml --to jolt --nu 0.4 --out no.json
refused 'msm_18: Bullet.s links have no modulus' export bar.toml --to bullet --model msm_18 --out no.json
refused 'a name that ends in .xml' export bar.toml --to mujoco --out no.json
# Boxes: an engine gets cubes, and the message says how.
sed 's/cells = .*/cells = [8, 2, 2]/; s/"hybmss", "msm_18"/"hybmss_avg"/' bar.toml >boxes.toml
for engine in jolt bullet mujoco lammps; do
  refused "boxes.toml: the cells are 0.125 x 0.25 x 0.25 m \(allowed with --to $engine: cubes, --cells NX NY NZ" export boxes.toml --to $engine
done
"$program" export boxes.toml --to jolt --cells 8 4 4 --out cubes.json >log 2>&1 || fail "boxes as cubes: $(cat log)"
"$program" export boxes.toml --to springs --out boxes.json >log 2>&1 || fail "boxes as springs: $(cat log)"
refused 'not the corners of whole cubes' export bar.toml --to jolt --model msm_centred --out no.json
[ ! -e no.json ] && [ ! -e no.xml ] || fail "a refused export wrote a file"

# The numbers of `material` are those of the file: a spring inside, on the surface, on an edge.
"$program" material -E 1e6 --nu 0.25 --cell-size 0.25 --model msm_18 --json >material.json || fail "material"
/usr/bin/env python3 - <<'END' || fail "material and export differ"
import json
want = json.load(open("material.json"))["engines"]["compliance_m_N"]
file = json.load(open("jolt.json"))
found = {"k_e": set(), "k_f": set()}
for length, c in zip(file["edges"]["rest_length_m"], file["edges"]["compliance_m_N"]):
    found["k_e" if length < 0.3 else "k_f"].add(float("%.9g" % c))
assert {k: {float("%.9g" % c) for c in v.values()} for k, v in want.items()} == found, (want, found)
assert abs(sum(file["nodes"]["mass_kg"]) - 250) < 1e-9
END
"$program" material -E 1e6 --nu 0.4 --frequency 3 >log || fail "material: $(cat log)"
grep -qE "Bullet's neo-Hooke, mu +476190 Pa   4/3 G" log && grep -qE 'damps 3 Hz in steps of 1/60 s by +0.15708   of the critical' log || fail "material: $(cat log)"
exit $((failures > 0))
