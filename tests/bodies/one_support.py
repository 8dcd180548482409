#!/usr/bin/env python3
"""One support: how far a held body hangs, at rest, settled in motion, and by two programs that have its springs file alone.

usage: one_support.py FOLDER SPRINGPROOF EXAMPLES C_COMPILER [NAME...]

A sheet one cell thick, an organ, a rabbit and a block, in averaged springs under Hencky's law and their own weight.  Prints
where a point of each comes to rest: by `springproof compare` in equilibrium and as the end of a damped motion, by NumPy
(hang_springs.py) and by C (springproof_forces.h, in steps until it rests), and beside them by finite elements.  Fails if the
first four differ by more than 0.1 %.
"""

import ctypes
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from ten_bodies import organ, outward, write_stl

CASE = """what = "A {name} hangs under its weight."
kinematics = "hencky"

[body]
{body}

{held}
[material]
youngs_modulus_Pa = 8e6
poisson_ratio = 0.45
density_kg_m3 = 1000

[[load]]
on = "{on}"
displacement_m = [0, 0, 0]

[[load]]
gravity_m_s2 = [0, 0, -9.81]

[[probe]]
name = "P"
at_m = {probe}

[compare]
models = ["hybmss_avg"]
measures = ["probe"]

[reference]
{reference}

[dynamics]
duration_s = {duration}
damping_1_s = {damping}
frames = 0
samples = 2
"""

PATCH = """[[patch]]
name = "hold"
beyond = {{ point_m = {}, normal = {} }}
"""


def sheet():
    """40 x 10 x 0.75 mm."""
    points = [(x, y, z) for z in (0, 7.5e-4) for y in (0, 0.01) for x in (0, 0.04)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [tuple(points[i] for i in t) for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


# Body (a function that makes its facets, or the lines of [body]), its cells, what holds it, the probe, [reference], and
# the duration [s] and damping [1/s] of the motion.
BODIES = {
    "sheet": (sheet, "voxel_edge_m = 1e-3", PATCH.format([1e-6, 0, 0], [-1, 0, 0]), "hold", [0.0395, 0.005, 3.75e-4],
              "edge_m = 1e-3", 0.4, 85),
    "organ": (organ, "voxels = 1500", PATCH.format([0, 0, -0.03], [0, 0, -1]), "hold", [0.02, 0.01, 0.005], "edge_m = 0.01",
              0.05, 1500),
    "rabbit": ('geo = "rabbit.geo"\nsize_m = [0.2, 0.12, 0.25]', "voxels = 1500", "", "feet", [0.15, 0.06, 0.16],
               "edge_m = 0.02", 0.4, 200),
    "block": ('geo = "block.geo"\nsize_m = [0.1, 0.05, 0.05]', "cells = [[16, 8, 8]]", "", "x_min", [0.1, 0.025, 0.025],
              "cells = [16, 8, 8]", 0.1, 600),
}


def write(folder, name):
    body, cells, patch, on, probe, reference, duration, damping = BODIES[name]
    if callable(body):
        write_stl(folder / f"{name}.stl", outward(body()))
        body = f'geo = "{name}.stl"'
    text = CASE.format(name=name, body=body + "\n" + cells, held=patch, on=on, probe=probe, reference=reference, duration=duration,
                       damping=damping)
    (folder / f"{name}.toml").write_text(text)


def by_compare(program, folder, name):
    """At rest, settled, finite elements and their uncertainty [m]: the length of the probe's displacement."""
    out = folder / "reports" / name
    subprocess.run([program, "compare", folder / f"{name}.toml", "--out", out], check=True, capture_output=True)
    case = json.loads((out / "results.json").read_text())["cases"][0]
    value = {r["model"]: r["value"] for r in case["rows"] if r["measure"] == "displacement.P.magnitude"}
    reference = next(r for r in case["references"] if r["measure"] == "displacement.P.magnitude")
    return value["hybmss_avg"], value["hybmss_avg in motion"], reference["value"], reference["uncertainty"]


class Parts(ctypes.Structure):
    _fields_ = [(key, ctypes.c_void_p) for key in ("fraction", "mean", "mixed", "variance")]


class Law(ctypes.Structure):
    keys = ("shear_modulus_Pa", "lame_lambda_Pa", "bending", "coupling", "torsion", "twist", "warping")
    _fields_ = [("curve", ctypes.c_int)] + [(key, ctypes.c_double) for key in keys]


class Body(ctypes.Structure):
    _fields_ = ([(key, ctypes.c_size_t) for key in ("nodes", "cells", "anchors", "held")]
                + [(key, ctypes.c_void_p) for key in ("mass", "weight", "corners")] + [("edge", ctypes.c_double)]
                + [("parts", Parts), ("law", Law)]
                + [(key, ctypes.c_void_p) for key in ("anchored", "weights", "k", "points", "fixed")])


def by_c(library, s, on, duration, damping):
    """Positions at the end of a damped motion, n x 3 [m]."""
    kept = []  # alive while C has the pointers

    def pointer(values, kind=np.float64):
        kept.append(np.ascontiguousarray(values, kind))
        return kept[-1].ctypes.data

    nodes, cells, law = s["nodes"], s["cells"], s["laws"]["averaged_springs"]
    anchors, x = s.get("anchors", {}).get(on), nodes["position_m"].copy()
    weight = nodes.get("weight_kg", nodes["mass_kg"])
    body = Body(nodes=len(x), cells=len(cells["nodes"]), mass=pointer(nodes["mass_kg"]), weight=pointer(weight),
                corners=pointer(cells["nodes"], np.int32), edge=cells["edge_m"],
                law=Law(0, *(law[key] for key in Law.keys)))
    if "fraction" in cells:
        body.parts = Parts(**{key: pointer(cells[key]) for key, _ in Parts._fields_})
    if anchors:
        body.anchors, body.anchored, body.weights = len(anchors["nodes"]), pointer(anchors["nodes"], np.int32), pointer(anchors["weights"])
        body.k, body.points = pointer(anchors["stiffness_N_m"]), pointer(anchors["position_m"])
    else:
        body.held, body.fixed = len(s["patches"][on]), pointer(s["patches"][on], np.int32)
    dt, room = 0.9 * s["derived"]["safe_time_step_s"], [np.zeros(len(x)), np.zeros(x.shape), np.zeros(x.shape)]
    library.settle.restype = ctypes.c_double
    left = library.settle(ctypes.byref(body), (ctypes.c_double * 3)(0, 0, -9.81), ctypes.c_double(dt), ctypes.c_double(damping),
                          ctypes.c_long(round(duration / dt)), x.ctypes.data_as(ctypes.c_void_p),
                          *(r.ctypes.data_as(ctypes.c_void_p) for r in room))
    if not left < 1e-6:
        sys.exit(f"not at rest: {left:.1e} of the largest kinetic energy is left")
    return x


def main(folder, program, examples, compiler, *names):
    sys.path.insert(0, str(examples))
    from hang_springs import embed, load, rest
    folder.mkdir(parents=True, exist_ok=True)
    shared = folder / "settle.so"
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-I", examples, "-o", shared, Path(__file__).parent / "settle.c", "-lm"],
                   check=True)
    library, failed = ctypes.CDLL(str(shared)), False
    print("body         at rest    settled      NumPy          C  largest difference  finite elements [um]")
    for name in names or BODIES:
        write(folder, name)
        at_rest, settled, fem, uncertainty = by_compare(program, folder, name)
        file = folder / f"{name}.json"
        subprocess.run([program, "export", folder / f"{name}.toml", "--to", "springs", "--out", file], check=True, capture_output=True)
        s, (_, _, _, on, probe, _, duration, damping) = load(str(file)), BODIES[name]
        corners, weights = embed(s, np.array([probe]))
        hangs = lambda x: np.linalg.norm(weights[0] @ (x - s["nodes"]["position_m"])[corners[0]])
        share = s["nodes"].get("weight_kg", s["nodes"]["mass_kg"])
        by_numpy = hangs(rest(s, on, np.outer(share, [0, 0, -9.81]), say=lambda _: None))
        by_c_alone = hangs(by_c(library, s, on, duration, damping))
        four = [at_rest, settled, by_numpy, by_c_alone]
        apart = max(four) / min(four) - 1
        failed |= not apart < 1e-3
        print(f"{name:8}", *(f"{1e6 * u:10.5f}" for u in four), f"{100 * apart:16.4f} %  {1e6 * fem:.5f} +- {1e6 * uncertainty:.2g}", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:4]), *sys.argv[4:]))
