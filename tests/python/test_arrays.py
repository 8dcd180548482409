"""Arrays without copies, and springs files."""
import gc
import json
import sys
import weakref

import numpy as np
import pytest
import springproof as sp

RUBBER = sp.Material(E=1e5, nu=0.4, density=1100)


@pytest.fixture
def model():
    return sp.Model("hybmss", sp.block((0.2, 0.1, 0.1), (4, 2, 2)), RUBBER)


def address(array):
    return array.__array_interface__["data"][0]


def test_views_are_of_one_memory_and_keep_it(model):
    n, s = 5 * 3 * 3, len(model.springs)
    shapes = {"positions": (n, 3), "masses": (n,), "springs": (s,), "cells": (16, 8)}
    for name, shape in shapes.items():
        first, second = getattr(model, name), getattr(model, name)
        assert first.shape == shape and address(first) == address(second) and first.base is model, name
        assert not first.flags.writeable and first.flags.c_contiguous
        with pytest.raises(ValueError):
            first.ravel()[0] = first.ravel()[1]
    assert model.springs.dtype.names == ("i", "j", "stiffness", "rest_length")
    ends = model.positions[model.springs["j"]] - model.positions[model.springs["i"]]
    np.testing.assert_allclose(np.linalg.norm(ends, axis=1), model.springs["rest_length"])
    assert address(model.positions) != address(model.positions.copy())


def test_an_array_outlives_what_it_was_read_from():
    def made():
        model = sp.Model("hybmss", sp.block((0.2, 0.1, 0.1), (4, 2, 2)), RUBBER)
        motion = model.motion([sp.Gravity((0, 0, -9.81))])
        motion.step(3)
        state = model.solve([sp.Displacement("x_min"), sp.Gravity((0, 0, -9.81))])
        return model.positions, motion.positions, state.displacement, model.positions.copy(), motion.positions.copy(), state.displacement.copy()

    *views, rest, moved, displaced = made()
    gc.collect()
    waste = [np.random.rand(len(rest), 3) for _ in range(100)]  # would fall on freed memory
    for view, copy in zip(views, (rest, moved, displaced)):
        assert np.array_equal(view, copy)
    assert len(waste) == 100
    state = views[2]
    assert sys.getrefcount(state.base) <= 3


def test_a_model_dies_with_its_last_array(model):
    class Kept(np.ndarray):
        pass

    view = model.positions.view(Kept)
    count = sys.getrefcount(model)
    del view
    gc.collect()
    assert sys.getrefcount(model) == count - 1
    view = model.positions.view(Kept)
    gone = weakref.ref(view)
    del view
    gc.collect()
    assert gone() is None


def test_the_state_of_a_motion_is_one_memory_renewed_when_read(model):
    motion = model.motion([sp.Gravity((0, 0, -9.81))])
    x, v = motion.positions, motion.velocities
    rest = x.copy()
    motion.step(4)
    assert address(motion.positions) == address(x) and address(motion.velocities) == address(v)
    assert x[0, 2] < rest[0, 2] and v[0, 2] < 0  # the same memory, so the earlier view too
    assert not x.flags.writeable


@pytest.mark.parametrize("name", ["hybmss", "hybmss_bt", "hybmss_avg", "emsm", "emsm_random", "kirkwood"])
@pytest.mark.parametrize("ending", ["json", "npz"])
def test_springs_files_hold_the_model(tmp_path, name, ending):
    body = sp.block((0.2, 0.1, 0.05), (4, 2, 1)) if name == "kirkwood" else sp.block((0.2, 0.1, 0.1), (4, 2, 2))
    model = sp.Model(name, body, RUBBER)
    file = tmp_path / f"springs.{ending}"
    model.write(file)
    back = sp.read_springs(file)
    x = model.positions + 1e-3 * np.random.default_rng(2).uniform(-1, 1, model.positions.shape)
    if name == "kirkwood":
        x[:, 2] = model.positions[:, 2]
    np.testing.assert_allclose(back.forces(x), model.forces(x), rtol=1e-9, atol=1e-9 * abs(model.forces(x)).max())
    assert back.safe_time_step == pytest.approx(model.safe_time_step)
    assert (back.density, back.material.nu, back.name) == (1100, 0.4, str(file))
    assert {key: list(value) for key, value in back.patches.items()} == {key: list(value) for key, value in model.patches.items()}
    np.testing.assert_allclose(back.masses, model.masses)
    again = tmp_path / f"again.{ending}"
    back.write(again)
    np.testing.assert_allclose(sp.read_springs(again).forces(x), back.forces(x))
    held = back.solve(held=back.patches["x_min"], forces=back.masses[:, None] * (0, 0 if name == "kirkwood" else -9.81, 0)) if name != "kirkwood" else None
    assert held is None or held.displacement.shape == x.shape
    with pytest.raises(sp.InputError, match="have no body"):
        back.solve([sp.Displacement("x_min")])


def test_a_file_states_what_engines_need(tmp_path, model):
    model.write(tmp_path / "springs.json")
    tree = json.loads((tmp_path / "springs.json").read_text())
    assert tree["derived"]["safe_time_step_s"] == pytest.approx(model.safe_time_step)
    assert len(tree["surface"]["facets"]) == 2 * 2 * (4 * 2 + 4 * 2 + 2 * 2) and tree["check"]["force_N"]
    assert tree["origin"]["model"] == "hybmss"
    model.write(tmp_path / "springs.vtu")
    assert (tmp_path / "springs.vtu").stat().st_size > 500


def test_files_that_cannot_be_used_are_refused(tmp_path, model):
    model.write(tmp_path / "good.json")
    model.write(tmp_path / "good.npz")
    tree = json.loads((tmp_path / "good.json").read_text())
    tree["nodes"]["mass_kg"][0] = 0
    (tmp_path / "bad.json").write_text(json.dumps(tree))
    (tmp_path / "bad.npz").write_bytes((tmp_path / "good.npz").read_bytes()[:1000])
    for name, text in (("bad.json", r"bad.json: /nodes/mass_kg/0: is 0(\.0)? \(allowed: a finite number"), ("none.json", "none.json: no such file"),
                       ("bad.npz", "bad.npz: is no springs file"), ("springs.txt", "allowed: .json, .npz")):
        with pytest.raises(sp.InputError, match=text):
            sp.read_springs(tmp_path / name)
    with pytest.raises(sp.InputError, match="ends in .json, .npz or .vtu"):
        model.write(tmp_path / "springs.txt")
    assert not (tmp_path / "springs.txt").exists()


def test_files_for_paraview(tmp_path, model):
    body = sp.block((0.2, 0.1, 0.1), (4, 2, 2))
    u = 1e-3 * body.nodes
    sp.write_vtu(tmp_path / "a.vtu", body, u, velocity=2 * u)
    text = (tmp_path / "a.vtu").read_bytes()
    assert all(word in text for word in (b'Name="displacement"', b'Name="velocity"', b"relative_volume_change", b'NumberOfCells="16"'))
    sp.write_pvd(tmp_path / "a.pvd", [(0.5, "a.vtu")])
    assert 'timestep="0.5" file="a.vtu"' in (tmp_path / "a.pvd").read_text()
    with pytest.raises(sp.InputError, match="velocity: has shape"):
        sp.write_vtu(tmp_path / "b.vtu", body, u, velocity=u[1:])
    for write in (lambda file: sp.write_vtu(file, body, u), lambda file: sp.write_pvd(file, [(0.5, "a.vtu")]),
                  lambda file: model.write(file.with_suffix(".json"))):
        with pytest.raises(FileNotFoundError, match="cannot write .*none.*No such file"):
            write(tmp_path / "none" / "a.vtu")
