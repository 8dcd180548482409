"""The program springproof: comparisons with finite elements."""

import csv
import html
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

import numpy

from ._springproof import InputError, _problems_of

_NUMBERS = ("poisson_ratio", "value", "reference", "reference_uncertainty", "error", "spread", "published")


def find_program(name: str = "springproof") -> "pathlib.Path | None":
    """A program of springproof: named by SPRINGPROOF (the others lie beside that one), beside the package or Python, or on PATH."""
    package = pathlib.Path(__file__).resolve().parent
    beside = [package, pathlib.Path(__file__).absolute().parents[2], pathlib.Path(sys.prefix) / "bin", pathlib.Path(sys.executable).parent]
    if given := os.environ.get("SPRINGPROOF"):
        beside.insert(0, pathlib.Path(given).absolute().parent)
        if name == "springproof":
            return pathlib.Path(given) if shutil.which(given) else None
    found = [shutil.which(folder / name) for folder in beside] + [shutil.which(name)]
    return next((pathlib.Path(file) for file in found if file), None)


# The mesher, which voxels() runs: the library looks for it beside the running program, which is Python.
if "SPRINGPROOF_MESH_PROGRAM" not in os.environ and (_mesher := find_program("springproof-mesh")):
    os.environ["SPRINGPROOF_MESH_PROGRAM"] = str(_mesher)


class Loads(NamedTuple):
    """The loads of a case at the nodes of a body of tetrahedra, as compare() hands them to a function."""

    forces: numpy.ndarray  #: on each node, n x 3 [N]: of tractions, pressures, weight and point forces
    displacement: numpy.ndarray  #: that supports prescribe, n x 3 [m]; NaN: free


class Rows(list):
    """Rows of a comparison: a list of dicts that a notebook shows as a table, and that draws itself."""

    _SHOWN = ("case", "model", "poisson_ratio", "cells", "measure", "value", "unit", "error", "reference_uncertainty")

    def _repr_html_(self) -> str:
        def cell(value: object) -> str:
            return "" if value is None else html.escape(f"{value:.4g}" if isinstance(value, float) else str(value))

        head = "".join(f"<th>{column.replace('_', ' ')}</th>" for column in self._SHOWN)
        body = "".join("<tr>" + "".join(f"<td>{cell(row[column])}</td>" for column in self._SHOWN) + "</tr>" for row in self)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def plot(self, measure: str = "displacement_error", ax=None):
        """Draws the errors of a measure against Poisson's ratio, a line per model at its finest resolution, the reference's
        uncertainty in grey.

        ax: axes of matplotlib, which is needed (Debian: python3-matplotlib); by default new ones.  Returns the axes.  Raises
        InputError if no row has an error of the measure.
        """
        try:
            import matplotlib.pyplot as pyplot
        except ImportError:
            raise RuntimeError("plot: needs matplotlib (Debian: python3-matplotlib; or pip install matplotlib)") from None
        rows = [row for row in self if row["measure"] == measure and row["error"] is not None]
        if not rows:
            known = sorted({row["measure"] for row in self if row["error"] is not None})
            raise InputError(f"plot: no row has an error of '{measure}' (allowed: {', '.join(known) or 'none: these rows have no reference'})")
        ax = ax or pyplot.figure(figsize=(8, 4.5), layout="constrained").add_subplot()
        lines: dict = {}
        for row in rows:  # the resolutions of a case ascend
            lines.setdefault((row["case"], row["model"]), {})[row["poisson_ratio"]] = abs(row["error"])
        several = len({case for case, _ in lines}) > 1
        for number, ((case, model), points) in enumerate(lines.items()):
            ax.plot(*zip(*sorted(points.items())), marker="osv^Dx"[number // 10 % 6], label=f"{case} {model}" if several else model)
        doubts: dict = {}
        for row in rows:
            doubts[row["poisson_ratio"]] = max(doubts.get(row["poisson_ratio"], 0), row["reference_uncertainty"] or 0)
        ratios = sorted(doubts)
        ax.fill_between(ratios, [doubts[ratio] for ratio in ratios], color="0.85", label="uncertainty of the reference")
        ax.set(xlabel="Poisson's ratio", ylabel=measure.replace("_", " "), yscale="log")
        ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1, 0.5))
        return ax


def compare(
    case: "str | os.PathLike[str] | Mapping[str, object]",
    *,
    models: "Mapping[str, Callable[..., object]] | None" = None,
    poisson_ratio: "float | Iterable[float] | None" = None,
    out: "str | os.PathLike[str] | None" = None,
    jobs: "int | None" = None,
    resume: bool = False,
) -> "Rows":
    """Models beside finite elements: runs `springproof compare` and returns the rows of its results.csv.

    case: a case file, the name of a built-in case or folder, or a case as a dict of the keys of a case file, whose files are
    relative to the working directory.  models: your own beside the case's, label -> function(body, material, loads), called for
    each Poisson's ratio.  body: the case's body in tetrahedra as fine as its finest lattice (nodes n x 3 [m], tetrahedra t x 4,
    patches: name -> nodes); material: E, nu, G, K, density; loads: at these nodes, forces n x 3 [N] and displacement n x 3 [m]
    of the supports, NaN where free.  It returns the displacements of body.nodes, n x 3 [m], or (points, displacements) at points
    of its own, all over the body.  Each is ranked and drawn as a model.  poisson_ratio: only these of the case's.  out: a folder that keeps report.html,
    results.csv and results.json; by default nothing is kept.  jobs: parts to run at once.  resume: take finished parts from
    `out`.

    A row has the columns of docs/results.md: case, kinematics, model, poisson_ratio, cells, measure, value, unit, reference,
    reference_uncertainty, error, samples, spread, published, published_where.  Numbers are floats (samples: int), None where
    there is none.  pandas.DataFrame(rows) takes them; a notebook shows them as a table, rows.plot() draws their errors.

    Raises InputError with the program's message if the input cannot be used, and what a function of yours raises; warns where an [[expect]] of the case does not
    hold or a run has no result.
    """
    program = _program("compare")
    ratios = None if poisson_ratio is None else [float(nu) for nu in (poisson_ratio if isinstance(poisson_ratio, Iterable) else [poisson_ratio])]
    with tempfile.TemporaryDirectory() as folder:
        name = os.fspath(case) if not isinstance(case, Mapping) else str(_write_case(case, pathlib.Path(folder)))
        if models:
            name = str(_with_models(name, models, ratios, program, pathlib.Path(folder)))
        results = pathlib.Path(out) if out is not None else pathlib.Path(folder) / "results"
        command = [str(program), "compare", name, "--out", str(results), "--quiet"]
        if ratios is not None:
            command.append("--poisson-ratio=" + ",".join(repr(ratio) for ratio in ratios))
        command += [f"--jobs={jobs}"] if jobs is not None else []
        command += ["--resume"] if resume else []
        run = _run(command)
        rows = _read_rows(results / "results.csv")
        if run.returncode == 1:
            warnings.warn(f"springproof compare {name}: {run.stderr.strip() or run.stdout.strip()}", stacklevel=2)
        return rows


def identify(
    case: "str | os.PathLike[str] | Mapping[str, object]",
    *,
    only: "str | Iterable[str] | None" = None,
    start: "Iterable[float] | None" = None,
    synthetic: int = 0,
    out: "str | os.PathLike[str] | None" = None,
    resume: bool = False,
) -> "list[dict]":
    """Numbers of a case from what was measured: runs `springproof identify` and returns what it writes to identify.json.

    case: as of compare(), with [[measured]] and [[identify]].  only: names of the [[identify]] that are wanted.  start: one number
    of each parameter.  synthetic: so many sets are made of the fit, with noise, and fitted.  out: a folder that keeps identify.json,
    identify.html and what was run; resume: take what was run from there.

    Each [[identify]] is a dict: `parameters` (each with name, value, u, from, to: limits of 95 %, held), `correlation`,
    `directions` (the worst known first), `values` (fitted: residual over u; predicted: ratio, |E| / u_val), `chi2`, `freedom`,
    `sentences`; ok False: no result, `message` says why.  Raises InputError with the program's message if the input cannot be used.
    """
    program = _program("identify")
    with tempfile.TemporaryDirectory() as folder:
        name = os.fspath(case) if not isinstance(case, Mapping) else str(_write_case(case, pathlib.Path(folder)))
        results = pathlib.Path(out) if out is not None else pathlib.Path(folder) / "results"
        command = [str(program), "identify", name, "--out", str(results), "--json", f"--synthetic={synthetic}"]
        for wanted in [only] if isinstance(only, str) else only or []:
            command += ["--only", wanted]
        command += ["--start=" + ",".join(repr(float(number)) for number in start)] if start is not None else []
        command += ["--resume"] if resume else []
        return json.loads(_run(command).stdout)


def _program(what):
    if program := find_program():
        return program
    raise RuntimeError(f"{what}: there is no program springproof (allowed: on PATH, or named by the environment variable SPRINGPROOF)")


def _run(command):
    """A subcommand that ends with status 0 or 1."""
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode == 2:
        raise InputError(run.stderr.strip())
    if run.returncode == 130:
        raise KeyboardInterrupt
    if run.returncode not in (0, 1):
        raise RuntimeError(f"{command[0]} ended with status {run.returncode}: {run.stderr.strip()}")
    return run


def _with_models(name, models, ratios, program, folder):
    """The case with what the functions compute as [[external]]; what is computed lies beside it."""
    listed = subprocess.run([str(program), "list", name], capture_output=True, text=True)
    if listed.returncode != 0:
        raise InputError(listed.stderr.strip())
    files = listed.stdout.splitlines()
    if len(files) != 1:  # each case on an indented line
        raise InputError(f"{name} is a folder of {sum(line.startswith(' ') for line in files)} cases (allowed with models: one case)")
    problems = [p for p in _problems_of(files[0]) if ratios is None or any(abs(p[1].nu - nu) < 1e-9 for nu in ratios)]
    external = []
    for label, function in models.items():
        computed = []
        for body, material, forces, displacement in problems:
            file = folder / f"own_{len(external)}_{material.nu!r}.csv"
            file.write_text(_points_text(label, body, function(body, material, Loads(forces, displacement))), encoding="ascii")
            computed.append({"poisson_ratio": material.nu, "file": str(file)})
        if computed:
            external.append({"name": label, "files": computed})
    tree = _read_case(pathlib.Path(files[0]))
    tree["external"] = [*tree.get("external", []), *external]
    place = folder / pathlib.Path(files[0]).absolute().parent.name
    place.mkdir(exist_ok=True)
    return _write_case({**tree, "name": pathlib.Path(files[0]).stem}, place)


def _points_text(label, body, result):
    """Points and displacements as CSV, every digit."""
    points, displacement = result if isinstance(result, tuple) else (body.nodes, result)
    arrays = []
    for array, what in ((points, "points"), (displacement, "displacements")):
        array = numpy.asarray(array, dtype=float)
        if array.ndim != 2 or array.shape[1] != 3 or (arrays and len(array) != len(arrays[0])):
            rows = len(arrays[0]) if arrays else "n"
            raise InputError(f"models: '{label}': its {what} have shape {array.shape} (allowed: ({rows}, 3), or a tuple of points and displacements)")
        if not numpy.isfinite(array).all():
            raise InputError(f"models: '{label}': its {what} at row {numpy.argwhere(~numpy.isfinite(array))[0, 0]} are not finite (allowed: finite numbers [m])")
        arrays.append(array)
    lines = (",".join(map(repr, row)) for row in numpy.hstack(arrays).tolist())
    return "x,y,z,ux,uy,uz\n" + "\n".join(lines) + "\n"


def _read_case(file):
    """A case file as a dict, files by their full names."""
    try:
        import tomllib
    except ImportError:
        raise RuntimeError("compare: models beside those of a case need tomllib (allowed: Python 3.11 and later)") from None
    tree = tomllib.loads(file.read_text(encoding="utf-8"))
    beside = file.absolute().parent
    if (beside / tree["body"]["geo"]).is_file():
        tree["body"]["geo"] = str(beside / tree["body"]["geo"])
    entries = [m for m in tree.get("compare", {}).get("models", []) if isinstance(m, dict)] + tree.get("external", [])
    for entry in entries + [of for e in tree.get("external", []) for of in e.get("files", [])]:
        if "file" in entry:
            entry["file"] = str(beside / entry["file"])
    return tree


def _read_rows(file):
    if not file.is_file():
        return Rows()
    with open(file, newline="", encoding="utf-8") as text:
        rows = Rows(csv.DictReader(text))
    for row in rows:
        for key in _NUMBERS:
            row[key] = float(row[key]) if row[key] else None
        row["samples"] = int(row["samples"]) if row["samples"] else None
        row["published_where"] = row["published_where"] or None
    return rows


def _write_case(case, folder):
    """The case as TOML: each key of the top level on a line of its own."""
    tree = dict(case)
    name = str(tree.pop("name", "case"))
    if isinstance(body := tree.get("body"), Mapping) and os.path.isfile(str(body.get("geo", ""))):
        tree["body"] = {**body, "geo": os.path.abspath(body["geo"])}
    if isinstance(compared := tree.get("compare"), Mapping) and isinstance(compared.get("models"), (list, tuple)):
        tree["compare"] = {**compared, "models": [_absolute(model) for model in compared["models"]]}
    file = folder / f"{name}.toml"
    file.write_text("".join(f"{_text(key)} = {_toml(value, key)}\n" for key, value in tree.items()), encoding="utf-8")
    return file


def _absolute(model):
    return {**model, "file": os.path.abspath(model["file"])} if isinstance(model, Mapping) and "file" in model else model


def _text(value):
    return json.dumps(str(value), ensure_ascii=False)  # a string of JSON is one of TOML


def _toml(value, key):
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return _text(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(k)} = {_toml(v, f'{key}.{k}')}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(item, key) for item in value) + "]"
    raise InputError(f"{key}: is {value!r} (allowed: numbers, true or false, texts, lists and dicts)")
