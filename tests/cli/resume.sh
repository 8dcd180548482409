#!/usr/bin/env bash
# An interrupted comparison keeps what is finished and goes on from there.   resume.sh PROGRAM
set -u
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/case.toml" <<'TOML'
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [4, 4, 4]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [-0.5, 0.0, 0.1, 0.2, 0.25, 0.3, 0.35, 0.4]
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
[reference]
cells = [12, 12, 12]
[[expect]]
model = "hybmss"
measure = "displacement_error"
source = "extrapolated FEM"
within = 0.5
TOML
fail() {
  echo "FAILED: $1"
  cat "$work/log"
  exit 1
}
"$program" compare "$work/case.toml" --out "$work/out" --jobs 1 2>"$work/log" >/dev/null &
pid=$!
for _ in $(seq 600); do
  [ -n "$(ls "$work/out/parts" 2>/dev/null)" ] && break
  sleep 0.1
done
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "an interrupted run should end with 130"
[ ! -e "$work/out/report.html" ] || fail "an interrupted run should not leave a report"
kept=$(ls "$work/out/parts" | wc -l)
[ "$kept" -gt 0 ] && [ "$kept" -lt 8 ] || fail "$kept of 8 parts kept"
"$program" compare "$work/case.toml" --out "$work/out" --resume 2>"$work/log" >/dev/null || fail "resuming failed"
[ "$(grep -c 'kept from before' "$work/log")" -eq "$kept" ] || fail "not all $kept parts were taken back"
[ -s "$work/out/report.html" ] && [ -s "$work/out/results.csv" ] || fail "no results"
cp "$work/out/results.csv" "$work/resumed.csv"
"$program" compare "$work/case.toml" --out "$work/out" 2>"$work/log" >/dev/null || fail "running afresh failed"
cmp -s "$work/resumed.csv" "$work/out/results.csv" || fail "a resumed run gives other numbers than a fresh one"
echo "resumed after $kept of 8 parts"
