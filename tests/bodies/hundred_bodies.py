#!/usr/bin/env python3
"""A hundred bodies of a stranger's by kind: what share of them works, and how well.

usage: hundred_bodies.py FOLDER SPRINGPROOF [--count N] [--seed S] [--jobs N] [--judged EVERY] [--tetrahedra N]
                                                  [--least N] [--only NAME] [--pictures]

Writes bodies by kinds_of_bodies.py into FOLDER, makes of each a case by the box, volume and thickness that `springproof
new` prints, and compares it at two resolutions and four Poisson's ratios.  Of every EVERY-th (0: none) the reference is
solved once more with edges of half the length.  A body whose result.json is there is not run again.  Prints a table by
kind.  A reference converges if an order is seen, or its meshes are as good as equal, at every ratio; it tells the
springs' error if its uncertainty is the smaller of the two, at every ratio and the finer lattice.  Fails if a body is
refused without the right reason or has no result at some ratio, if a smaller share of a reference's displacements, in
the mean over the bodies, lies within its uncertainty than is said of it (INSIDE), or if fewer references than --least
tell the error.
"""

import argparse
import json
import math
import random
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

from kinds_of_bodies import BREAKS, KINDS, direction, placed, script, truncated, write_facets
from ten_bodies import outward

RATIOS = (0, 0.3, 0.45, 0.499)
INSIDE = 0.95  # of values: what uncertainties are stated for; those of one body err together


# --- A body and its case ---


def write_body(rng, folder, program, kind):
    """Writes the file.  Returns its name, the scale to metres, what was done to it, and its points [m], if facets."""
    broken = rng.choice(list(BREAKS)) if kind == "broken" else ""
    source = rng.choice([k for k in KINDS if KINDS[k][0]]) if broken else kind
    form = "stl" if broken else rng.choice([f for f, makes in zip(("stl", "step", "msh"), KINDS[source]) if makes])
    place, unit = placed(rng), rng.choice((1, 0.001, 0.01, 0.0254))
    make = rng.choice(KINDS[source][("stl", "step", "msh").index(form)])
    if form == "stl":
        triangles = outward(make(rng))
        triangles = BREAKS[broken][0](rng, triangles) if broken else triangles
        triangles = write_facets(folder / "body.stl", triangles, place, unit)
        if broken == "cut off":
            truncated(folder / "body.stl")
        return "body.stl", unit, broken, [tuple(unit * x for x in p) for t in triangles for p in t]
    name = f"body.{form}"
    (folder / "make.geo").write_text(script(make(rng), place, 0.001 if form == "step" else unit, name, rng))
    run([program, "new", "make.geo", "--size", "1", "1", "1"], folder)  # which runs the script
    if not (folder / name).exists():
        raise RuntimeError(f"{folder}: gmsh saved no {name}")
    return name, 1 if form == "step" else unit, broken, []  # a STEP file states its unit


def run(command, folder, limit=900):
    """Status, standard output, and the last line of the errors."""
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return -1, "", f"not finished after {limit} s"
    return done.returncode, done.stdout, (done.stderr.strip().splitlines() or [""])[-1]


def size_of(text):
    """Box [m], volume [m^3] and thickness [m], from the comment that `springproof new` begins with."""
    lists = [[float(x) for x in part.split(",")] for part in re.findall(r"\[([^]]*)\]", text[:400])[:2]]
    volume, thick = (float(x) for x in re.search(r"of ([\d.e+-]+) m³; thickness ([\d.e+-]+) m", text).groups())
    return *lists, volume, thick


def resolutions(volume, thick):
    """As `springproof new`: two cells across the thickness, if that are not too many; and 2.5 times as many."""
    coarse = min(max(600, volume / (thick / 2) ** 3), 1500)
    return [round(coarse, -2), round(2.5 * coarse, -2)]


def patches(rng, low, high, points):
    """Where it is held and loaded, by a plane or a ball, along one of the two longest axes of its box."""
    axis = sorted(range(3), key=lambda i: low[i] - high[i])[rng.choice((0, 0, 1))]
    rule = rng.choice(("beyond", "near")) if points else "beyond"
    text = ""
    for end, name in enumerate(("hold", "load")):
        out = [(2 * end - 1) * (i == axis) for i in range(3)]
        share = rng.uniform(0.1, 0.2)
        at = [high[i] - share * (high[i] - low[i]) if end else low[i] + share * (high[i] - low[i]) for i in range(3)]
        if rule == "beyond":
            text += f'[[patch]]\nname = "{name}"\nbeyond = {{ point_m = {at}, normal = {out} }}\n'
        else:
            tip = list(max(points, key=lambda p: sum(a * b for a, b in zip(p, out))))
            radius = share * math.dist(low, high)
            text += f'[[patch]]\nname = "{name}"\nnear = {{ point_m = {tip}, radius_m = {radius} }}\n'
    return text


def tables_of(rng, body, points):
    """The case's tables of patches, material and loads, and its probe."""
    low, high, volume, _ = body
    modulus = 10 ** rng.uniform(3, 11)
    force = [0.01 * modulus * volume / math.dist(low, high) * x for x in direction(rng)]
    weight = [9.81 * x for x in direction(rng)]
    text = patches(rng, low, high, points)
    text += f"[material]\nyoungs_modulus_Pa = {modulus}\npoisson_ratio = {list(RATIOS)}\ndensity_kg_m3 = 1000\n"
    text += f'[[load]]\non = "hold"\ndisplacement_m = [0, 0, 0]\n[[load]]\non = "load"\nforce_N = {force}\n'
    if rng.random() < 0.5:
        text += f"[[load]]\ngravity_m_s2 = {weight}\n"
    if points:
        text += f'[[probe]]\nname = "P"\nat_m = {list(rng.choice(points))}\n'
    return text


def case_of(rng, name, scale, points, printed, tetrahedra):
    """The case, and the edge of the reference's finest mesh [m]: a third as `springproof new` printed it."""
    low, high, volume, thick = body = size_of(printed)
    edge = (6 * 2**0.5 * volume / tetrahedra) ** (1 / 3)
    measures = ["displacement_error", "mean_displacement", "reaction"]
    if rng.random() < 1 / 3:
        text = re.sub(r"\nvoxels = \d+", f"\nvoxels = {resolutions(volume, thick)}", printed)
        text = re.sub(r"\npoisson_ratio = .*", f"\npoisson_ratio = {list(RATIOS)}", text)
        text = text[:text.index("[compare]")]
    else:
        text = f'what = "A body by rule."\n[body]\ngeo = "{name}"\nscale = {scale}\n'
        text += f"voxels = {resolutions(volume, thick)}\n{tables_of(rng, body, points)}"
        measures += ["probe"] if points else []
    return text + f'[compare]\nmodels = ["hybmss_avg"]\nmeasures = {json.dumps(measures)}\n[reference]\n', edge


# --- Its results ---


def values_of(case):
    """Of the reference's displacements, by ratio and measure, value, uncertainty and the vector's size [m]."""
    found = {(r["poisson_ratio"], r["measure"]): r for r in case["references"]}
    values = {}
    for (nu, measure), r in found.items():
        whole = found.get((nu, measure.rsplit(".", 1)[0] + ".magnitude"), r)
        if measure.startswith(("displacement.", "mean_displacement.")) and r["uncertainty"] is not None:
            values[f"{nu} {measure}"] = (r["value"], r["uncertainty"], whole["value"])
    return values


def outcome(folder):
    """What a comparison said of the body."""
    case = json.loads((folder / "case" / "results.json").read_text())["cases"][0]
    fields = [r for r in case["references"] if r["measure"] == "displacement_error"]
    rows = [r for r in case["rows"] if (r["model"], r["measure"]) == ("hybmss_avg", "displacement_error")]
    return {"values": values_of(case), "notes": case["notes"], "cautions": case["cautions"],
            "diverging": {r["poisson_ratio"]: r["note"] for r in fields if not r["converging"]},
            "failed": sorted({r["message"] for r in case["runs"] if not r["ok"]}),
            "uncertain": {r["poisson_ratio"]: r["uncertainty"] for r in fields},
            "errors": {nu: [r["value"] for r in rows if r["poisson_ratio"] == nu] for nu in RATIOS}}


def compare(folder, program, jobs, text, name):
    """Status and error of the case NAME.toml."""
    (folder / f"{name}.toml").write_text(text)
    status, _, said = run([program, "compare", f"{name}.toml", "--jobs", str(jobs), "--quiet", "--out", name], folder)
    return status, said


def judge(folder, program, jobs, text, edge, record):
    """Solves the reference with edges of half the length at two ratios."""
    text = re.sub(r"poisson_ratio = \[.*\]", "poisson_ratio = [0.3, 0.499]", text)
    text = re.sub(r"voxels = \[(\d+).*?\]", r"voxels = \1", text)
    status, said = compare(folder, program, jobs, f"{text}edge_m = {edge / 2}\n", "judge")
    if status != 0:
        record["not_judged"] = said
        return
    case = json.loads((folder / "judge" / "results.json").read_text())["cases"][0]
    record["judged"] = values_of(case)


def compared(folder, o, number):
    """Makes and runs a body; what became of it is in its result.json."""
    kind = list(KINDS)[number % len(KINDS)]
    rng = random.Random(f"{o.seed} {number}")
    folder.mkdir(parents=True, exist_ok=True)
    start = time.time()
    name, scale, broken, points = write_body(rng, folder, o.program, kind)
    record = {"kind": kind, "form": name[5:], "broken": broken, "seed": o.seed, "tetrahedra": o.tetrahedra}
    status, printed, said = run([o.program, "new", name, "--scale", str(scale)], folder)
    if status == 0:
        text, edge = case_of(rng, name, scale, points, printed, o.tetrahedra)
        record["rule"] = "new" if text.startswith("#") else "beyond" if "beyond" in text else "near"
        status, said = compare(folder, o.program, o.jobs, f"{text}edge_m = {edge}\n", "case")
    record |= {"status": status, "said": said if status else ""}
    if status == 0:
        record |= outcome(folder)
        if o.judged and number % o.judged == 0:
            judge(folder, o.program, o.jobs, text, edge, record)
    record["seconds"] = round(time.time() - start)
    (folder / "result.json").write_text(json.dumps(record, indent=1))


# --- The table ---


def runs(record):
    """Whether every model has a result at every ratio."""
    return record["status"] == 0 and not record["failed"]


def is_right(record):
    """Whether a broken file was refused for what was done to it; and any other, or one that can be mended, runs, or has
    struts that are thinner than a cell, which is said."""
    reason = BREAKS[record["broken"]][1] if record["broken"] else ""
    return record["status"] == 2 and (reason or "share no face") in record["said"] or not reason and runs(record)


def converges(record):
    return runs(record) and not record["diverging"]


def tells(record):
    return runs(record) and all(u < e[-1] for u, e in zip(record["uncertain"].values(), record["errors"].values()))


def inside(record):
    """Of each displacement that a finer mesh was solved for, the error and the uncertainty, in shares of its vector."""
    finer, own = record.get("judged", {}), record.get("values", {})
    least = 1e-6 * max((size for _, _, size in finer.values()), default=0)  # what is held has none
    return [(abs(own[m][0] - value) / size, own[m][1] / size) for m, (value, _, size) in finer.items()
            if m in own and size > least]


def percent(values):
    return f"{100 * statistics.median(values):5.1f} {100 * max(values):5.1f}" if values else "    -     -"


def table(records):
    """Prints shares by kind.  Errors of hybmss_avg are of the displacement, median and worst, of the coarse and the fine
    lattice; "+-": what the reference's displacement is uncertain by, the median of all ratios."""
    print(f"{'per cent':16} bodies refused rightly converge tell   +-" +
          "".join(f"   nu = {nu:<5} coarse, fine" for nu in RATIOS) + "   inside")
    for kind in [*KINDS, "all"]:
        own = [r for r in records.values() if kind in (r["kind"], "all")]
        if not own:
            continue
        ran = [r for r in own if r["status"] == 0]
        refused = [r for r in own if r["status"] != 0]
        bars = [u for r in ran for u in r["uncertain"].values() if u is not None]
        errors = "".join(f"  {percent([e[at] for e in (r['errors'][str(nu)] for r in ran) if len(e) > at])}"
                         for nu in RATIOS for at in (0, 1))
        pairs = [p for r in ran for p in inside(r)]
        print(f"{kind:16} {len(own):6d} {len(refused):7d} {sum(map(is_right, refused)):7d} {sum(map(converges, ran)):8d}"
              f"{sum(map(tells, ran)):5d}{100 * statistics.median(bars or [math.nan]):5.1f}{errors}   {sum(e <= u for e, u in pairs)} of {len(pairs)}")


def report(records, folder, program, pictures):
    table(records)
    print("\nrefused or run wrongly, without a result at some ratio, or without a reference that converges:")
    for name, r in records.items():
        if not is_right(r) or r["status"] == 0 and not converges(r) or "not_judged" in r:
            apart = r.get("diverging", {})
            says = [r["said"], *r.get("failed", []), r.get("not_judged", ""),
                    *[f"at nu = {', '.join(apart)} {note}" for note in list(apart.values())[:1]]]
            print(f"  {name} ({r['form']}{', ' * bool(r['broken'])}{r['broken']}): " + "; ".join(s for s in says if s))
    worst = sorted((n for n, r in records.items() if r["status"] == 0),
                   key=lambda n: -max(e[-1] for e in records[n]["errors"].values() if e))[:10]
    print("\nthe worst ten: " + ", ".join(worst))
    for name in worst if pictures else ():
        print(run([program, "pictures", "case", "--only", "shapes"], folder / name)[1].strip())


def verdict(records, least):
    ran = [r for r in records.values() if r["status"] == 0]
    wrong = [name for name, r in records.items() if not is_right(r)]
    shares = [statistics.mean(e <= u for e, u in pairs) for pairs in map(inside, ran) if pairs]
    told = sum(map(tells, ran))
    held = statistics.mean(shares or [1])
    seconds = statistics.median(r["seconds"] for r in records.values())
    print(f"\n{len(records)} bodies, {seconds:.0f} s each: {len(wrong)} wrong; references of {sum(map(converges, ran))} of {len(ran)} converge, "
          f"{told} tell the springs' error; of the displacements of {len(shares)} {100 * held:.0f} % inside in the mean")
    return int(bool(wrong) or told < least or held < INSIDE)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("program")
    for name, default in (("count", 100), ("seed", 1), ("jobs", 1), ("judged", 9), ("tetrahedra", 4000), ("least", 0)):
        options.add_argument(f"--{name}", type=int, default=default)
    options.add_argument("--pictures", action="store_true")
    options.add_argument("--only", help="the bodies of this kind, or of this name")
    o = options.parse_args()
    o.program = Path(o.program).resolve()
    names = {n: f"{o.seed}-{n:03d}-{list(KINDS)[n % len(KINDS)].replace(' ', '_')}" for n in range(o.count)}
    records = {}
    for number, name in names.items():
        if o.only and o.only not in name:
            continue
        result = o.folder.resolve() / name / "result.json"
        if not result.exists():
            compared(result.parent, o, number)
        records[name] = json.loads(result.read_text())
        print(f"{name}: {records[name]['said'] or str(records[name]['seconds']) + ' s'}", flush=True)
    report(records, o.folder.resolve(), o.program, o.pictures)
    return verdict(records, o.least)


if __name__ == "__main__":
    sys.exit(main())
