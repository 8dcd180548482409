#!/usr/bin/env bash
# Advice for a block, for a body in cut cells, as JSON, and what is refused.   advise.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1

# check NAME PYTHON-EXPRESSION: of the advice `a`
check() {
  python3 - "$work/stdout" "$2" <<'PY' || fail "$1: $(head -c 2000 "$work/stdout")"
import json, sys
a = json.load(open(sys.argv[1]))
by = {m["model"]: m for m in a["models"]}
sys.exit(not eval(sys.argv[2]))
PY
}

cat >"$work/bar.toml" <<'TOML'
[body]
geo = "beam.geo"
size_m = [3, 1, 1]
cells = [6, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
force_N = [0, 0, 1]
[compare]
models = ["hybmss_avg"]
TOML
"$program" advise "$work/bar.toml" --error 0.03 --models hybmss_avg,hybmss,msm_18 --pilot-cells 300 --json >"$work/stdout" 2>"$work/stderr" ||
  fail "a case: status $?: $(cat "$work/stderr")"
check "a case: it bends" 'a["strain_energy"]["bending"] > 0.5 and abs(sum(a["strain_energy"].values()) - 1) < 1e-6'
check "a case: averaged springs reach it" 'a["models"][0]["model"] == "hybmss_avg" and a["models"][0]["reaches"]'
check "a case: averaged springs need fewer cells" 'by["hybmss_avg"]["cells_across"] < by["hybmss"]["cells_across"]'
check "a case: costs are measured" 'by["hybmss_avg"]["ms_per_step"] > 0 and by["hybmss_avg"]["seconds_per_solve"] > 0 and a["machine"]'
check "a case: springs of 1/4 are another solid" 'by["msm_18"]["own_poisson_ratio"] == 0.25 and not by["msm_18"]["reaches"]'
fem=${SPRINGPROOF_FEM_PROGRAM:-$(dirname "$program")/springproof-fem}
[ ! -x "$fem" ] || check "a case: finite elements are piloted" '{e["model"] for e in a["finite_elements"]} == {"fem_q1", "fem_q2"}'

"$program" advise "$work/bar.toml" --nu 0.49 --error 1e-4 --budget-seconds 1e-4 --models hybmss_avg --pilot-cells 300 >"$work/stdout" 2>"$work/stderr"
[ $? -eq 1 ] || fail "an error out of reach: status $?"
grep -q "No mass-spring model reaches 0.01 % within the budget" "$work/stdout" || fail "it does not say that none reaches it: $(cat "$work/stdout")"

# In cut cells: their steps are measured, so a budget that any machine meets is met.
cat >"$work/round.toml" <<'TOML'
[body]
geo = "cylinder.geo"
size_m = [1, 1, 3]
voxels = [300]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.47
[[load]]
on = "bottom"
displacement_m = [0, 0, 0]
[[load]]
on = "top"
force_N = [0, 0, -1]
[compare]
models = ["hybmss_avg"]
TOML
"$program" advise "$work/round.toml" --error 0.05 --budget-ms-per-step 1e6 --models hybmss_avg,hybmss_bt,hybmss,msm_18 --pilot-cells 300 --json >"$work/stdout" 2>"$work/stderr" ||
  fail "cut cells: status $?: $(cat "$work/stderr")"
check "cut cells: their step is measured" 'all(by[m]["ms_per_step"] > 1e-6 * by[m]["cells"] and by[m]["safe_step_s"] > 0 for m in ["hybmss_avg", "hybmss"])'
check "cut cells: nothing is over a budget that all meet" 'all(m["within_budget"] for m in a["models"])'
check "cut cells: no springs of another solid are named" '"msm_18" not in " ".join(a["words"])'
check "cells are whole numbers" 'all(isinstance(m["cells"], int) for m in a["models"])'

refused "nu: '0.5' .allowed" advise "$work/bar.toml" --nu 0.5
refused "first the smaller" advise "$work/bar.toml" --nu 0.4:0.2
refused "error" advise "$work/bar.toml" --error -1
refused "hybmss_avgg" advise "$work/bar.toml" --models hybmss_avgg
refused "CASE: there is none .allowed: a case file" advise --error 0.1
refused "cells-across: is for blocks" advise "$work/round.toml" --cells-across 4
refused "no_such_case" advise no_such_case
refused "is a folder" advise golec_2019
sed 's/x_min/x_top/' "$work/bar.toml" >"$work/mistaken.toml"
refused "mistaken.toml:.*x_top" advise "$work/mistaken.toml"
echo "not a file of measurements" >"$work/other.csv"
refused "other.csv:1:1: the heading" advise --measure-held-out "$work/other.csv"
grep -q "not a file" "$work/other.csv" || fail "a foreign file was overwritten"
exit $((failures > 0))
