#!/usr/bin/env bash
# Displacements of another program beside the models ([[external]]): those of a model of ours give its row again; what is refused.
#   external.sh PROGRAM
. "$(dirname "$0")/../cli/lib.sh"
program=$1
cd "$work" || exit 1

# make NAME MODELS: a cantilever under its weight, with more appended from standard input
make() {
  cat >"$1.toml" <<TOML
[body]
geo = "beam.geo"
size_m = [0.4, 0.1, 0.1]
cells = [[8, 2, 2], [16, 4, 4]]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = [0.25, 0.4]
density_kg_m3 = 1000
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[compare]
models = [$2]
measures = ["displacement_error", "displacement_error_max", "volume_change", "reaction", "probe"]
[[probe]]
name = "tip"
at_m = [0.4, 0.05, 0.05]
[reference]
cells = [16, 4, 4]
TOML
  cat >>"$1.toml"
}

# value OUT MODEL NU CELLS MEASURE
value() { entry "$1/results.csv" value "model=$2" "poisson_ratio=$3" "cells=$4" "measure=$5"; }
same() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; s = b < 0 ? -b : b; exit !(a != "" && b != "" && (d < 0 ? -d : d) <= t * s) }' || fail "$4: $1, not $2"
}

make own '"hybmss_avg"' </dev/null
"$program" compare own.toml --jobs 1 --quiet --vtu --out own >log 2>&1 || fail "own.toml: $(cat log)"
csv=own/vtu/own/hybmss_avg_nu0.25_8x2x2.csv
[ "$(wc -l <$csv)" -eq 82 ] || fail "$(ls own/vtu/own)"
if [ -x "$(dirname "$program")/springproof-fem" ]; then  # the reference's own mesh: 16 x 4 x 4 elements of 27 nodes
  for nu in 0.25 0.4; do
    grep -q 'NumberOfPoints="2673" NumberOfCells="256"' own/vtu/own/reference_q2_nu$nu.vtu && grep -q 'Name="von_mises"' own/vtu/own/reference_q2_nu$nu.vtu ||
      fail "no file of the reference at nu = $nu: $(ls own/vtu/own)"
    grep -q "reference_q2_nu$nu.vtu" own/vtu/own/reference_q2.pvd || fail "no series of the reference"
  done
fi

# A file of our own result, in other units and axes, and one at nodes that are not the lattice's.
awk -F, 'NR == 1 { print "id;X;Y;Z;x;y;z"; next } { printf "%d;%.17g;%.17g;%.17g;%.17g;%.17g;%.17g\n", NR, 1000 * ($1 + $4), 1000 * ($3 + $6), -1000 * ($2 + $5), 1000 * $1, 1000 * $3, -1000 * $2 }' $csv >turned.csv
fine=own/vtu/own/hybmss_avg_nu0.4_16x4x4.csv
awk -F, 'NR == 1 || ($1 < 0.3999 && $1 > 1e-4 && NR % 7 > 0) || ($1 <= 1e-4 || $1 >= 0.3999)' $fine >holes.csv
make both '"hybmss_avg"' <<TOML
[[external]]
name = "same"
file = "$csv"
poisson_ratio = 0.25
reaction_N = { x_min = [0, 0, 39.24] }
[[external]]
name = "turned"
file = "turned.csv"
poisson_ratio = 0.25
scale = 0.001
up_axis = "y"
[[external]]
name = "holes"
file = "holes.csv"
poisson_ratio = 0.4
[[external]]
name = "ratios"
springs = false
files = [{ poisson_ratio = 0.25, file = "$csv" }, { poisson_ratio = 0.4, file = "$fine" }]
[[expect]]
model = "same"
measure = "displacement_error"
source = "analytic"
value = 0
within = 0.2
TOML
"$program" compare both.toml --jobs 1 --out both >log 2>&1 || fail "both.toml: $(cat log)"
for measure in displacement_error displacement_error_max volume_change displacement.tip.z; do
  for name in same turned; do
    tolerance=1e-9
    same "$(value both $name 0.25 8x2x2 $measure)" "$(value both hybmss_avg 0.25 8x2x2 $measure)" $tolerance "$name $measure"
    [ -z "$(value both $name 0.25 16x4x4 $measure)$(value both $name 0.4 8x2x2 $measure)" ] || fail "$name is compared elsewhere too"
  done
done
# One label at two Poisson's ratios, each at the lattice of its points.
for at in "0.25 8x2x2" "0.4 16x4x4"; do
  # shellcheck disable=SC2086
  same "$(value both ratios $at displacement.tip.z)" "$(value both hybmss_avg $at displacement.tip.z)" 1e-9 "one label, at $at"
done
grep -q "\"made_of\": \"another program's, for comparison\"" both/results.json && grep -q '"made_of": "springs of another program"' both/results.json &&
  grep -q '"made_of": "a term per cell"' both/results.json || fail "results.json does not say what the models are made of"
same "$(value both same 0.25 8x2x2 force.x_min.z)" 39.24 1e-12 "the reaction"
[ -z "$(value both turned 0.25 8x2x2 force.x_min.z)" ] || fail "a reaction that was not given"
# Nodes without a point: the displacement is that of the points around, the volume is not measured.
same "$(value both holes 0.4 16x4x4 displacement.tip.z)" "$(value both hybmss_avg 0.4 16x4x4 displacement.tip.z)" 2e-3 "holes"
[ -z "$(value both holes 0.4 16x4x4 volume_change)" ] || fail "a volume change between points"
grep -q '1 of 1 expectations hold' log || fail "the verdict: $(cat log)"
grep -qE '^  same +[0-9.]+ ± [0-9.]+ % both at ν = 0.25' log || fail "no line for the file: $(cat log)"
grep -q '"kind": "external"' both/results.json && grep -q '81 points of hybmss_avg_nu0.25_8x2x2.csv, at 81 of 81 nodes' both/results.json || fail "results.json"
grep -q '"same"' both/report.html || fail "the report"
"$program" export both.toml --to springs --out springs.json >log 2>&1 || fail "export: $(cat log)"

# spoilt PATTERN [COMMAND-FOR-AWK]: the file of the first case, spoilt
spoilt() {
  awk -F, -v OFS=, "$2" $csv >spoilt.csv
  make spoilt '"hybmss_avg"' <<TOML
[[external]]
name = "spoilt"
file = "spoilt.csv"
poisson_ratio = 0.25
${3:-}
TOML
  "$program" compare spoilt.toml --quiet --out refused >log 2>&1
  local status=$?
  [ $status -eq 2 ] && [ "$(wc -l <log)" -eq 1 ] && grep -qE -- "$1" log && [ ! -e refused ] || fail "$2: status $status: $(head -c 600 log)"
}
spoilt 'spoilt.csv:3:[0-9]+: is .nan. \(allowed: a finite number' 'NR == 3 { $5 = "nan" } 1'
spoilt "spoilt.csv:1:1: there is no column 'uz'.*did you mean 'u_z'" 'NR == 1 { $6 = "u_z" } 1'
spoilt 'spoilt.csv: the points span 400 x 100 x 100 m, the body 0.4 x 0.1 x 0.1 m: 1000 times too large.*perhaps scale = 0.001\)' 'NR > 1 { for (i = 1; i <= 6; ++i) $i *= 1000 } 1'
spoilt 'spoilt.csv:5:1: the displacement is [0-9.e+]+ m, and the body spans' 'NR == 5 { $6 = 1e3 } 1'
spoilt 'spoilt.csv:2:1: the point .* is .* from the nearest node of the body, which reaches from \(0, 0, 0\) to \(0.4, 0.1, 0.1\) m' 'NR > 1 { $3 += 0.3 } 1'
spoilt "spoilt.csv: there is no point near the patch 'x_max'" 'NR == 1 || $1 < 0.33'
spoilt 'spoilt.csv: there is no point near .0.(15|2), 0, 0. m, where the body is compared' 'NR == 1 || $1 < 0.11 || $1 > 0.29'
spoilt 'spoilt.csv:2:[0-9]+: poisson_ratio is 0.4, and ..external.. is of a solid of 0.25' 'NR == 1 { print $0, "poisson_ratio"; next } { print $0, 0.4 }'
spoilt "spoilt.toml:[0-9]+:[0-9]+: external.reaction_N: the body has no patch 'x_mim'.*did you mean 'x_min'" 1 'reaction_N = { x_mim = [0, 0, 1] }'
spoilt 'spoilt.csv:1:1: there is no point' 'NR == 1'
spoilt 'spoilt.csv:1:1: the file has no header: its first line holds numbers \(needed: a header with x, y, z' 'NR > 1'
# A body that lies elsewhere, by less than a cell, or is longer: what is compared is extrapolated.
spoilt 'spoilt.csv: the points reach along x from 0.03 to 0.43 m, the body from 0 to 0.4 m \(allowed: ends that differ by up to 0.025 m' 'NR > 1 { $1 += 0.03 } 1'
spoilt 'spoilt.csv: the points reach along y from -0.03 to 0.07 m, the body from 0 to 0.1 m' 'NR > 1 { $2 -= 0.03 } 1'
spoilt 'spoilt.csv: the points reach along z from 0 to 0.16 m' 'NR > 1 { $3 *= 1.6 } 1'
# Two states of the body in a file.
spoilt 'spoilt.csv:[0-9]+:1: is the point of line [0-9]+ with another displacement' 'NR == 1 { print; next } { print; $4 = $5 = $6 = 0; print }'

# Displacements in another unit than the positions: compared as they are, with a word.
make units '"hybmss_avg"' <<TOML
[[external]]
name = "metres"
file = "metres.csv"
poisson_ratio = 0.25
[[external]]
name = "ours"
file = "$csv"
poisson_ratio = 0.25
TOML
awk -F, -v OFS=, 'NR > 1 { for (i = 4; i <= 6; ++i) $i /= 1000 } 1' $csv >metres.csv
"$program" compare units.toml --quiet --out units >log 2>&1 || fail "units.toml: $(cat log)"
grep -q '^note: units  nu0.25: metres: the displacements are 0.001 times those of the reference; displacements in m taken for mm, or a modulus in Pa taken for kPa would explain it' log || fail "no word on units: $(cat log)"
grep -q 'note: .*ours' log && fail "a word on units that are right"
make spoilt '"hybmss"' <<<$'[[external]]\nname = "none"\nfile = "none.csv"\npoisson_ratio = 0.4'
"$program" compare spoilt.toml --quiet --out refused >log 2>&1
[ $? -eq 2 ] && grep -q 'none.csv: no such file' log && [ ! -e refused ] || fail "a missing file: $(cat log)"
exit $((failures > 0))
