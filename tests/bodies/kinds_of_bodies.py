"""Seeded bodies by kind, as a scanner or a CAD program hands them over.

A kind is a function of a random.Random that gives a body of about unit size: closed facets (STL), or a script for gmsh
(STEP and msh, which it saves itself).  `placed` puts it somewhere, in some orientation, size and unit.
"""

import math
import struct

from ten_bodies import between, extruded, level_set, line, revolved, smoothed, sphere_of_triangles, swept, write_stl


def direction(rng):
    v = [rng.gauss(0, 1) for _ in range(3)]
    return tuple(x / math.hypot(*v) for x in v)


def add(p, q, times=1):
    return tuple(a + times * b for a, b in zip(p, q))


def box_of(points):
    return [min(c) for c in zip(*points)], [max(c) for c in zip(*points)]


# --- Facets ---


def largest_shell(triangles):
    """Of facets by numbers of points, those that hang together."""
    of = {}

    def head(k):
        while of.setdefault(k, k) != k:
            of[k] = of[of[k]]
            k = of[k]
        return k

    for a, b, c in triangles:
        of[head(b)] = of[head(c)] = head(a)
    shells = {}
    for t in triangles:
        shells.setdefault(head(t[0]), []).append(t)
    return max(shells.values(), key=len)


def blended(field, low, high, cells):
    """The facets where a field is zero, on a grid of so many cells along the longest side, smoothed."""
    step = max(b - a for a, b in zip(low, high)) / cells
    shape = [math.ceil((b - a) / step) + 1 for a, b in zip(low, high)]
    place = lambda p: tuple(a + k * step for a, k in zip(low, p))
    grid = [(i, j, k) for i in range(shape[0]) for j in range(shape[1]) for k in range(shape[2])]
    points, triangles = level_set({p: field(place(p)) for p in grid}, place, shape)
    triangles, points = largest_shell(triangles), smoothed(points, triangles, 6)
    return [tuple(points[k] for k in t) for t in triangles]


def of_balls(balls):
    """Balls (x, y, z, r), blended."""
    low, high = box_of([add(b[:3], (s * 1.15 * b[3],) * 3) for b in balls for s in (-1, 1)])
    return blended(lambda x: math.log(sum(math.exp(-12 * (math.dist(x, b[:3]) - b[3])) for b in balls)), low, high, 30)


def balls(rng):
    made = [(0, 0, 0, 0.5)]
    for _ in range(rng.randint(2, 8)):
        base, r = rng.choice(made), rng.uniform(0.25, 0.45)
        made.append((*add(base[:3], direction(rng), base[3] + 0.3 * r), r))
    return of_balls(made)


def bone(rng):
    """A shaft and two heads, superquadrics."""
    exponent = rng.uniform(2, 5)
    parts = [((0, 0, 0), (rng.uniform(0.13, 0.2),) * 2 + (1,))]
    for end in (-1, 1):
        parts += [((rng.uniform(-0.1, 0.1), y * rng.uniform(0.1, 0.2), 0.9 * end), [rng.uniform(0.22, 0.32) for _ in range(3)])
                  for y in (-1, 1)]

    def near(x, part):
        size = sum(abs((a - c) / s) ** exponent for a, c, s in zip(x, *part)) ** (1 / exponent)
        return math.exp(20 * min(part[1]) * (1 - size))

    return blended(lambda x: math.log(sum(near(x, p) for p in parts)), (-0.55, -0.65, -1.35), (0.55, 0.65, 1.35), 44)


def limbs(rng, foot=(0, 0, 0), along=(0, 0, 1), length=1, radius=0.17, levels=2):
    """Segments (foot, top, radii) of a tree."""
    top = add(foot, along, length)
    made = [(foot, top, radius, 0.75 * radius)]
    for _ in range(rng.randint(2, 3) if levels else 0):
        turned = add(along, direction(rng), 0.9)
        turned = tuple(x / math.hypot(*turned) for x in turned)
        made += limbs(rng, add(foot, along, length * rng.uniform(0.6, 1)), turned, 0.65 * length, 0.72 * radius, levels - 1)
    return made


def tree(rng):
    made = limbs(rng, levels=rng.randint(1, 2))

    def near(x, limb):
        a, b, r, s = limb
        ab, ax = add(b, a, -1), add(x, a, -1)
        t = min(max(sum(p * q for p, q in zip(ab, ax)) / sum(p * p for p in ab), 0), 1)
        return math.exp(-25 * (math.dist(x, add(a, ab, t)) - r - t * (s - r)))

    low, high = box_of([add(p, (s * 1.3 * r,) * 3) for a, b, r, q in made for p in (a, b) for s in (-1, 1)])
    return blended(lambda x: math.log(sum(near(x, limb) for limb in made)), low, high, 38)


def foam(rng):
    """A network of struts in a box: one side of a gyroid."""
    period, level = rng.uniform(1, 1.6), rng.uniform(0.1, 0.5)
    size = (1, rng.uniform(0.6, 1), rng.uniform(0.6, 1))

    def field(x):
        a = [2 * math.pi * c / period + 1 for c in x]
        gyroid = sum(math.sin(a[i]) * math.cos(a[i - 1]) for i in range(3))
        return min(0.15 * (gyroid + level), *(min(c, s - c) for c, s in zip(x, size)))

    return blended(field, (-0.03,) * 3, add(size, (0.03,) * 3), 32)


def gear(rng):
    n, root = rng.randint(8, 20), rng.uniform(0.72, 0.85)
    teeth = [(2 * math.pi * (k + turn) / n, r) for k in range(n)
             for turn, r in ((-0.3, root), (-0.15, 1), (0.15, 1), (0.3, root))]
    return extruded([(r * math.cos(a), r * math.sin(a)) for a, r in teeth], rng.uniform(0.2, 0.6))


def bracket(rng):
    t, fillet, height = rng.uniform(0.15, 0.3), rng.uniform(0.02, 0.2), rng.uniform(0.7, 1)
    turn = [(t + fillet * (1 - math.sin(a)), t + fillet * (1 - math.cos(a))) for a in (math.pi / 16 * i for i in range(9))]
    return extruded([(0, 0), (1, 0), (1, t), *turn, (t, height), (0, height)], rng.uniform(0.3, 0.6))


def shell(rng):
    """A dome, or a piece of a pipe."""
    thick, n = rng.uniform(0.06, 0.2), rng.randint(36, 60)
    if rng.random() < 0.5:
        end = rng.uniform(1.2, 2.2)
        outer = [(math.sin(end * i / 30), math.cos(end * i / 30)) for i in range(31)]
        return revolved(outer + [((1 - thick) * r, (1 - thick) * z) for r, z in reversed(outer)], n, depth=rng.uniform(0.7, 1))
    high = rng.uniform(1, 3)
    profile = line((1, 0), (1, high), 12) + line((1, high), (1 - thick, high), 2) + \
        line((1 - thick, high), (1 - thick, 0), 12) + line((1 - thick, 0), (1, 0), 2)
    rings = [[(r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n), z) for k in range(n)] for r, z in profile]
    return between([*rings, rings[0]])


def hook(rng):
    end, straight = math.radians(rng.uniform(60, 250)), rng.uniform(0.5, 1.5)
    bend = [(0.5 - 0.5 * math.cos(a), -0.5 * math.sin(a)) for a in (end * i / 40 for i in range(41))]
    return swept([(0, straight * (1 - i / 20)) for i in range(20)] + bend, rng.uniform(0.12, 0.25), rng.choice((12, 24, 36)))


def twisted(rng):
    """A bar of three to six corners, drawn thinner and turned up to half a turn."""
    n, turn, end, high = rng.randint(3, 6), rng.uniform(0.5, math.pi), rng.uniform(0.5, 1), rng.uniform(3, 6)
    corners = [(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)) for k in range(n)]
    around = [p for k in range(n) for p in line(corners[k], corners[(k + 1) % n], 6)]

    def ring(t, inner=1):
        size, c, s = inner * (1 + (end - 1) * t), math.cos(turn * t), math.sin(turn * t)
        return [(size * (c * x - s * y), size * (s * x + c * y), high * t) for x, y in around]

    rings = [ring(i / 50) for i in range(51)]
    return between([[(0, 0, 0)], ring(0, 0.5), *rings, ring(1, 0.5), [(0, 0, high)]])


def ball_of(points, triangles, centre, radius):
    return [tuple(add(centre, points[k], radius) for k in t) for t in triangles]


def cavity(rng):
    """A ball, drawn out, with one to four round holes inside."""
    stretch = [rng.uniform(0.8, 1.5) for _ in range(3)]
    body = [tuple(tuple(x * s for x, s in zip(p, stretch)) for p in t) for t in ball_of(*sphere_of_triangles(3), (0, 0, 0), 1)]
    holes = []
    for _ in range(rng.randint(1, 4)):
        centre, r = tuple(0.4 * x for x in direction(rng)), rng.uniform(0.12, 0.25)
        if all(math.dist(centre, c) > 1.1 * (r + s) for c, s in holes):
            holes.append((centre, r))
    hollow = sphere_of_triangles(2)
    return body + [(a, c, b) for hole in holes for a, b, c in ball_of(*hollow, *hole)]


def sheet(rng):
    """Waves, of a thirtieth to a twelfth of their length."""
    t, high, wide, phase = rng.uniform(0.033, 0.08), rng.uniform(0, 0.15), rng.uniform(0.5, 1), rng.uniform(0, 6)
    n, m = 36, 24
    at = lambda i, k, side: (i / n, wide * k / m, high * math.sin(3 * i / n + phase) * math.cos(2 * k / m) + side * t / 2)
    rings = [[at(i, k, 1) for k in range(m + 1)] + [at(i, k, -1) for k in range(m, -1, -1)] for i in range(n + 1)]
    body = between(rings)
    for ring, turned in ((rings[0], 1), (rings[-1], -1)):
        for k in range(m):
            a, b, c, d = ring[k], ring[k + 1], ring[-2 - k], ring[-1 - k]
            body += [t[::-turned] for t in ((a, b, c), (a, c, d))]
    return body


# --- Scripts for gmsh ---


def vec(v):
    return "{" + ", ".join(f"{x:.9g}" for x in v) + "}"


def joined(parts, cut=()):
    """The union of solids, less others: statements without their numbers."""
    text = "".join(f"{p.replace('(', f'({i + 1}) = {{', 1).rstrip(')')}}};\n" for i, p in enumerate((*parts, *cut)))
    n, whole = len(parts), "{1}"
    if n > 1:
        whole = f"BooleanUnion{{ Volume{{1}}; Delete; }}{{ Volume{{2:{n}}}; Delete; }}"
    text += f"whole[] = {whole};\n"
    if cut:
        text += f"BooleanDifference{{ Volume{{whole[]}}; Delete; }}{{ Volume{{{n + 1}:{n + len(cut)}}}; Delete; }}\n"
    return text


def primitives(rng):
    """Boxes, cylinders and cones in a row, each reaching into the next.  (Of joined balls OpenCASCADE writes STEP
    files that it reads as another body.)"""
    parts = []
    for k in range(rng.randint(2, 4)):
        x, r = 0.7 * k, rng.uniform(0.3, 0.55)
        parts.append(rng.choice((f"Box({x:.4f}, {-r:.4f}, {-r:.4f}, 1, {2 * r:.4f}, {2 * r:.4f})",
                                 f"Cylinder({x:.4f}, 0, 0, 1, 0, 0, {r:.4f})",
                                 f"Cone({x:.4f}, 0, 0, 1, 0, 0, {r:.4f}, {0.6 * r:.4f})")))
    return joined(parts)


def bored(rng):
    """A block or a cylinder with bores through it, and a pocket."""
    y, z = rng.uniform(0.5, 1), rng.uniform(0.3, 0.8)
    whole = rng.choice((f"Box(0, 0, 0, 2, {y:.4f}, {z:.4f})",
                        f"Cylinder(0, {y / 2:.4f}, {z / 2:.4f}, 2, 0, 0, {0.6 * max(y, z):.4f})"))
    holes = [f"Cylinder({x + rng.uniform(-0.1, 0.1):.4f}, {y / 2:.4f}, -3, 0, 0, 6, {y * rng.uniform(0.1, 0.25):.4f})"
             for x in (0.4, 1, 1.6)[:rng.randint(1, 3)]]
    return joined([whole], holes + [f"Sphere(2, {y / 2:.4f}, {z:.4f}, {0.4 * z:.4f})"] * rng.randint(0, 1))


def plate_bracket(rng):
    """Two plates at a right angle, with holes for screws."""
    t, y = rng.uniform(0.12, 0.2), rng.uniform(0.5, 1)
    return joined([f"Box(0, 0, 0, 1, {y:.4f}, {t:.4f})", f"Box(0, 0, 0, {t:.4f}, {y:.4f}, 1)"],
                  [f"Cylinder(0.65, {y / 2:.4f}, -1, 0, 0, 2, {0.15 * y:.4f})",
                   f"Cylinder(-1, {y / 2:.4f}, 0.65, 2, 0, 0, {0.15 * y:.4f})"])


def half_shell(rng):
    r = 1 - rng.uniform(0.1, 0.2)
    return joined(["Sphere(0, 0, 0, 1)"], [f"Sphere(0, 0, 0, {r:.4f})", "Box(-2, -2, -2, 4, 4, 2)"])


def section(rng):
    """A polygon drawn along z and turned, its cells prisms or hexahedra in layers."""
    n, a = rng.randint(5, 8), rng.uniform(0.7, 1)
    points = [(a * math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)) for k in range(n)]
    text = "".join(f"Point({k + 1}) = {vec((x, y, 0))};\n" for k, (x, y) in enumerate(points))
    text += "".join(f"Line({k + 1}) = {{{k + 1}, {(k + 1) % n + 1}}};\n" for k in range(n))
    text += f"Curve Loop(1) = {{1:{n}}};\nPlane Surface(1) = {{1}};\n"
    cells = rng.choice(("", " Recombine;"))
    text += "Recombine Surface{1};\n" if cells and rng.random() < 0.5 else ""
    return text + f"Extrude {{0, 0, {rng.uniform(1.5, 4):.4f}}} {{ Surface{{1}}; Layers{{{rng.randint(8, 16)}}};{cells} }}\n"


# Kind: its functions of facets, of scripts for STEP, of scripts for msh.
KINDS = {
    "balls": ([balls], [], []),
    "gear": ([gear], [], []),
    "bracket": ([bracket], [plate_bracket], [plate_bracket]),
    "shell": ([shell], [half_shell], [half_shell]),
    "bone": ([bone], [], []),
    "tree": ([tree], [], []),
    "twisted bar": ([twisted], [], []),
    "hollow": ([cavity], [bored], [bored]),
    "sheet": ([sheet], [], []),
    "hook": ([hook], [], []),
    "foam": ([foam], [], []),
    "solids joined": ([], [primitives], [primitives]),
    "layers of cells": ([], [], [section]),
    "broken": ([], [], []),
}


# --- Broken files ---


def moved(triangles, by):
    return [tuple(add(p, by) for p in t) for t in triangles]


def with_hole(rng, triangles):
    first = rng.randrange(len(triangles))
    near = sorted(triangles, key=lambda t: math.dist(t[0], triangles[first][0]))[:rng.randint(1, 6)]
    return [t for t in triangles if t not in near]


def flipped(rng, triangles):
    return [t[::-1] if rng.random() < 0.1 else t for t in triangles]


def unwelded(rng, triangles):
    return [tuple(add(p, direction(rng), 2e-7) for p in t) for t in triangles]


# What was done to a file: by which function, and what its refusal must say (nothing: it runs).
BREAKS = {
    "a hole": (with_hole, "the surface is open"),
    "parts that overlap": (lambda rng, t: t + moved(t, (0.313, 0.207, 0.1)), "overlap"),
    "parts far apart": (lambda rng, t: t + moved(t, (5, 0, 0)), "shells that do not touch"),
    "facets flipped": (flipped, ""),
    "inside out": (lambda rng, t: [x[::-1] for x in t], ""),
    "facets twice": (lambda rng, t: t + rng.sample(t, 5), ""),
    "corners apart": (unwelded, ""),
    "cut off": (lambda rng, t: t, "cut off"),
}


# --- Where it is ---


def turned(axis, angle, p):
    """p about an axis through the origin [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    cross = (axis[1] * p[2] - axis[2] * p[1], axis[2] * p[0] - axis[0] * p[2], axis[0] * p[1] - axis[1] * p[0])
    along = (1 - c) * sum(a * b for a, b in zip(axis, p))
    return tuple(c * x + s * y + along * a for x, y, a in zip(p, cross, axis))


def placed(rng):
    """Where a body lies: axis and angle [rad], its size [m], the shift [sizes]."""
    upright = rng.random() < 0.3
    axis, angle = ((0, 0, 1), 0) if upright else (direction(rng), rng.uniform(0, math.pi))
    return axis, angle, 10 ** rng.uniform(-2.5, 0.5), [rng.choice((0, 1, 5)) * x for x in direction(rng)]


def write_facets(path, triangles, place, unit):
    """The body of facets as an STL file in units of `unit` [m], and its points there."""
    axis, angle, size, shift = place
    at = lambda p: tuple(size / unit * x for x in add(turned(axis, angle, p), shift))
    triangles = [tuple(at(p) for p in t) for t in triangles]
    write_stl(path, triangles)
    return triangles


def script(text, place, unit, save, rng):
    """A script for gmsh that saves the body as the file `save`."""
    axis, angle, size, shift = place
    text = f'SetFactory("OpenCASCADE");\n{text}' \
           f"Rotate {{ {vec(axis)}, {{0, 0, 0}}, {angle:.9g} }} {{ Volume{{:}}; }}\n" \
           f"Dilate {{ {{0, 0, 0}}, {size / unit:.9g} }} {{ Volume{{:}}; }}\n" \
           f"Translate {vec([size / unit * x for x in shift])} {{ Volume{{:}}; }}\n"
    if save.endswith(".msh"):
        text += f"Mesh.MeshSizeMax = {size / unit * rng.uniform(0.15, 0.3):.6g};\nMesh 3;\n" \
                f"Mesh.MshFileVersion = {rng.choice((2.2, 4.1))};\nMesh.Binary = {rng.randint(0, 1)};\n"
        text += "SetOrder 2;\n" if rng.random() < 0.3 else ""
    return text + f'Save "{save}";\n'


def truncated(path):
    path.write_bytes(path.read_bytes()[:-struct.calcsize("<12fH") // 2])
