#!/usr/bin/env python3
"""Writes comparisons/live/pulls.json: the pulls that the live page repeats, and what finite elements say of them.
Bodies that FOLDER lacks stay as they are.

  springproof compare comparisons/live/pulls --out FOLDER && comparisons/live/pulls/pulls.py FOLDER

takes surface, displacement and volume change of the reference from FOLDER/report.html and FOLDER/results.json.
"""
import array
import base64
import json
import math
import pathlib
import re
import sys

here = pathlib.Path(__file__).resolve().parent
folder = pathlib.Path(sys.argv[1])
part_of_block = lambda c: 1 if c[2] < 1e-6 else 2 if c[2] > 0.1 - 1e-6 else 0
titles = {
    "rabbit": ("rabbit", "The rabbit is pulled by its nose", lambda c: 1 if c[2] < 1e-6 else 2 if c[0] > 0.172 else 0),
    "block_gently": ("block, pulled gently", "The block’s top is pulled up and aside, gently", part_of_block),
    "block": ("block, pulled hard", "The block’s top is pulled up and aside, hard", part_of_block),
}


def values(packed, code):
    numbers = array.array(code)
    numbers.frombytes(base64.b64decode(packed))
    return numbers


def packed(numbers, code):
    return base64.b64encode(array.array(code, numbers).tobytes()).decode()


def shorts(numbers):
    scale = max(abs(x) for x in numbers) / 32767
    return {"scale": scale, "base64": packed([round(x / scale) for x in numbers], "h")}


def between(answers, nu):
    """The cubic through the four ratios nearest to nu, as on the page: (displacement, volume change)."""
    above = next((i for i, a in enumerate(answers) if a[0] > nu), len(answers))
    begin = max(0, min(len(answers) - 4, above - 2))
    near = answers[begin:begin + 4]
    weights = [math.prod((nu - b[0]) / (a[0] - b[0]) for b in near if b is not a) for a in near]
    mixed = [sum(w * u for w, u in zip(weights, values)) for values in zip(*(a[1] for a in near))]
    return mixed, sum(w * a[2] for w, a in zip(weights, near))


def interpolation_error(answers):
    """Largest error, by the displacement, of what the others say of a ratio with two others on each side."""
    largest = 0
    for k in range(2, len(answers) - 2):
        nu, u, volume = answers[k]
        mixed, mixed_volume = between(answers[:k] + answers[k + 1:], nu)
        error = math.dist(mixed, u) / math.hypot(*u)
        print(f"  without nu = {nu}: displacement off by {100 * error:.2f} %, volume change by {100 * (mixed_volume - volume):.3f} %")
        largest = max(largest, error)
    return largest


def floats(packed_shorts):
    return [packed_shorts["scale"] * x for x in values(packed_shorts["base64"], "h")]


def body(name, case, result, pictures):
    title, text, part_of = titles[name]
    fem = [p for p in pictures["pictures"] if p["model"] == "fem"]
    smooth = [p for p in fem if p["surface"] == "smooth"]
    fem = sorted(smooth or fem, key=lambda p: p["poisson_ratio"])
    mesh = pictures["meshes"][fem[0]["mesh"]]
    assert all(p["mesh"] == fem[0]["mesh"] for p in fem), "the pictures have different surfaces"
    rest = values(mesh["rest"], "f")
    quads = values(mesh["quads"]["base64"], "H" if mesh["quads"]["type"] == "uint16" else "I")
    facets = []
    for q in range(0, len(quads), 4):
        a, b, c, d = quads[q:q + 4]
        facets.append((a, b, c))
        if d != c:
            facets.append((a, c, d))
    # 16 bits of the largest coordinate; what lies in the planes z = 0 and z = height stays there
    points = shorts(rest)
    middle = lambda f: [sum(rest[3 * n + d] for n in f) / 3 for d in range(3)]
    uncertainty = {row["poisson_ratio"]: row["reference_uncertainty"] for row in result["rows"] if row["measure"] == "displacement_error"}
    volume = {row["poisson_ratio"]: row["reference"] for row in result["rows"] if row["measure"] == "volume_change"}
    print(name)
    answers = [(p["poisson_ratio"], floats(p["displacement"]), volume[p["poisson_ratio"]]) for p in fem]
    force = json.loads(re.search(r"force_N = (\[.*?\])", case["text"]).group(1))
    return {
        "name": name,
        "title": title,
        "youngs_modulus": case["materials"][0]["youngs_modulus"],
        "pull": {"text": text, "force": force},
        "surface": {"points": points, "facets": packed([n for f in facets for n in f], "H"), "parts": packed([part_of(middle(f)) for f in facets], "B")},
        "interpolation": interpolation_error(answers),
        "fem": [{"nu": p["poisson_ratio"], "volume_change": volume[p["poisson_ratio"]], "uncertainty": uncertainty[p["poisson_ratio"]],
                 "displacement": p["displacement"]} for p in fem],
    }


page = (folder / "report.html").read_text()
results = json.loads((folder / "results.json").read_text())
pictures = json.loads(re.search(r'id="pictures-data">(.*?)</script>', page, re.S).group(1))
bodies = []
for result in results["cases"]:
    name = result["experiment"]["name"]
    if name in titles:
        bodies.append(body(name, result["experiment"], result, next(p for p in pictures if p["case"] == name)))
out = here.parent / "pulls.json"
old = json.loads(out.read_text())["bodies"] if out.exists() else []
done = {b["name"] for b in bodies}
bodies = sorted([b for b in old if b["name"] not in done] + bodies, key=lambda b: list(titles).index(b["name"]))
out.write_text(json.dumps({"bodies": bodies}, ensure_ascii=False, separators=(",", ":")) + "\n")
print(out.stat().st_size, "bytes:", ", ".join(f"{b['name']} at {len(b['fem'])} ratios, {len(base64.b64decode(b['surface']['parts']))} facets" for b in bodies))
