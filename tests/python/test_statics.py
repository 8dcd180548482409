"""Materials, bodies, models, equilibrium."""
import itertools

import numpy as np
import pytest
import springproof as sp

RUBBER = sp.Material(E=1e5, nu=0.4, density=1100)


def body_for(name):
    if "hexagonal" in name or name == "kirkwood":
        return sp.block((0.4, 0.2, 0.1), (4, 2, 1))
    return sp.block((0.4, 0.2, 0.2), (8, 4, 4))


def test_any_two_moduli_give_the_material():
    wanted = {key: getattr(RUBBER, key) for key in ("E", "nu", "G", "K", "lame_lambda")}
    for pair in itertools.combinations(wanted, 2):
        made = sp.Material(**{key: wanted[key] for key in pair}, density=1100)
        assert {key: getattr(made, key) for key in wanted} == pytest.approx(wanted), pair
    for wrong in ({"E": 1e5}, {"E": 1e5, "nu": 0.5}, {"E": 1e5, "nu": 0.4, "G": 1e4}, {"E": 1e5, "nu": 0.4, "density": -1}):
        with pytest.raises(sp.InputError, match="allowed|exactly two|given"):
            sp.Material(**wrong)
    assert issubclass(sp.InputError, ValueError)


def test_the_bar_of_the_tutorial_bends_as_from_cpp():
    bar = sp.block(size=(0.06, 0.01, 0.01), cells=(24, 4, 4))
    model = sp.Model("hybmss_bt", bar, sp.Material(E=1e6, nu=0.49, density=1100))
    state = model.solve([sp.Displacement("x_min"), sp.Force("x_max", (0, 0, -0.005))])
    tip = state.body_displacement[bar.patches["x_max"], 2].mean()
    assert f"{1e3 * tip:.4f}" == "-0.4207"  # docs/tutorial.md, printed by examples/embed_msm.cpp
    force, torque = state.reactions["x_min"]
    np.testing.assert_allclose(force, [0, 0, 0.005], atol=1e-10)
    np.testing.assert_allclose(torque, [0, -0.005 * 0.06, 0], atol=1e-10)
    np.testing.assert_allclose(state.support.sum(axis=0), force, atol=1e-10)
    assert state.residual < 1e-9 and "multigrid" in state.solver


def test_masses_on_a_body_weigh_and_are_inertia():
    bar = sp.block(size=(0.4, 0.1, 0.1), cells=(8, 2, 2))
    weights = [sp.Mass(2, (0.4, 0.05, 0.05)), sp.Mass(1, [(0.4, 0, 0), (0.4, 0.1, 0)]), sp.Mass(3, on="x_max", weighs=False)]
    model = sp.Model("hybmss_avg", bar, RUBBER, masses=weights)
    assert model.masses.sum() == pytest.approx(1100 * 0.004 + 6)
    state = model.solve([sp.Displacement("x_min"), sp.Gravity((0, 0, -10))])
    np.testing.assert_allclose(state.reactions["x_min"][0], [0, 0, (1100 * 0.004 + 3) * 10], atol=1e-8)
    free, light = model.motion(forces=np.ones(model.positions.shape)), sp.Model("hybmss_avg", bar, RUBBER)
    free.step(10)
    assert (model.masses @ free.velocities)[0] == pytest.approx((free.time - free.time_step / 2) * len(model.positions))
    assert model.safe_time_step >= light.safe_time_step
    for wrong in ({"mass": 0, "at": (0, 0, 0)}, {"mass": 1}, {"mass": 1, "at": (0, 0, 0), "on": "x_max"}):
        with pytest.raises(sp.InputError, match="allowed"):
            sp.Mass(**wrong)
    with pytest.raises(sp.InputError, match="mass"):
        sp.Model("hybmss_avg", bar, RUBBER, masses=[sp.Mass(1, (9, 0, 0))])


@pytest.mark.parametrize("name", [row["name"] for row in sp.models()])
def test_every_model_of_the_table_carries_its_load(name):
    model = sp.Model(name, body_for(name), RUBBER)
    assert np.isclose(model.masses.sum(), 1100 * np.prod(body_for(name).nodes.max(axis=0)))
    X, rng = model.positions, np.random.default_rng(1)
    assert abs(model.forces(X)).max() < 1e-6 * 1e5 * 0.04
    # Forces are the gradient of the energy.
    x, h = X + 1e-3 * rng.uniform(-1, 1, X.shape), 1e-7
    p = rng.uniform(-1, 1, X.shape)
    slope = (model.energy(x + h * p) - model.energy(x - h * p)) / (2 * h)
    assert slope == pytest.approx(-(model.forces(x) * p).sum(), rel=1e-5)
    state = model.solve([sp.Displacement("x_min"), sp.Displacement("x_max", (0.01, 0, 0))])
    pull = state.reactions["x_max"][0]
    np.testing.assert_allclose(pull, -state.reactions["x_min"][0], atol=1e-7 * abs(pull).max())
    assert 0.5 < pull[0] / (1e5 * 0.025 * np.prod(body_for(name).nodes.max(axis=0)[1:])) < 3


def test_options_of_a_model_and_errors_have_the_programs_text():
    body = body_for("hybmss")
    A1 = sp.Model("hybmss", body, RUBBER, face_to_cube=1, volume_energy="paper")
    assert not np.allclose(A1.springs["stiffness"], sp.Model("hybmss", body, RUBBER).springs["stiffness"])
    seeds = [sp.Model("msm_random", body, RUBBER, seed=seed).positions for seed in (1, 1, 2)]
    assert np.array_equal(seeds[0], seeds[1]) and not np.array_equal(seeds[0], seeds[2])
    for name, options, text in (("hybmss_bd", {}, r"models: unknown model 'hybmss_bd' \(allowed: msm_18, .*did you mean 'hybmss_"),
                                ("hybmss", {"face_to_cubes": 1}, "hybmss: unknown option 'face_to_cubes' .*did you mean 'face_to_cube'"),
                                ("hybmss", {"volume_energy": "linear"}, 'must be "paper" or "bounded"'),
                                ("hybmss", {"cut": True}, "cut = True: the body is a block")):
        with pytest.raises(sp.InputError, match=text):
            sp.Model(name, body, RUBBER, **options)
    with pytest.raises(sp.InputError, match="cells are"):
        sp.Model("hybmss", sp.block((1, 1, 1), (2, 2, 3)), RUBBER)


def test_held_nodes_are_a_support_and_forces_a_load():
    body = body_for("hybmss_avg")
    model = sp.Model("hybmss_avg", body, RUBBER)
    force = (0.1, 0.2, -0.3)
    by_patch = model.solve([sp.Displacement("x_min", (1e-3, None, 0)), sp.Displacement("y_min", (None, 0, None)), sp.Force("x_max", force)])
    nodes = np.zeros(model.positions.shape)
    end, area = body.patches["x_max"], np.zeros(len(nodes))
    for y in range(4):
        for z in range(4):  # a quarter of each facet to its corners
            near = (abs(body.nodes[end, 1] - 0.05 * (y + 0.5)) < 0.03) & (abs(body.nodes[end, 2] - 0.05 * (z + 0.5)) < 0.03)
            area[end[near]] += 1 / 64
    nodes += area[:, None] * force
    held = np.concatenate([body.patches["x_min"], body.patches["y_min"]])
    u = np.full((len(held), 3), np.nan)
    u[: len(body.patches["x_min"]), [0, 2]] = (1e-3, 0)
    u[len(body.patches["x_min"]):, 1] = 0
    by_node = model.solve(held=held, displacement=u, forces=nodes)
    np.testing.assert_allclose(by_node.displacement, by_patch.displacement, atol=1e-9)
    flags = np.zeros(len(nodes), bool)
    flags[body.patches["x_min"]] = True
    np.testing.assert_allclose(model.solve(held=flags, forces=nodes).displacement,
                               model.solve([sp.Displacement("x_min"), sp.Force("x_max", force)]).displacement, atol=1e-9)


def test_what_cannot_be_solved_says_why():
    model = sp.Model("hybmss_bt", body_for("hybmss_bt"), RUBBER)
    n = len(model.positions)
    for call, text in ((lambda: model.solve([sp.Force("x_max", (1, 0, 0))]), "rigid|free"),
                       (lambda: model.solve([sp.Displacement("left")]), r"left.*x_min"),
                       (lambda: model.solve([sp.Displacement("x_min")], large=True), "holds under small displacements only.*allowed: msm_18.*hybmss_avg"),
                       (lambda: model.solve(held=[n]), rf"held: node {n} \(allowed: 0 to {n - 1}\)"),
                       (lambda: model.solve(held=[0.5]), "held: is no list of nodes"),
                       (lambda: model.solve(held=[0], displacement=(0, 0)), r"displacement: has shape \(2,\) \(allowed: three numbers\)"),
                       (lambda: model.solve(forces=np.zeros((n, 2))), rf"forces: has shape \({n}, 2\) \(allowed: \({n}, 3\)\)"),
                       (lambda: model.forces(np.zeros((n + 1, 3))), "positions: has shape"),
                       (lambda: model.solve(held=[0], displacement=(np.inf, 0, 0)), "displacement: a number is infinite"),
                       (lambda: sp.Force("x_max", (np.nan, 0, 0)), "force: a number is not finite"),
                       (lambda: sp.Displacement("x_max", (np.nan, None, 0)), "displacement: a number is not finite"),
                       (lambda: sp.Rotation("x_max", (0, 0, 0), (0, 0, 1), np.inf), "angle: a number is not finite"),
                       (lambda: sp.Pressure("x_max", np.nan), "pressure: a number is not finite"),
                       (lambda: sp.Gravity((0, 0, np.nan)), "acceleration: a number is not finite"),
                       (lambda: sp.PointForce((np.inf, 0, 0), (0, 0, 1)), "at: a number is not finite")):
        with pytest.raises(sp.InputError, match=text):
            call()


def test_a_body_turned_by_large_displacements_has_no_strain():
    bar = sp.block((0.2, 0.1, 0.1), (4, 2, 2))
    model = sp.Model("hybmss_avg", bar, RUBBER)
    turn = dict(point=(0, 0, 0), axis=(0, 0, 1), angle=np.pi / 2)
    state = model.solve([sp.Rotation("x_min", **turn), sp.Rotation("x_max", **turn)], large=True)
    x = model.positions + state.displacement
    np.testing.assert_allclose(x, model.positions[:, [1, 0, 2]] * (-1, 1, 1), atol=1e-9)
    assert model.energy(x) < 1e-12 and abs(state.volume_change) < 1e-9
    # A compression beyond what any solid bears.
    with pytest.raises(sp.SolveError, match="hybmss_avg: "):
        model.solve([sp.Displacement("x_min"), sp.Displacement("x_max", (-0.25, 0, 0))], large=True)


def test_moduli_measured_back():
    h = sp.homogenise("hybmss_avg", RUBBER)
    assert h["E"] == pytest.approx(1e5, rel=1e-6) and h["nu"] == pytest.approx(0.4, rel=1e-6) and h["C"].shape == (6, 6)
    assert h["C"][0, 0] == pytest.approx(RUBBER.lame_lambda + 2 * RUBBER.G, rel=1e-6)
    random = sp.homogenise("msm_random", sp.Material(E=1e5, nu=0.25), nodes=343, seed=3)
    assert random["E"] == pytest.approx(1e5, rel=0.05) and random["nodes"] != h["nodes"]
    m = sp.measure_moduli("hybmss", RUBBER)
    assert (m["E"], m["nu"], m["G"]) == pytest.approx((1e5, 0.4, RUBBER.G), rel=1e-6)
    with pytest.raises(sp.InputError):
        sp.homogenise("kirkwood", RUBBER)
