#!/usr/bin/env python3
"""Ten bodies as a scanner or a CAD program hands them over, and cases of them for `springproof compare`.

usage: ten_bodies.py FOLDER [SPRINGPROOF [NAME...]]

Writes NAME.stl and NAME.toml of each body into FOLDER.  Every body is made of facets: what is computed is the body of
these facets, not the smooth one that they are near.  Lengths in metres.

With the program SPRINGPROOF: compares each case and prints how far its reference is from known.csv, beside this script,
and how far it says that it may be; how many displacements and reactions lie within their uncertainties, and the error of
hybmss_avg.  Fails if less than 95 % of the displacements, or of the reactions, do.

known.csv holds limits of two meshes of quadratic tetrahedra that fill exactly the facets of the file (of bracket and
gear: their plane faces) and differ at the rims of what is held alone, where facets are four times smaller in the finer
one (bar, dumbbell: all cells cut into eight; gear: both).  What is left of the step, or half of it, is the uncertainty.
Reactions follow from the facets by statics.
"""

import csv
import json
import math
import random
import statistics
import struct
import subprocess
import sys
import time
from pathlib import Path


def write_stl(path, triangles):
    with open(path, "wb") as f:
        f.write(b" " * 80 + struct.pack("<I", len(triangles)))
        for a, b, c in triangles:
            f.write(struct.pack("<12f", 0, 0, 0, *a, *b, *c) + b"\0\0")


def six_volumes(triangles):
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
               for a, b, c in triangles)


def outward(triangles):
    return triangles if six_volumes(triangles) > 0 else [(a, c, b) for a, b, c in triangles]


def between(rings):
    """Triangles between rings of points, each of n points or of one."""
    triangles = []
    for lower, upper in zip(rings, rings[1:]):
        for k in range(max(len(lower), len(upper))):
            a, b, c, d = lower[k % len(lower)], lower[(k + 1) % len(lower)], upper[k % len(upper)], upper[(k + 1) % len(upper)]
            triangles += [(a, b, d)] if a != b else []
            triangles += [(a, d, c)] if c != d else []
    return triangles


def revolved(profile, n, twist=0, depth=1):
    """The profile (r, z), from axis to axis, turned about z; twisted [rad/m], and narrower in y by `depth`."""

    def ring(r, z):
        if r < 1e-12:
            return [(0, 0, z)]
        angles = [2 * math.pi * k / n + twist * z for k in range(n)]
        return [(r * math.cos(a), depth * r * math.sin(a), z) for a in angles]

    return between([ring(r, z) for r, z in profile])


def line(p, q, m):
    return [(p[0] + (q[0] - p[0]) * i / m, p[1] + (q[1] - p[1]) * i / m) for i in range(m)]


def arc(centre, radius, start, end, m):
    angles = [start + (end - start) * i / m for i in range(m)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def ears_cut(polygon):
    """Triangles of a polygon, counter-clockwise, by cutting off the corner with the shortest diagonal."""
    left, triangles = list(range(len(polygon))), []

    def turn(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    def holds_another(a, b, c):
        A, B, C = polygon[a], polygon[b], polygon[c]
        return any(min(turn(A, B, polygon[k]), turn(B, C, polygon[k]), turn(C, A, polygon[k])) >= -1e-15
                   for k in left if k not in (a, b, c))

    while len(left) > 3:
        corners = [(left[i - 1], left[i], left[(i + 1) % len(left)]) for i in range(len(left))]
        ears = [t for t in corners if turn(*(polygon[k] for k in t)) > 1e-15 and not holds_another(*t)]
        ear = min(ears, key=lambda t: math.dist(polygon[t[0]], polygon[t[2]]))
        triangles.append(ear)
        left.remove(ear[1])
    return triangles + [tuple(left)]


def extruded(polygon, height):
    n, at = len(polygon), lambda k, z: (polygon[k % n][0], polygon[k % n][1], z)
    ends = ears_cut(polygon)
    return ([(at(a, 0), at(c, 0), at(b, 0)) for a, b, c in ends] + [tuple(at(k, height) for k in t) for t in ends] +
            [(at(k, 0), at(k + 1, 0), at(k + 1, height)) for k in range(n)] +
            [(at(k, 0), at(k + 1, height), at(k, height)) for k in range(n)])


def swept(path, radius, n):
    """A round section along a path in the plane of x and z."""
    rings = []
    for i, (x, z) in enumerate(path):
        a, b = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        length = math.dist(a, b)
        across = ((b[1] - a[1]) / length, (a[0] - b[0]) / length)
        circle = [(radius * math.cos(2 * math.pi * k / n), radius * math.sin(2 * math.pi * k / n)) for k in range(n)]
        rings.append([(x + c * across[0], s, z + c * across[1]) for c, s in circle])
    centre = [[tuple(sum(p[i] for p in ring) / n for i in range(3))] for ring in (rings[0], rings[-1])]
    return between([centre[0], *rings, centre[1]])


def sphere_of_triangles(times):
    """Points and triangles of an icosahedron on the unit sphere, its triangles cut into four so many times."""
    t = (1 + 5**0.5) / 2
    corners = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1),
               (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    unit = lambda p: tuple(x / math.hypot(*p) for x in p)
    points = [unit(p) for p in corners]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                 (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                 (8, 6, 7), (9, 8, 1)]
    for _ in range(times):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                points.append(unit(tuple((points[a][i] + points[b][i]) / 2 for i in range(3))))
                middles[key] = len(points) - 1
            return middles[key]

        for a, b, c in triangles:
            x, y, z = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, x, z), (b, y, x), (c, z, y), (x, y, z)]
        triangles = finer
    return points, triangles


def level_set(values, place, shape):
    """Points and triangles around the grid's points of positive value: each cube is six tetrahedra."""
    tetrahedra = [(0, 1, 3, 7), (0, 1, 7, 5), (0, 5, 7, 4), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7)]
    number, points, triangles = {}, [], []

    def cut(p, q):
        key = (min(p, q), max(p, q))
        if key not in number:
            a, b = values[key[0]], values[key[1]]
            t = min(max(a / (a - b), 0.15), 0.85)
            points.append(tuple(x + t * (y - x) for x, y in zip(place(key[0]), place(key[1]))))
            number[key] = len(points) - 1
        return number[key]

    def add(corners, without):
        a, b, c = (points[k] for k in corners)
        u, v, w = ([y[i] - a[i] for i in range(3)] for y in (b, c, place(without)))
        away = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2]
        triangles.append(corners if away > 0 else (corners[0], corners[2], corners[1]))

    for i in range(shape[0] - 1):
        for j in range(shape[1] - 1):
            for k in range(shape[2] - 1):
                cube = [(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2)) for b in range(8)]
                if len({values[p] > 0 for p in cube}) == 1:
                    continue
                for t in tetrahedra:
                    inside = [cube[c] for c in t if values[cube[c]] > 0]
                    outside = [cube[c] for c in t if values[cube[c]] <= 0]
                    if len(inside) == 1 or len(outside) == 1:
                        add(tuple(cut(p, q) for p in inside for q in outside), outside[0])
                    elif inside and outside:
                        (a, b), (c, d) = inside, outside
                        ring = [cut(a, c), cut(a, d), cut(b, d), cut(b, c)]
                        add((ring[0], ring[1], ring[2]), c)
                        add((ring[0], ring[2], ring[3]), c)
    return points, [t for t in triangles if len(set(t)) == 3]


def smoothed(points, triangles, rounds):
    """Taubin's smoothing: it does not shrink."""
    for step in range(rounds):
        sums = [[0, 0, 0, 0] for _ in points]
        for t in triangles:
            for a in t:
                for b in t:
                    if a != b:
                        sums[a] = [s + x for s, x in zip(sums[a], (*points[b], 1))]
        weight = 0.6 if step % 2 == 0 else -0.5
        points = [tuple(x + weight * (s[i] / s[3] - x) for i, x in enumerate(p)) for p, s in zip(points, sums)]
    return points


def bunny():
    """Blended balls: a trunk, a head, ears of 12 mm across, feet; with a scanner's noise, its feet flat."""
    balls = [(0, 0, 30, 30), (0, 0, 12, 27), (-12, 0, 12, 25), (28, 0, 52, 20), (18, 0, 43, 18), (-36, 0, 18, 10)]
    for side in (1, -1):
        balls += [(24, 10 * side, 78, 7.5), (24, 11 * side, 90, 7.5), (22, 12 * side, 101, 6), (24, 8 * side, 68, 8),
                  (22, 14 * side, -8, 9), (-18, 16 * side, -8, 10)]
    low, step, shape = (-55, -42, -26), 2, (58, 43, 70)
    place = lambda p: tuple(low[i] + p[i] * step for i in range(3))
    field = lambda x: math.log(sum(math.exp(-0.25 * (math.dist(x, b[:3]) - b[3])) for b in balls))
    grid = [(i, j, k) for i in range(shape[0]) for j in range(shape[1]) for k in range(shape[2])]
    points, triangles = level_set({p: field(place(p)) for p in grid}, place, shape)
    noise = random.Random(3)
    points = [tuple(x + noise.gauss(0, 0.02) for x in p) for p in smoothed(points, triangles, 8)]
    points = [(x / 1e3, y / 1e3, max(z, -13) / 1e3) for x, y, z in points]
    return [tuple(points[k] for k in t) for t in triangles]


def organ():
    points, triangles = sphere_of_triangles(5)

    def lump(p):
        x, y, z = p
        r = 0.05 * (1 + 0.22 * x * x - 0.15 * y + 0.2 * x * z + 0.12 * math.sin(5 * x + 2 * y) * math.cos(4 * z))
        return (r * x, r * y, r * z * 0.9)

    points = [lump(p) for p in points]
    return [tuple(points[k] for k in t) for t in triangles]


def bar():
    across = line((0.02 / 3, 0), (0.02, 0), 3)[1:]
    return revolved([(0, 0), *across, *line((0.02, 0), (0.02, 0.2), 75), (0.02, 0.2),
                     *line((0.02, 0.2), (0.02 / 3, 0.2), 3)[1:], (0, 0.2)], 48)


def bracket():
    fillet = [(0.035 - 0.015 * math.sin(a), 0.035 - 0.015 * math.cos(a)) for a in (math.pi / 24 * i for i in range(13))]
    return extruded([(0, 0), (0.1, 0), (0.1, 0.02), *fillet, (0.02, 0.1), (0, 0.1)], 0.05)


def hook():
    bend = [(0.03 - 0.03 * math.cos(a), 0.04 - 0.03 * math.sin(a)) for a in (math.radians(215) * i / 60 for i in range(61))]
    return swept([(0, 0.1 - 0.06 * i / 30) for i in range(30)] + bend, 0.009, 36)


def dumbbell():
    """Balls of 40 mm across with a neck of 12 mm between them."""
    above = math.asin(0.006 / 0.02)
    end = -0.04 + 0.02 * math.cos(above)
    half = [(0, -0.06), *arc((0, -0.04), 0.02, -math.pi / 2, math.pi / 2 - above, 24)[1:]]
    neck = [(0.006, end - 2 * end * i / 50) for i in range(51)]
    return revolved(half + neck + [(r, -z) for r, z in reversed(half)], 40)


def cup():
    """A wall of 3.5 to 4 mm."""
    profile = [(0, 0), *line((0.01, 0), (0.03, 0), 4), *line((0.03, 0), (0.04, 0.08), 40), *line((0.04, 0.08), (0.036, 0.08), 2),
               *line((0.036, 0.08), (0.0265, 0.004), 38), *line((0.0265, 0.004), (0.008, 0.004), 4), (0.008, 0.004), (0, 0.004)]
    return revolved(profile, 60)


def cone():
    profile = [(0, 0), *line((0.01, 0), (0.03, 0), 4), *line((0.03, 0), (0.01, 0.12), 50), *line((0.01, 0.12), (0.003, 0.12), 2),
               (0.003, 0.12), (0, 0.12)]
    return revolved(profile, 48, twist=8, depth=0.7)


def gear():
    teeth = [(2 * math.pi * (k + turn) / 14, r) for k in range(14)
             for turn, r in ((-0.3, 0.04), (-0.17, 0.05), (0.17, 0.05), (0.3, 0.04))]
    return extruded([(r * math.cos(a), r * math.sin(a)) for a, r in teeth], 0.015)


def shell():
    """A dome of 6 mm, of a tenth of its radius."""
    angles = [math.pi / 100 * i for i in range(51)]
    around = [(r * math.sin(a), r * math.cos(a)) for r, by in ((0.06, 1), (0.054, -1)) for a in angles[::by]]
    return revolved([(0, 0.06), *around[1:-1], (0, 0.054)], 96)


# Body, where it is held and loaded (a point and the way beyond it), the force [N], and a probe.
BODIES = {
    "bunny": (bunny, ([0, 0, -0.011], [0, 0, -1]), ([0.04, 0, 0], [1, 0, 0]), [-0.1, 0.03, 0], [0.03, 0, 0.055]),
    "bar": (bar, ([0, 0, 0.0001], [0, 0, -1]), ([0, 0, 0.1999], [0, 0, 1]), [1, 0, 0], [0, 0, 0.2]),
    "organ": (organ, ([0, 0, -0.03], [0, 0, -1]), ([0, 0, 0.03], [0, 0, 1]), [0.2, 0, -0.5], [0.02, 0.01, 0.005]),
    "bracket": (bracket, ([0.0001, 0, 0], [-1, 0, 0]), ([0.0999, 0, 0], [1, 0, 0]), [0, -1, 0.5], [0.095, 0.01, 0.025]),
    "hook": (hook, ([0, 0, 0.0999], [0, 0, 1]), ([0.055, 0, 0.03], [1, 0, 0]), [0, 0.1, -0.3], [0.05, 0, 0.05]),
    "dumbbell": (dumbbell, ([0, 0, -0.05], [0, 0, -1]), ([0, 0, 0.05], [0, 0, 1]), [0.1, 0, 0], [0, 0, 0.055]),
    "cup": (cup, ([0, 0, 0.0001], [0, 0, -1]), ([0, 0, 0.0799], [0, 0, 1]), [0.3, 0, -1], [0.038, 0, 0.08]),
    "cone": (cone, ([0, 0, 0.0001], [0, 0, -1]), ([0, 0, 0.1199], [0, 0, 1]), [0.1, 0.1, 0], [0, 0, 0.118]),
    "gear": (gear, ([-0.03, 0, 0], [-1, 0, 0]), ([0.03, 0, 0], [1, 0, 0]), [0, 0.5, 1], [0.035, 0, 0.0075]),
    "shell": (shell, ([0, 0, 0.0001], [0, 0, -1]), ([0, 0, 0.055], [0, 0, 1]), [0.2, 0, -1], [0, 0, 0.057]),
}

CELLS = {"cup": 5000, "shell": 6000}  # thin walls; 800 of all else

CASE = """what = "A {name} of {facets} facets, held at one end, pulled at another, under its weight."

[body]
geo = "{name}.stl"
voxels = {cells}

[[patch]]
name = "hold"
beyond = {{ point_m = {hold[0]}, normal = {hold[1]} }}

[[patch]]
name = "load"
beyond = {{ point_m = {load[0]}, normal = {load[1]} }}

[material]
youngs_modulus_Pa = 2e7
poisson_ratio = 0.3
density_kg_m3 = 1000

[[load]]
on = "hold"
displacement_m = [0, 0, 0]

[[load]]
on = "load"
force_N = {force}

[[load]]
gravity_m_s2 = [0, 0, -9.81]

[[probe]]
name = "P"
at_m = {probe}

[compare]
models = ["hybmss_avg"]
measures = ["probe", "reaction", "mean_displacement", "displacement_error"]

[reference]
elements = ["p2"]
"""


def write(folder, name):
    make, hold, load, force, probe = BODIES[name]
    triangles = outward(make())
    write_stl(folder / f"{name}.stl", triangles)
    (folder / f"{name}.toml").write_text(CASE.format(name=name, facets=len(triangles), cells=CELLS.get(name, 800), hold=hold,
                                                     load=load, force=force, probe=probe))
    print(f"{name}: {len(triangles)} facets, {six_volumes(triangles) / 6:.9g} m3")


def compared(program, folder, name, known):
    """Of each known value of the case its measure, the error and the uncertainty, as shares of the vector that it is a
    component of.  Prints them in short."""
    start = time.time()
    out = folder / "reports" / name
    subprocess.run([program, "compare", folder / f"{name}.toml", "--out", out], check=True, capture_output=True)
    seconds = time.time() - start
    case = json.loads((out / "results.json").read_text())["cases"][0]
    size = lambda measure: known[measure.rsplit(".", 1)[0] + ".magnitude"]
    values = {r["measure"]: (abs(r["value"] - known[r["measure"]]) / size(r["measure"]), r["uncertainty"] / size(r["measure"]))
              for r in case["references"] if r["measure"] in known}
    probe = "displacement.P.magnitude"
    model = next(r["value"] for r in case["rows"] if (r["model"], r["measure"]) == ("hybmss_avg", probe))
    error, bar = values[probe]
    within = [sum(e <= u for m, (e, u) in values.items() if ("displacement" in m) == moved) for moved in (True, False)]
    total = [sum(("displacement" in m) == moved for m in values) for moved in (True, False)]
    print(f"{name:9} {known[probe]:10.4g} {100 * error:8.2f} {100 * bar:6.2f} {error / bar:6.2f} {within[0]:8d} of {total[0]} "
          f"{within[1]:8d} of {total[1]} {100 * (model / known[probe] - 1):8.1f} {seconds:5.0f}", flush=True)
    return values


def main(folder, program=None, *names):
    folder.mkdir(parents=True, exist_ok=True)
    names = names or list(BODIES)
    for name in names:
        write(folder, name)
    if not program:
        return 0
    with open(Path(__file__).parent / "known.csv") as f:
        lines = list(csv.DictReader(f))
    print("\nbody       probe [m]  error %  bar %  ratio displacements   reactions  model %     s")
    values = {"displacements": [], "reactions": []}
    for name in names:
        known = {line["measure"]: float(line["value"]) for line in lines if line["case"] == name}
        for measure, value in compared(program, folder, name, known).items():
            values["displacements" if "displacement" in measure else "reactions"].append(value)
    failed = False
    for what, of in values.items():
        inside = sum(e <= u for e, u in of)
        print(f"{inside} of {len(of)} {what} inside ({100 * inside / len(of):.0f} %); "
              f"median error / bar {statistics.median(e / u for e, u in of):.2f}")
        failed |= inside < 0.95 * len(of)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), *sys.argv[2:]))
