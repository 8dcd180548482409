"""examples/*.py: each runs, and the springs file's body hangs as compare says."""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
import springproof as sp

SOURCE = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = SOURCE / "examples"


def run(*command, cwd):
    path = str(pathlib.Path(sp.__file__).absolute().parents[1])
    made = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": path, "MPLBACKEND": "Agg"})
    assert made.returncode == 0, made.stderr
    return made.stdout


def test_plot(tmp_path):
    pytest.importorskip("matplotlib")
    out = run(sys.executable, EXAMPLES / "plot_bending.py", "bending.png", cwd=tmp_path)
    assert (tmp_path / "bending.png").stat().st_size > 10000
    off = {model: [abs(float(word)) for word in values.split()] for model, values in re.findall(r"(\w+) +off by (.*) %", out)}
    assert off["hybmss_avg"][1] < 0.5, out  # [%], at nu = 0, where a clamped end hinders no contraction
    assert all(best < other for name in ("hybmss", "emsm") for best, other in zip(off["hybmss_avg"], off[name])), out


def test_vtu(tmp_path):
    out = run(sys.executable, EXAMPLES / "twist_vtu.py", cwd=tmp_path)
    assert len(list((tmp_path / "twist").glob("*.vtu"))) == 20 and (tmp_path / "twist" / "motion.pvd").is_file()
    # A square bar of side a twisted by an angle t over its length L: torque 0.1406 G t a^4 / L, to 15 % at a quarter turn.
    torque = float(re.search(r"torque (\S+) mN m", out).group(1)) / 1e3
    assert torque == pytest.approx(0.1406 * 1e5 / 2.9 * 1.5708 * 0.02**4 / 0.08, rel=0.15), out


CASE = """
[body]
geo = "icosahedron.stl"
scale = 0.05
voxels = 300
cut = false
[[patch]]
name = "top"
beyond = {{ point_m = [0, 0, 0.03], normal = [0.2, 0, 1] }}
[material]
youngs_modulus_Pa = 2e4
poisson_ratio = 0.4
density_kg_m3 = 1100
[[load]]
on = "top"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[probe]]
name = "lowest"
at_m = {at}
[compare]
models = ["hybmss_avg"]
measures = ["probe", "reaction"]
[reference]
elements = []
[[expect]]
model = "hybmss_avg"
measure = "force.top.x"
source = "analytic"
value = 0
within = 1e-6
where = "balance"
"""


def test_springs_alone(tmp_path):
    example = EXAMPLES / "drop_springs.py"
    text = example.read_text()
    assert "import springproof" not in text and len(text.splitlines()) <= 60
    program = sp.find_program()
    if not program:
        pytest.skip("no program springproof")
    (tmp_path / "icosahedron.stl").write_bytes((SOURCE / "comparisons/experiments/calibration/icosahedron.stl").read_bytes())
    case = tmp_path / "hung.toml"
    case.write_text(CASE.format(at=[0, 0, 0]))
    run(program, "export", case, "--to", "springs", "--out", "body.npz", cwd=tmp_path)
    sp.read_springs(tmp_path / "body.npz").write(tmp_path / "body.json")
    alone = "import sys; sys.modules['springproof'] = None; sys.argv = ['', '{}', 'top']; exec(open(r'{}').read())"
    out, again = (run(sys.executable, "-c", alone.format(file, example), cwd=tmp_path) for file in ("body.npz", "body.json"))
    assert out == again
    sag, node = re.search(r"sags by (\S+) m at node (\d+)", out).groups()
    case.write_text(CASE.format(at=sp.read_springs(tmp_path / "body.npz").positions[int(node)].tolist()))
    value = next(row["value"] for row in sp.compare(case) if row["measure"] == "displacement.lowest.z")
    assert float(sag) == pytest.approx(-value, rel=1e-6) and float(sag) > 1e-4
    rebound = re.search(r"rebounds after (\S+) s, squeezed to (\S+) of", out)
    assert float(rebound.group(1)) < 1 and 0.3 < float(rebound.group(2)) < 0.999, out


def test_hanging(tmp_path):
    """A body of cut cells without a case: what hang_springs.py finds is the equilibrium of `compare`, held and loaded at the same sides."""
    pytest.importorskip("scipy")
    program = sp.find_program()
    if not program:
        pytest.skip("no program springproof")
    (tmp_path / "icosahedron.stl").write_bytes((SOURCE / "comparisons/experiments/calibration/icosahedron.stl").read_bytes())
    for file in ("hang_springs.py", "springs.py"):
        (tmp_path / file).write_text((EXAMPLES / file).read_text())
    assert "import springproof" not in (tmp_path / "hang_springs.py").read_text()
    run(program, "export", "icosahedron.stl", "-E", "5e3", "--nu", "0.45", "--scale", "0.1", "--voxels", "300", "--hold", "bottom",
        "--load", "top", "--to", "springs", "--out", "ball.npz", cwd=tmp_path)
    out = run(sys.executable, "hang_springs.py", "ball.npz", "bottom", "top", "0.1", "0", "-0.5", cwd=tmp_path)
    moves = [float(u) for u in re.search(r"where it is loaded by \[(.*)\]", out).group(1).split(",")]
    written = run(program, "new", "icosahedron.stl", "-E", "5e3", "--nu", "0.45", "--scale", "0.1", cwd=tmp_path)
    case = re.sub(r"^voxels = .*", "voxels = 300", written, flags=re.M)
    for end, side in (("low", "bottom"), ("high", "top")):
        case = re.sub(rf'^name = "{end}"\nbeyond = .*', f'name = "{side}"\nside = "{side}"', case, flags=re.M)
        case = case.replace(f'on = "{end}"', f'on = "{side}"')
    case = case.replace('# kinematics = "hencky"', 'kinematics = "hencky"\n')
    case = re.sub(r"^force_N = .*", "force_N = [0.1, 0, -0.5]", case, flags=re.M)
    case = re.sub(r"^models = .*", 'models = ["hybmss_avg"]\nmeasures = ["mean_displacement"]\n[reference]\nelements = []', case, flags=re.M)
    (tmp_path / "case.toml").write_text(case)
    rows = {row["measure"]: row["value"] for row in sp.compare(tmp_path / "case.toml")}
    compared = [rows[f"mean_displacement.top.{axis}"] for axis in "xyz"]
    assert moves == pytest.approx(compared, abs=1e-4 * abs(compared[2])) and compared[2] < -1e-4
    assert (tmp_path / "ball-hung.obj").read_text().count("\nf ") > 100


def test_own_springs(tmp_path):
    """The example's model is a row at each Poisson's ratio, and the two that stand beside it are better."""
    if not sp.find_program("springproof-fem"):
        pytest.skip("no finite elements")
    out = run(sys.executable, EXAMPLES / "own_springs.py", cwd=tmp_path)
    off = {(nu, model): float(error) for nu, model, error in re.findall(r"nu = (\S+) +(\w+) +off by (\S+) %", out)}
    assert {model for _, model in off} >= {"van_gelder", "msm_18", "hybmss_avg"} and (tmp_path / "own-report" / "report.html").is_file()
    for nu in ("0.25", "0.4"):
        assert off[nu, "hybmss_avg"] < 5 and off[nu, "hybmss_avg"] < off[nu, "van_gelder"] < 100, out


def test_a_material_that_relaxes(tmp_path):
    """What examples/springs.py makes of a file's branches, in steps under a load, is what the library makes of them."""
    program = sp.find_program()
    if not program:
        pytest.skip("no program springproof")
    run(program, "export", "motion/relaxing_bar", "--to", "springs", "--out", "bar.json", cwd=tmp_path)
    name = importlib.util.spec_from_file_location("springs", EXAMPLES / "springs.py")
    springs = importlib.util.module_from_spec(name)
    name.loader.exec_module(springs)
    model, s = sp.read_springs(tmp_path / "bar.json"), springs.load(str(tmp_path / "bar.json"))
    motion, x = model.motion([]), model.positions.copy()
    v, load = np.zeros(x.shape), 1e-3 * np.sin(np.arange(x.size)).reshape(x.shape)
    motion.set_forces(load)
    motion.set_state(x, v)
    motion.step(300)
    assert springs.time_step(s) == pytest.approx(motion.time_step)
    springs.time_step = lambda s: motion.time_step
    for _ in range(300):
        springs.step(s, x, v, load)
    moved = abs(x - model.positions).max()
    np.testing.assert_allclose(motion.positions, x, atol=1e-10 * moved)
    assert abs(springs.branch_forces(s, x)).max() > 1e-3 * abs(springs.forces(s, x)).max()
