#!/usr/bin/env bash
# pip installs the package into a folder, without a package index, and the five lines of docs/python.md run from there.
#   pip.sh PYTHON SOURCE-FOLDER [BUILD-FOLDER]     (a build tree whose library is taken instead of compiling one)
set -u
python=$1 source=$2
[ -n "$python" ] && "$python" -c "import pip, setuptools, numpy" 2>/dev/null || { echo "no pip, setuptools or numpy for '$python'"; exit 77; }
[ -z "${3:-}" ] || export SPRINGPROOF_BUILD=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# pip writes beside what it installs: from a copy.
mkdir "$work/copy" && cd "$source" && cp -r CMakeLists.txt pyproject.toml setup.py README.md problem meshes msm fem_reference comparisons examples tests "$work/copy" || exit 1
cd "$work" || exit 1
"$python" -m pip install --no-build-isolation --no-index --no-deps --break-system-packages --target installed ./copy >log 2>&1 || { tail -50 log; exit 1; }
awk '/^```python$/ { inside = 1; next } /^```/ { if (inside) exit } inside' "$source/docs/python.md" >five_lines.py
[ "$(wc -l <five_lines.py)" -eq 5 ] || { echo "FAILED: docs/python.md does not begin with five lines"; exit 1; }
PYTHONPATH=$work/installed "$python" five_lines.py >printed || exit 1
cat printed
grep -q -- '-0.0004' printed || { echo "FAILED: another deflection"; exit 1; }
for file in __init__.py py.typed _springproof.pyi geo/rabbit.geo; do
  [ -s "installed/springproof/$file" ] || [ "$file" = py.typed ] && [ -e "installed/springproof/$file" ] || { echo "FAILED: $file is not installed"; exit 1; }
done
"$python" - <<'END' || exit 1
import importlib.metadata, sys
sys.path.insert(0, "installed")
assert importlib.metadata.version("springproof")
import springproof
assert springproof.__file__.startswith(__import__("os").getcwd() + "/installed")
END
exit 0
