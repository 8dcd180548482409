"""The program springproof: comparisons with finite elements."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterable, Mapping

from ._springproof import InputError

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


def compare(
    case: "str | os.PathLike[str] | Mapping[str, object]",
    *,
    poisson_ratio: "float | Iterable[float] | None" = None,
    out: "str | os.PathLike[str] | None" = None,
    jobs: "int | None" = None,
    resume: bool = False,
) -> "list[dict[str, object]]":
    """Models beside finite elements: runs `springproof compare` and returns the rows of its results.csv.

    case: a case file, the name of a built-in case or folder, or a case as a dict of the keys of a case file, whose files are
    relative to the working directory.  poisson_ratio: only these of the case's.  out: a folder that keeps report.html,
    results.csv and results.json; by default nothing is kept.  jobs: parts to run at once.  resume: take finished parts from
    `out`.

    A row has the columns of docs/results.md: case, kinematics, model, poisson_ratio, cells, measure, value, unit, reference,
    reference_uncertainty, error, samples, spread, published, published_where.  Numbers are floats (samples: int), None where
    there is none.  pandas.DataFrame(rows) takes them.

    Raises InputError with the program's message if the input cannot be used; warns where an [[expect]] of the case does not
    hold or a run has no result.
    """
    program = find_program()
    if not program:
        raise RuntimeError("compare: there is no program springproof (allowed: on PATH, or named by the environment variable SPRINGPROOF)")
    with tempfile.TemporaryDirectory() as folder:
        name = os.fspath(case) if not isinstance(case, Mapping) else str(_write_case(case, pathlib.Path(folder)))
        results = pathlib.Path(out) if out is not None else pathlib.Path(folder) / "results"
        command = [str(program), "compare", name, "--out", str(results), "--quiet"]
        if poisson_ratio is not None:
            ratios = poisson_ratio if isinstance(poisson_ratio, Iterable) else [poisson_ratio]
            command.append("--poisson-ratio=" + ",".join(repr(float(ratio)) for ratio in ratios))
        command += [f"--jobs={jobs}"] if jobs is not None else []
        command += ["--resume"] if resume else []
        run = subprocess.run(command, capture_output=True, text=True)
        said = run.stderr.strip()
        if run.returncode == 2:
            raise InputError(said)
        if run.returncode == 130:
            raise KeyboardInterrupt
        if run.returncode not in (0, 1):
            raise RuntimeError(f"{program} ended with status {run.returncode}: {said}")
        rows = _read_rows(results / "results.csv")
        if run.returncode == 1:
            warnings.warn(f"springproof compare {name}: {said or run.stdout.strip()}", stacklevel=2)
        return rows


def _read_rows(file):
    if not file.is_file():
        return []
    with open(file, newline="", encoding="utf-8") as text:
        rows = list(csv.DictReader(text))
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
