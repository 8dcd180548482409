"""The stub names what the module has, with the same parameters and defaults, and the module says what it does."""
import ast
import inspect
import pathlib
import re
import subprocess
import sys

import springproof as sp
from springproof import _springproof

STUB = ast.parse((pathlib.Path(sp.__file__).parent / "_springproof.pyi").read_text())
INHERITED = {"__init__"}


def parameters_of_stub(function):
    a = function.args
    plain = a.posonlyargs + a.args
    defaults = [None] * (len(plain) - len(a.defaults)) + a.defaults
    out = [(p.arg, ast.unparse(d) if d else None) for p, d in zip(plain, defaults)]
    out += [("*", None)] if a.kwonlyargs else []
    out += [(p.arg, ast.unparse(d) if d else None) for p, d in zip(a.kwonlyargs, a.kw_defaults)]
    return out + ([("**" + a.kwarg.arg, None)] if a.kwarg else [])


def parameters_of_module(function):
    """From the first line that pybind11 writes: "name(self: T, x: U = default, *, y: V) -> W"."""
    text = re.match(r"\w+\((.*)\) -> ", function.__doc__).group(1)
    parts, depth, part = [], 0, ""
    for c in text:
        depth += (c in "[({<") - (c in "])}>")
        if c == "," and depth == 0:
            parts, part = parts + [part.strip()], ""
        else:
            part += c
    out = []
    for part in parts + ([part.strip()] if part.strip() else []):
        name, _, rest = part.partition(":")
        default = rest.rpartition(" = ")[2] if " = " in rest else None
        out.append((name.strip(), default))
    return out


def stub_members(body):
    return {node.name: node for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def test_the_same_names():
    names = {name for name in vars(_springproof) if not name.startswith("__")}
    assert names == set(stub_members(STUB.body))
    assert set(sp.__all__) - {"compare", "find_program", "identify", "read_springs"} == {name for name in names if not name.startswith("_")}


def test_the_same_members_parameters_and_defaults():
    for name, node in stub_members(STUB.body).items():
        own = getattr(_springproof, name)
        if isinstance(node, ast.FunctionDef):
            assert parameters_of_module(own) == parameters_of_stub(node), name
            continue
        if issubclass(own, Exception):
            assert ast.unparse(node.bases[0]) == own.__mro__[1].__name__
            continue
        members = stub_members(node.body)
        made = {key for key in vars(own) if not key.startswith("__") or (key == "__init__" and "__init__" in members)}
        made -= {"_pybind11_conduit_v1_"}
        assert made == set(members), name
        for key, member in members.items():
            value = inspect.getattr_static(own, key)
            assert isinstance(value, property) == is_property(member), f"{name}.{key}"
            if not is_property(member):
                assert parameters_of_module(getattr(own, key)) == parameters_of_stub(member), f"{name}.{key}"


def test_everything_is_described():
    for name in sp.__all__:
        value = getattr(sp, name)
        assert value.__doc__ and len(value.__doc__.strip()) > 10, name
        assert "springproof::" not in value.__doc__, name
        assert value.__module__ == "springproof", name
    for name in ("Model", "Motion", "State"):
        for key, member in vars(getattr(sp, name)).items():
            assert key.startswith("_") or key == "solver" or member.__doc__, f"{name}.{key}"
    page = pathlib.Path(__file__).parents[2] / "docs" / "python.md"
    missing = [name for name in sp.__all__ if f"`{name}" not in page.read_text()]
    assert not missing, f"docs/python.md lacks {missing}"


def test_without_the_compiled_part_the_remedy_is_named(tmp_path):
    package = tmp_path / "springproof"
    package.mkdir()
    for file in pathlib.Path(sp.__file__).parent.glob("*.py"):
        (package / file.name).write_text(file.read_text())
    run = subprocess.run([sys.executable, "-c", "import springproof"], capture_output=True, text=True, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)})
    assert run.returncode != 0 and "./quickstart.sh python" in run.stderr and sys.executable in run.stderr
