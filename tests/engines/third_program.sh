#!/usr/bin/env bash
# GetFEM on a coarse grid gives what is kept of a finer one to 3 %: a bent bar with Taylor and Hood's elements.
#   third_program.sh SOURCE-FOLDER
# Exit status 77, skipped, without GetFEM for Debian's Python.
. "$(dirname "$0")/../cli/lib.sh"
/usr/bin/python3 -c "import getfem, numpy, tomllib" 2>/dev/null || { echo "GetFEM is not installed (apt-get install python3-getfem)"; exit 77; }
kept=$1/comparisons/experiments/getfem
case=bending_near_incompressible
/usr/bin/python3 -B "$1/examples/judges/getfem_judge.py" "$kept/$case.toml" "$work/$case.csv" 4 1 1 >"$work/out" 2>"$work/err" || fail "$case" "$work/err"
grep -q "displacement: uncertain by" "$work/out" || fail "$case states no uncertainty" "$work/out"
paste -d, "$work/$case.csv" "$kept/$case.csv" | awk -F, 'NR > 1 { for (c = 4; c <= 6; ++c) { off += ($c - $(c + 6))^2; all += $(c + 6)^2 } }
  END { exit !(NR > 100 && off < 0.03^2 * all) }' || fail "$case: not what is kept"
exit $((failures > 0))
