"""Motion in time, long calls, Ctrl-C."""
import json
import signal
import threading
import time

import numpy as np
import pytest
import springproof as sp

RUBBER = sp.Material(E=1e5, nu=0.4, density=1100)
KERNELS = {"hybmss": "lattice", "hybmss_avg": "lattice", "emsm": "lattice", "msm_random": "list", "emsm_random": "list", "emsm_patch": "list"}


def model_of(name):
    return sp.Model(name, sp.block((0.2, 0.1, 0.1), (8, 4, 4)), RUBBER)


@pytest.mark.parametrize("name", KERNELS)
def test_steps_are_those_of_semi_implicit_euler(name):
    model = model_of(name)
    loads = [sp.Force("x_max", (0, 0, -0.2)), sp.Gravity((0, -9.81, 0))]
    motion = model.motion([sp.Displacement("x_min"), *loads], damping=3)
    pushed = model.motion(loads)
    pushed.step()
    load = 2 * pushed.velocities * model.masses[:, None] / pushed.time_step  # from rest, half a step later: f = m v / (dt / 2)
    np.testing.assert_allclose(load.sum(axis=0), (0, -9.81 * model.masses.sum(), -0.2), rtol=1e-9, atol=1e-9)
    x, dt = model.positions.copy(), motion.time_step
    free = np.ones((len(x), 1))
    free[model.patches["x_min"]] = 0
    v = -free * dt / 2 * load / model.masses[:, None]  # half a step before the positions
    for _ in range(25):
        v = free * (v + dt * (model.forces(x) + load) / model.masses[:, None]) / (1 + 3 * dt)
        x = x + dt * v
    motion.step(25)
    scale = abs(x - model.positions).max()
    np.testing.assert_allclose(motion.positions, x, atol=1e-9 * scale)
    np.testing.assert_allclose(motion.velocities, v, atol=1e-9 * abs(v).max())
    np.testing.assert_allclose(motion.forces, model.forces(x), atol=1e-9 * abs(motion.forces).max())
    assert motion.kinetic_energy == pytest.approx(0.5 * (model.masses[:, None] * v**2).sum())
    assert motion.elastic_energy == pytest.approx(model.energy(x))
    assert (motion.steps, motion.time) == (25, pytest.approx(25 * dt)) and KERNELS[name] in motion.description


@pytest.mark.parametrize("name", [*KERNELS, "hybmss_fd"])
def test_a_state_that_is_set_goes_on_as_the_first(name):
    model = model_of(name)
    first, second, single = (model.motion([sp.Displacement("x_min"), sp.Gravity((0, 0, -9.81))], damping=2) for _ in range(3))
    first.step(30)
    second.set_state(first.positions, first.velocities)
    first.step(20)
    second.step(20)
    for _ in range(50):
        single.step()
    scale = abs(first.positions - model.positions).max()
    np.testing.assert_allclose(second.positions, first.positions, atol=1e-9 * scale)
    np.testing.assert_allclose(single.positions, first.positions, atol=1e-12 * scale)


@pytest.mark.parametrize("name", [*KERNELS, "hybmss_fd"])
@pytest.mark.parametrize("integrator", ["explicit", "energy_momentum"])
def test_what_is_held_stays_when_a_state_is_set(name, integrator):
    if integrator == "energy_momentum" and name in ("emsm", "emsm_random", "emsm_patch", "hybmss_fd"):
        pytest.skip("explicit only")
    model = model_of(name)
    motion = model.motion([sp.Displacement("x_min", (1e-4, None, 0))], integrator=integrator)
    held, before = model.patches["x_min"], motion.positions.copy()
    motion.set_state(model.positions + 1e-3, np.ones(model.positions.shape))
    for _ in range(2):
        assert np.array_equal(motion.positions[held][:, [0, 2]], before[held][:, [0, 2]])
        assert not motion.velocities[held][:, [0, 2]].any()
        motion.step(3)


def test_energy_is_kept_and_a_free_body_falls():
    model = model_of("hybmss_avg")
    motion = model.motion(held=model.patches["x_min"])
    push = np.zeros(model.positions.shape)
    push[:, 2] = model.positions[:, 0]
    motion.set_state(model.positions, push)
    motion.step()
    energies = []
    for _ in range(50):
        motion.step(10)
        energies.append(motion.kinetic_energy + motion.elastic_energy)
    assert np.ptp(energies) < 0.03 * np.mean(energies)  # of a symplectic method
    falling = model.motion([sp.Gravity((0, 0, -9.81))])
    falling.step(40)
    dt = falling.time_step
    np.testing.assert_allclose(falling.positions - model.positions, np.full((len(push), 1), -9.81 * (40 * dt) ** 2 / 2) * (0, 0, 1), atol=1e-12)
    falling.set_forces(model.masses[:, None] * (0, 0, 9.81))  # beside the load
    v = falling.velocities.copy()
    falling.step(10)
    np.testing.assert_allclose(falling.velocities, v, atol=1e-10)


def test_implicit_steps_and_single_precision():
    model = model_of("hybmss_avg")
    loads = [sp.Displacement("x_min"), sp.Gravity((0, 0, -9.81))]
    fine = model.motion(loads)
    large = model.motion(loads, integrator="energy_momentum", time_step=10 * fine.time_step)
    single = model.motion(loads, float32=True)
    fine.step(200), single.step(200), large.step(int(200 / 10))
    scale = abs(fine.positions - model.positions).max()
    assert abs(single.positions - fine.positions).max() < 1e-3 * scale
    assert abs(large.positions - fine.positions).max() < 0.05 * scale
    with pytest.raises(sp.InputError, match="integrator: is 'rk4'"):
        model.motion(loads, integrator="rk4")


def test_steps_that_are_not_safe_are_refused_and_divergence_is_found():
    model = model_of("hybmss")
    with pytest.raises(sp.InputError, match="time_step_s: .* s is not safe for this model") as refused:
        model.motion(time_step=2 * model.safe_time_step)
    assert f"{model.safe_time_step:.6g}" in str(refused.value)
    with pytest.raises(sp.InputError, match="damping_1_s: must be >= 0"):
        model.motion(damping=-1)
    motion = model.motion()
    with pytest.raises(sp.InputError, match="forces: a number is not finite"):
        motion.set_forces(np.full(model.positions.shape, np.inf))
    motion.set_state(np.full(model.positions.shape, np.nan), np.zeros(model.positions.shape))
    with pytest.raises(sp.SolveError, match="the motion diverged at t = "):
        motion.step(5)


def test_long_calls_leave_the_interpreter_free_and_hear_ctrl_c():
    motion = model_of("hybmss_avg").motion()
    counted, ended = [0], threading.Event()

    def count():
        while not ended.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        motion.step(3)
        before = counted[0]
        signal.setitimer(signal.ITIMER_REAL, 0.5)
        old = signal.signal(signal.SIGALRM, signal.default_int_handler)
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            motion.step(10**9)
        assert time.monotonic() - start < 5
        assert counted[0] - before > 20
        signal.signal(signal.SIGALRM, old)
    finally:
        ended.set()
        counter.join()
    steps = motion.steps
    motion.step()  # as usable as before
    assert motion.steps == steps + 1 > 4


def cells_of_two_sizes(file):
    """A cube of 2 m beside eight of 1 m, full of matter; five nodes of their common face follow its corners."""
    corner = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    origins = [((0, 0, 0), 2)] + [((2 + i, j, k), 1) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    nodes, cells = {}, []
    for origin, edge in origins:
        cells.append([nodes.setdefault(tuple(int(a) for a in np.add(origin, edge * c)), len(nodes)) for c in corner])
    mass = np.zeros(len(nodes))
    for (_, edge), cell in zip(origins, cells):
        mass[cell] += 1000 * edge**3 / 8
    at = lambda y, z: nodes[2, y, z]
    carried = {at(1, 0): (at(0, 0), at(2, 0)), at(1, 2): (at(0, 2), at(2, 2)), at(0, 1): (at(0, 0), at(0, 2)),
               at(2, 1): (at(2, 0), at(2, 2)), at(1, 1): (at(0, 0), at(2, 0), at(0, 2), at(2, 2))}
    for node, by in carried.items():
        for other in by:
            mass[other] += mass[node] / len(by)
        mass[node] = 0
    law = dict(shear_modulus_Pa=4e4, lame_lambda_Pa=6e4, bending=0.5, coupling=0.2, torsion=0.1, twist=0, warping=0.1, shift=0, contraction=0.5, curve="hencky")
    full = dict(fraction=[1.0] * 9, mean=[[0.0] * 3] * 9, mixed=[[0.0] * 3] * 9, variance=[[1 / 12] * 3] * 9)
    json.dump({"format": "springproof springs", "version": 3, "density_kg_m3": 1000, "laws": {"averaged_springs": law},
               "nodes": {"position_m": [list(map(float, x)) for x in nodes], "mass_kg": mass.tolist()},
               "springs": {"nodes": [], "stiffness_N_m": [], "rest_length_m": []},
               "cells": {"nodes": cells, "edge_m": [float(edge) for _, edge in origins], **full},
               "carried": {"nodes": list(carried), "by": [list(by) * (4 // len(by)) for by in carried.values()]}}, open(file, "w"))
    return at(1, 1)


@pytest.mark.parametrize("integrator", ["explicit", "energy_momentum"])
def test_what_pulls_at_a_carried_node_moves_the_body(tmp_path, integrator):
    carried = cells_of_two_sizes(tmp_path / "two.json")
    model = sp.read_springs(tmp_path / "two.json")
    assert model.masses[carried] == 0 and model.masses.sum() == pytest.approx(16000)
    force = np.zeros(model.positions.shape)
    force[carried] = (10, 20, -30)
    motion = model.motion(forces=force, integrator=integrator)
    motion.step(40)
    momentum, behind = model.masses @ motion.velocities, motion.time_step / 2 if integrator == "explicit" else 0
    np.testing.assert_allclose(momentum, np.multiply(motion.time - behind, force[carried]), rtol=1e-8)
    with pytest.raises(sp.InputError, match="follows others"):
        model.motion(held=[carried])


def test_moved_supports_carry_the_support_mass():
    """A body whose weight is what accelerates it with its supports is not strained."""
    body = sp.voxels("sphere.geo", cubes=300, size=(0.2, 0.2, 0.2), patches=[sp.Patch("low", beyond=((0, 0, 0.05), (0, 0, -1)))])
    model = sp.Model("hybmss_avg", body, sp.Material(E=1e5, nu=0.3, density=1000), cut=True, held=["low"])
    motion = model.motion([sp.Displacement("low", (0, 0, -1))], load_factor=0)
    place = lambda k: 1e-8 * max(0, k) ** 3  # of the supports after k steps [m]
    change = lambda k: place(k + 1) - 2 * place(k) + place(k - 1)
    for k in range(60):
        motion.set_load_factor(place(k + 1))
        motion.set_forces(model.masses[:, None] * (0, 0, -change(k) / motion.time_step**2 / place(k + 1)))
        motion.step()
    moved = motion.positions - model.positions
    assert moved[:, 2] == pytest.approx(-place(60), abs=1e-6 * change(59))
    assert motion.elastic_energy < 1e-12 * motion.kinetic_energy
    still = motion.positions.copy()
    motion.set_forces(np.zeros(still.shape))
    motion.step(100)  # the support stops at once: the body swings on
    assert np.abs(motion.positions - still).max() > 10 * change(59)
    with pytest.raises(sp.InputError, match="factor"):
        motion.set_load_factor(float("nan"))
