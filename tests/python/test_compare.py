"""compare(), beside the same model solved here."""
import subprocess

import numpy as np
import pytest
import springproof as sp

if not sp.find_program():
    pytest.skip("no program springproof", allow_module_level=True)
pytestmark = pytest.mark.filterwarnings("error")

CASE = {
    "name": "bar",
    "body": {"geo": "block.geo", "size_m": [0.2, 0.1, 0.1], "cells": [4, 2, 2]},
    "material": {"youngs_modulus_Pa": 1e4, "poisson_ratio": [0.25, 0.4], "density_kg_m3": 1100},
    "load": [{"on": "x_min", "displacement_m": np.zeros(3)}, {"on": "x_max", "force_N": (0, 0, -0.1)}],
    "probe": [{"name": "tip", "at_m": [0.2, 0.05, 0.05]}],
    "compare": {"models": ["hybmss_avg", {"model": "hybmss", "face_to_cube": 1, "label": "A1"}], "measures": ["probe", "reaction", "volume_change"]},
    "reference": {"elements": []},
    "expect": [{"model": "A1", "measure": "force.x_min.z", "source": "analytic", "value": 0.1, "within_relative": 1e-6, "where": "balance"}],
}
COLUMNS = "case kinematics model poisson_ratio cells measure value unit reference reference_uncertainty error samples spread published published_where listed".split()


def test_rows_are_those_of_the_same_models():
    rows = sp.compare(CASE)
    assert list(rows[0]) == COLUMNS
    for nu in (0.25, 0.4):
        for label, name, options in (("hybmss_avg", "hybmss_avg", {}), ("A1", "hybmss", {"face_to_cube": 1})):
            model = sp.Model(name, sp.block((0.2, 0.1, 0.1), (4, 2, 2)), sp.Material(1e4, nu, density=1100), **options)
            state = model.solve([sp.Displacement("x_min"), sp.Force("x_max", (0, 0, -0.1))])
            own = {row["measure"]: row for row in rows if row["model"] == label and row["poisson_ratio"] == nu}
            assert own["displacement.tip.z"]["value"] == pytest.approx(state.at([(0.2, 0.05, 0.05)])[0, 2], rel=1e-9)
            assert own["force.x_min.z"]["value"] == pytest.approx(0.1, rel=1e-9)
            assert own["volume_change"]["value"] == pytest.approx(state.volume_change, rel=1e-6)
            assert own["volume_change"]["reference"] is None and own["volume_change"]["samples"] == 1
            assert own["displacement.tip.z"]["unit"] == "m" and own["displacement.tip.z"]["case"] == "bar"
    array = np.array([(row["model"], row["value"]) for row in rows if row["measure"] == "volume_change"], dtype=[("model", "U20"), ("value", float)])
    assert array.size == 4 and np.isfinite(array["value"]).all()


def test_rows_show_themselves():
    rows = sp.compare(CASE, poisson_ratio=0.4)
    shown = rows._repr_html_()
    assert shown.count("<tr>") == len(rows) + 1 and "<td>hybmss_avg</td>" in shown and "displacement.tip.z" in shown
    try:
        import matplotlib
    except ImportError:
        with pytest.raises(RuntimeError, match="python3-matplotlib"):
            rows.plot()
        return
    matplotlib.use("Agg")
    with pytest.raises(sp.InputError, match="no row has an error of 'displacement_error' .*no reference"):
        rows.plot()
    for row, error in zip(rows, (0.01, 0.02)):
        row.update(measure="displacement_error", error=error, reference_uncertainty=0.001)
    axes = rows.plot()
    assert len(axes.lines) == 1 and axes.get_ylabel() == "displacement error"


def test_one_ratio_and_a_folder_that_is_kept(tmp_path):
    rows = sp.compare(CASE, poisson_ratio=0.4, out=tmp_path / "kept", jobs=1)
    assert {row["poisson_ratio"] for row in rows} == {0.4}
    assert (tmp_path / "kept" / "report.html").is_file() and (tmp_path / "kept" / "results.json").is_file()
    again = sp.compare(CASE, poisson_ratio=[0.4], out=tmp_path / "kept", resume=True)
    assert again == rows


def test_errors_have_the_programs_text(tmp_path):
    wrong = {**CASE, "material": {**CASE["material"], "poison_ratio": 0.3}}
    with pytest.raises(sp.InputError, match="bar.toml:.*material.poison_ratio: .*did you mean 'poisson_ratio'") as refused:
        sp.compare(wrong)
    file = tmp_path / "bar.toml"
    file.write_text("[body]\ngeo = 3\n")
    said = subprocess.run([sp.find_program(), "compare", file, "--out", tmp_path / "out"], capture_output=True, text=True)
    assert said.returncode == 2
    with pytest.raises(sp.InputError) as refused:
        sp.compare(file)
    assert str(refused.value) == said.stderr.strip()
    with pytest.raises(sp.InputError, match="body.odd: is"):
        sp.compare({"body": {"odd": object()}})


def test_an_expectation_that_does_not_hold_is_a_warning():
    expect = {"model": "hybmss_avg", "measure": "force.x_min.z", "source": "analytic", "value": 0.2, "within_relative": 1e-6, "where": "nowhere"}
    with pytest.warns(UserWarning, match="bar"):
        rows = sp.compare({**CASE, "expect": [expect]}, poisson_ratio=0.25)
    assert rows


def test_springs_of_a_file_are_a_model_of_a_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    body, material = sp.block((0.2, 0.1, 0.1), (4, 2, 2)), sp.Material(1e4, 0.4, density=1100)
    sp.Model("hybmss", body, material).write("mine.json")
    case = {**CASE, "compare": {**CASE["compare"], "models": ["hybmss", {"file": "mine.json", "label": "mine"}]}}
    case["expect"] = [{**CASE["expect"][0], "model": "mine"}]
    rows = sp.compare(case, poisson_ratio=0.4)
    value = {row["model"]: row["value"] for row in rows if row["measure"] == "displacement.tip.z"}
    assert value["mine"] == pytest.approx(value["hybmss"], rel=1e-9)


def test_a_body_by_voxels_is_that_of_compare(tmp_path):
    """A tetrahedron in an STL file: whole cubes and cut cells, by compare() and here."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.2, 0.2, 1)]) * 0.1
    text = "solid t\n"
    for facet in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
        text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corners[i]) for i in facet) + "endloop\nendfacet\n"
    (tmp_path / "t.stl").write_text(text + "endsolid t\n")
    foot = dict(beyond=((0, 0, 0.005), (0, 0, -1)))
    body = sp.voxels(tmp_path / "t.stl", cubes=200, patches=[sp.Patch("foot", **foot), sp.Patch("top", near=((0.02, 0.02, 0.1), 0.03))])
    assert body.notes and {"foot", "top", "surface"} <= set(body.patches) and abs(len(body.cells) - 200) < 40
    rows = sp.compare({
        "name": "t",
        "expect": [{"model": "cubes", "measure": "force.top.x", "source": "analytic", "value": 0, "within": 1, "where": "it is finite"}],
        "body": {"geo": str(tmp_path / "t.stl"), "voxels": 200},
        "patch": [{"name": "foot", "beyond": {"point_m": [0, 0, 0.005], "normal": [0, 0, -1]}}, {"name": "top", "near": {"point_m": [0.02, 0.02, 0.1], "radius_m": 0.03}}],
        "material": {"youngs_modulus_Pa": 1e4, "poisson_ratio": 0.4},
        "load": [{"on": "foot", "displacement_m": [0, 0, 0]}, {"on": "top", "displacement_m": [0.001, 0, 0]}],
        "probe": [{"name": "middle", "at_m": [0.03, 0.03, 0.03]}],
        "compare": {"models": ["hybmss_avg", {"model": "hybmss_avg", "cut": False, "label": "cubes"}], "measures": ["probe", "reaction"]},
        "reference": {"elements": []}})
    loads = [sp.Displacement("foot"), sp.Displacement("top", (0.001, 0, 0))]
    for label, options in (("hybmss_avg", dict(cut=True, held=["foot", "top"])), ("cubes", {})):
        state = sp.Model("hybmss_avg", body, sp.Material(1e4, 0.4), **options).solve(loads)
        value = {row["measure"]: row["value"] for row in rows if row["model"] == label}
        assert value["displacement.middle.x"] == pytest.approx(state.at([(0.03, 0.03, 0.03)])[0, 0], rel=1e-6), label
        assert value["force.top.x"] == pytest.approx(state.reactions["top"][0, 0], rel=1e-6), label
    for nu in (0, 0.499):  # what no load holds of a held patch is free
        both, foot_only = (sp.Model("hybmss_avg", body, sp.Material(1e4, nu), cut=True, held=held) for held in (["foot", "top"], ["foot"]))
        pushed = both.solve([loads[0], sp.Displacement("top", (0.001, None, None))]).reactions["top"][0]
        assert abs(pushed[1:]).max() < 1e-6 * abs(pushed[0])
        bent = [model.solve([loads[0], sp.Force("top", (0.01, 0, 0))]).at([(0.03, 0.03, 0.03)]) for model in (both, foot_only)]
        assert bent[0] == pytest.approx(bent[1], rel=1e-6)
    with pytest.raises(sp.InputError, match=r"\d % off these, averaged springs .* %, which is not worth it"):
        sp.Model("hybmss_avg", body, sp.Material(1e4, 0.3), cut=True, held=["foot"], coarsened=True)
    with pytest.raises(sp.InputError, match="coarsened: is for cut cells"):
        sp.Model("hybmss_avg", body, sp.Material(1e4, 0.3), coarsened=True)
    with pytest.raises(sp.InputError, match="no file 'rabit.geo' .*rabbit.geo"):
        sp.voxels("rabit.geo", size=(1, 1, 1))
    with pytest.raises(sp.InputError, match="foot"):
        sp.Model("hybmss_avg", body, sp.Material(1e4, 0.4), cut=True, held=["feet"])


def test_measured_cells_are_those_of_compare():
    """A bracket two cells thick, which averaged springs bend too little."""
    size = (0.1, 0.05, 0.1)
    rows = sp.compare({
        "name": "bracket",
        "expect": [{"model": "measured", "measure": "displacement.tip.z", "source": "analytic", "value": 0, "within": 1, "where": "it is finite"}],
        "body": {"geo": "l_bracket.geo", "size_m": list(size), "voxel_edge_m": 0.01},
        "material": {"youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3},
        "load": [{"on": "wall", "displacement_m": [0, 0, 0]}, {"on": "end", "force_N": [0, 0, -0.01]}],
        "probe": [{"name": "tip", "at_m": [0.09, 0.025, 0.005]}],
        "compare": {"models": [{"model": "hybmss_avg", "coarsened": True, "label": "measured"}], "measures": ["probe"]},
        "reference": {"elements": []}})
    body = sp.voxels("l_bracket.geo", size=size, edge=0.01)
    model = sp.Model("hybmss_avg", body, sp.Material(1e6, 0.3), cut=True, held=["wall"], coarsened=True)
    state = model.solve([sp.Displacement("wall"), sp.Force("end", (0, 0, -0.01))])
    value = {row["measure"]: row["value"] for row in rows}
    assert state.at([(0.09, 0.025, 0.005)])[0, 2] == pytest.approx(value["displacement.tip.z"], rel=1e-6)


def affine(body, material, loads):
    """The tip of a bar in tension, as it were."""
    return body.nodes * [1e-3 * material.nu, 0, 0]


def test_a_function_is_a_model():
    """It is called for each Poisson's ratio with the body in tetrahedra, the material and the loads; its displacements are a row."""
    calls = []

    def mine(body, material, loads):
        calls.append(material.nu)
        X, tets = body.nodes, body.tetrahedra
        volumes = np.linalg.det(X[tets[:, 1:]] - X[tets[:, :1]]) / 6
        assert np.abs(volumes).sum() == pytest.approx(0.2 * 0.1 * 0.1) and material.density == 1100
        assert (X[body.patches["x_min"], 0] == 0).all() and len(body.patches["x_min"]) >= 9
        assert loads.forces.sum(0) == pytest.approx([0, 0, -0.1]) and (X[np.abs(loads.forces).sum(1) > 0, 0] == 0.2).all()
        held = ~np.isnan(loads.displacement).any(1)
        assert sorted(np.flatnonzero(held)) == sorted(body.patches["x_min"]) and (loads.displacement[held] == 0).all()
        return affine(body, material, loads)

    rows = sp.compare(CASE, models={"mine": mine})
    assert calls == [0.25, 0.4]
    for nu in (0.25, 0.4):
        own = {row["measure"]: row for row in rows if row["model"] == "mine" and row["poisson_ratio"] == nu}
        assert own["displacement.tip.x"]["value"] == pytest.approx(0.2e-3 * nu, rel=1e-12)
        assert own["volume_change"]["value"] == pytest.approx(1e-3 * nu, rel=1e-6)  # known at every node of the lattice


def test_a_function_on_its_own_nodes_in_a_case_file_and_a_body(tmp_path):
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]) * 0.1
    text = "solid t\n"
    for facet in ((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)):
        text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corners[i]) for i in facet) + "endloop\nendfacet\n"
    (tmp_path / "t.stl").write_text(text + "endsolid t\n")
    case = tmp_path / "own.toml"
    case.write_text("""
[body]
geo = "t.stl"
voxels = [100, 300]
[[patch]]
name = "foot"
beyond = { point_m = [0, 0, 0.005], normal = [0, 0, -1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "foot"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[probe]]
name = "middle"
at_m = [0.03, 0.03, 0.03]
[compare]
models = ["hybmss_avg"]
measures = ["probe"]
[reference]
elements = []
""")

    def mine(body, material, loads):
        points = np.vstack([body.nodes, body.nodes[body.tetrahedra].mean(1)])
        weight = loads.forces[:, 2].sum()
        assert weight == pytest.approx(-9.81 * 1000 * 0.1**3, rel=1e-6) and len(body.patches["foot"]) > 5
        return points, 1e-3 * points

    rows = [row for row in sp.compare(case, models={"mine": mine}) if row["model"] == "mine"]
    assert next(row["value"] for row in rows if row["measure"] == "displacement.middle.x") == pytest.approx(3e-5, rel=1e-3)


def test_what_a_function_raises_reaches_the_caller():
    class Mine(Exception):
        pass

    def fails(body, material, loads):
        raise Mine("no solver")

    with pytest.raises(Mine, match="no solver"):
        sp.compare(CASE, models={"mine": fails})
    with pytest.raises(sp.InputError, match=r"models: 'mine': its displacements have shape \(3,\) \(allowed: \(45, 3\)"):
        sp.compare(CASE, models={"mine": lambda body, material, loads: np.zeros(3)})
    with pytest.raises(sp.InputError, match="models: 'mine': its displacements at row 0 are not finite"):
        sp.compare(CASE, models={"mine": lambda body, material, loads: np.nan * body.nodes})
    with pytest.raises(sp.InputError, match="the label 'hybmss_avg' is taken"):
        sp.compare(CASE, models={"hybmss_avg": affine})
    with pytest.raises(sp.InputError, match="folder of 5 cases"):
        sp.compare("golec_2019", models={"mine": affine})
    with pytest.raises(sp.InputError, match="no such case"):
        sp.compare("golec_2020", models={"mine": affine})


def test_identify_returns_what_the_program_writes():
    case = {
        **{key: value for key, value in CASE.items() if key != "expect"},
        "material": {"youngs_modulus_Pa": 2e4, "poisson_ratio": 0.25, "density_kg_m3": 1100},
        "compare": {"models": ["hybmss_avg"], "measures": ["probe"]},
        "measured": [{"source": "here", "licence": "none", "values": [{"name": "sag", "quantity": "displacement.tip.z", "value": -0.004, "u": 1e-4}]}],
        "identify": [{"name": "modulus", "parameters": [{"of": "material.youngs_modulus_Pa"}], "fit": ["sag"]}],
    }
    (found,) = sp.identify(case, only="modulus", start=[3e4])
    E = found["parameters"][0]["value"]
    bar = sp.Model("hybmss_avg", sp.block((0.2, 0.1, 0.1), (4, 2, 2)), sp.Material(E, 0.25, density=1100))
    sag = bar.solve([sp.Displacement("x_min"), sp.Force("x_max", (0, 0, -0.1))]).at([(0.2, 0.05, 0.05)])[0, 2]
    assert sag == pytest.approx(-0.004, rel=1e-3)
    assert found["parameters"][0]["u"] == pytest.approx(E * 1e-4 / 0.004, rel=0.05)
    with pytest.raises(sp.InputError, match="no .*identify.* of the case"):
        sp.identify(case, only="mass")
