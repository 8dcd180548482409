#!/usr/bin/env bash
# pip installs the package into a folder, without a package index, and the first lines of docs/python.md print there what the page says.
#   pip.sh PYTHON SOURCE-FOLDER [BUILD-FOLDER]     (a build tree whose library is taken instead of compiling one)
. "$(dirname "$0")/../cli/lib.sh"
python=$1 source=$2
[ -n "$python" ] && "$python" -c "import setuptools, numpy" 2>/dev/null && "$python" -m pip --version >/dev/null 2>&1 || { echo "no pip, setuptools or numpy for '$python'"; exit 77; }
[ -z "${3:-}" ] || export SPRINGPROOF_BUILD=$3
# pip writes beside what it installs: from a copy.
mkdir "$work/copy" && cd "$source" && cp -r CMakeLists.txt pyproject.toml setup.py README.md problem meshes msm fem_reference comparisons examples tests "$work/copy" || exit 1
cd "$work" || exit 1
"$python" -m pip install --no-build-isolation --no-index --no-deps --break-system-packages --target installed ./copy >log 2>&1 || { tail -50 log; exit 1; }

block() { awk -v wanted="$1" '/^```/ { if (!inside) ++number; inside = !inside; next } inside && number == wanted' "$source/docs/python.md"; }
block 1 >lines.py
block 2 >wanted
[ "$(wc -l <lines.py)" -eq 5 ] || fail "docs/python.md does not begin with five lines"
PYTHONPATH=$work/installed "$python" lines.py >printed || fail "the five lines"
diff printed wanted || fail "they print something else than docs/python.md"
for file in __init__.py springs.py _springproof.pyi geo/rabbit.geo geo/solids.inc; do
  [ -s "installed/springproof/$file" ] || fail "$file is not installed"
done
[ -e installed/springproof/py.typed ] || fail "py.typed is not installed"
PYTHONPATH=$work/installed "$python" -c "
import importlib.metadata, springproof
assert springproof.__file__.startswith('$work/installed'), springproof.__file__
print(importlib.metadata.version('springproof'))" || fail "it has no version"
exit $((failures > 0))
