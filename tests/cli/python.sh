#!/usr/bin/env bash
# The Python package in the build tree, by pytest; 77 where it is not built, or pytest is missing.
#   python.sh PYTHON PACKAGE-FOLDER SOURCE-FOLDER TEST-FILE...
set -u
python=$1 package=$2 source=$3
shift 3
[ -n "$python" ] && ls "$package"/springproof/_springproof.*.so >/dev/null 2>&1 || { echo "the Python package is not built"; exit 77; }
"$python" -c "import pytest" 2>/dev/null || { echo "no pytest for $python"; exit 77; }
export PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1
"$python" -m pytest -q -p no:cacheprovider --rootdir "$source/tests/python" "${@/#/$source/tests/python/}"
status=$?
[ $status -eq 5 ] && exit 77  # every test skipped
exit $status
