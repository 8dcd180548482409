"""Springs files as models."""

import json
import os
import zipfile

import numpy

from . import _springproof


def read_springs(file: "str | os.PathLike[str]") -> "_springproof.Model":
    """The model of a springs file (.json, .npz), as docs/springs_file.md describes it; it has no body.

    Raises InputError naming the place in the file, what is wrong and what is allowed.
    """
    name = os.fspath(file)
    if not name.endswith((".json", ".npz")):
        raise _springproof.InputError(f"{name}: cannot read springs from it (allowed: .json, .npz)")
    if not os.path.isfile(name):
        raise _springproof.InputError(f"{name}: no such file")
    if name.endswith(".json"):
        with open(name, encoding="utf-8") as text:
            return _springproof._parse_springs(text.read(), name)
    try:
        with numpy.load(name, allow_pickle=False) as arrays:
            tree = _with_lists(json.loads(bytes(arrays["springs.json"])), arrays)
    except (KeyError, ValueError, OSError, zipfile.BadZipFile) as error:
        raise _springproof.InputError(f"{name}: is no springs file: {error}") from None
    return _springproof._parse_springs(json.dumps(tree), name)


def _with_lists(value, arrays):
    """A tree with the arrays that "npy:NAME" stands for."""
    if isinstance(value, dict):
        return {key: _with_lists(inner, arrays) for key, inner in value.items()}
    if isinstance(value, str) and value.startswith("npy:"):
        return arrays[value[4:]].tolist()
    return value
