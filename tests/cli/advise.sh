#!/usr/bin/env bash
# Advice for a block, for a case, as JSON, and what is refused.   advise.sh PROGRAM
set -u
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

# check NAME PYTHON-EXPRESSION: of the advice `a`
check() {
  python3 - "$work/stdout" "$2" <<'PY' || fail "$1: $(head -c 2000 "$work/stdout")"
import json, sys
a = json.load(open(sys.argv[1]))
by = {m["model"]: m for m in a["models"]}
sys.exit(not eval(sys.argv[2]))
PY
}

"$program" advise --nu 0.3:0.45 --load bending --slenderness 6 --error 0.05 --models hybmss_avg,hybmss --json >"$work/stdout" 2>"$work/stderr" ||
  fail "bending: status $?: $(cat "$work/stderr")"
check "bending: averaged springs need fewer cells" 'by["hybmss_avg"]["reaches"] and by["hybmss_avg"]["cells_across"] < by["hybmss"]["cells_across"]'
check "bending: costs are measured" 'by["hybmss_avg"]["ms_per_step"] > 0 and by["hybmss_avg"]["seconds_per_solve"] > 0 and a["machine"]'

"$program" advise --nu 0.49 --load bending --error 1e-4 --budget-seconds 1e-4 --models hybmss_avg >"$work/stdout" 2>"$work/stderr"
[ $? -eq 1 ] || fail "an error out of reach: status $?"
grep -q "No mass-spring model reaches 0.01 % within the budget" "$work/stdout" || fail "it does not say that none reaches it: $(cat "$work/stdout")"

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
"$program" advise "$work/bar.toml" --error 0.03 --models hybmss_avg,msm_18 --pilot-cells 300 --json >"$work/stdout" 2>"$work/stderr" ||
  fail "a case: status $?: $(cat "$work/stderr")"
check "a case: it bends" 'a["strain_energy"]["bending"] > 0.5 and abs(sum(a["strain_energy"].values()) - 1) < 1e-6'
check "a case: averaged springs reach it" 'a["models"][0]["model"] == "hybmss_avg" and a["models"][0]["reaches"]'

# refused PATTERN ARGUMENTS...
refused() {
  local pattern=$1
  shift
  "$program" advise "$@" >"$work/stdout" 2>"$work/stderr"
  [ $? -eq 2 ] && grep -qE "$pattern" "$work/stdout" "$work/stderr" || fail "not refused: $* ($(cat "$work/stderr"))"
}
refused "nu: '0.5' .allowed" --nu 0.5
refused "first the smaller" --nu 0.4:0.2
refused "error" --error -1
refused "load" --load twisting
refused "hybmss_avgg" --models hybmss_avgg
refused "no_such_case" no_such_case
refused "is a folder" golec_2019
sed 's/x_min/x_top/' "$work/bar.toml" >"$work/mistaken.toml"
refused "mistaken.toml:.*x_top" "$work/mistaken.toml"
echo "not a file of measurements" >"$work/other.csv"
refused "other.csv:1:1: the heading" --measure "$work/other.csv"
grep -q "not a file" "$work/other.csv" || fail "a foreign file was overwritten"
exit $((failures > 0))
