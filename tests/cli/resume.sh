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
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [-0.5, 0.0, 0.25, 0.4]
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
[compare]
models = ["hybmss"]
[reference]
cells = [4, 4, 4]
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
# at_work FOLDER: a comparison that has finished a part and is at the next one; its process is $pid.
at_work() {
  FOLDER=$1 FEM=$(dirname "$program")/springproof-fem SPRINGPROOF_FEM_PROGRAM=$(dirname "$0")/one_part_fem \
    "$program" compare "$work/case.toml" --out "$1" --jobs 1 2>"$work/log.first" >/dev/null &
  pid=$!
  until compgen -G "$1/parts/*nu*.cbor" >/dev/null; do
    kill -0 $pid 2>/dev/null || fail "a comparison ended before its first part"
    sleep 0.05
  done
}
at_work "$work/out"
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "an interrupted run should end with 130"
[ ! -e "$work/out/report.html" ] || fail "an interrupted run should not leave a report"
kept=$(ls "$work/out/parts" | wc -l)
[ "$kept" -eq 1 ] || fail "$kept of 4 parts kept"
"$program" compare "$work/case.toml" --out "$work/out" --resume 2>"$work/log" >/dev/null || fail "resuming failed"
[ "$(grep -c 'kept from before' "$work/log")" -eq "$kept" ] || fail "not all $kept parts were taken back"
[ -s "$work/out/report.html" ] && [ -s "$work/out/results.csv" ] || fail "no results"
cp "$work/out/results.csv" "$work/resumed.csv"
"$program" compare "$work/case.toml" --out "$work/out" 2>"$work/log" >/dev/null || fail "running afresh failed"
cmp -s "$work/resumed.csv" "$work/out/results.csv" || fail "a resumed run gives other numbers than a fresh one"

# A first interrupt waits for the model that is being solved, a second does not.
sed -e '/^\[reference\]/,$d' -e 's/^models.*/&\nmeasures = ["motion"]/' "$work/case.toml" >"$work/long.toml"
printf '[reference]\nelements = []\n[dynamics]\nduration_s = 1e6\nequilibrium = false\n' >>"$work/long.toml"
sed -i -e '1i kinematics = "hencky"' -e 's/^poisson_ratio.*/&\ndensity_kg_m3 = 1000/' "$work/long.toml"
"$program" compare "$work/long.toml" --out "$work/long" --jobs 1 >"$work/log" 2>&1 &
pid=$!
until [ -e "$work/long/parts" ]; do kill -0 $pid 2>/dev/null || fail "a long motion ended at once"; sleep 0.05; done
sleep 1
kill -INT $pid
sleep 0.5
kill -0 $pid 2>/dev/null || fail "a first interrupt should wait for the model"
kill -INT $pid
for _ in $(seq 20); do kill -0 $pid 2>/dev/null || break; sleep 0.1; done
kill -0 $pid 2>/dev/null && { kill -9 $pid; fail "a second interrupt should end a run at once"; }
wait $pid
[ $? -eq 130 ] || fail "a run that is interrupted twice should end with 130"

# A flipped bit is found wherever it lies, and the part computed anew; the others are kept.
part=$(ls "$work"/out/parts/*nu0.25* | head -1)
size=$(stat -c %s "$part")
for at in 3 25 $((size / 2)) $((size - 1)); do
  byte=$(od -An -tu1 -j "$at" -N 1 "$part")
  printf "\\x$(printf %x $((byte ^ 1)))" | dd of="$part" bs=1 seek="$at" conv=notrunc status=none
  "$program" compare "$work/case.toml" --out "$work/out" --resume 2>"$work/log" >/dev/null || fail "resuming with a damaged part failed"
  grep -q "nu0.25.cbor is damaged; this part is computed anew" "$work/log" || fail "byte $at: the damage is not said"
  [ "$(grep -c 'kept from before' "$work/log")" -eq 3 ] || fail "byte $at: not all other parts were taken back"
  cmp -s "$work/resumed.csv" "$work/out/results.csv" || fail "byte $at: a damaged part gives other numbers"
done

# Folders in use; the lock of a killed program holds nobody.
at_work "$work/busy"
"$program" compare "$work/case.toml" --out "$work/busy" --resume 2>"$work/log" >/dev/null
[ $? -eq 2 ] && grep -q "^error: --out: .*busy is in use by another springproof" "$work/log" || fail "two at a time in one folder"
kill -KILL $pid
wait $pid 2>/dev/null
"$program" compare "$work/case.toml" --out "$work/busy" --resume 2>"$work/log" >/dev/null || fail "the lock of a killed program holds"

# What a script includes counts as its own text.
sed -i 's/\[-0.5.*\]/0.25/; s/block.geo/own.geo/' "$work/case.toml"
block=$(dirname "$0")/../../meshes/geo/block.geo
cp "$block" "$work/deep.geo"
echo 'Include "between.geo";' >"$work/own.geo"
echo 'Include "deep.geo";' >"$work/between.geo"
again() { "$program" compare "$work/case.toml" --out "$work/script" --resume 2>"$work/log" >/dev/null || fail "the script's case failed"; }
again
again
grep -q 'kept from before' "$work/log" || fail "nothing has changed, but the part is not taken back"
echo '// changed' >>"$work/deep.geo"
again
grep -q 'kept from before' "$work/log" && fail "a part is kept although a file that its script includes has changed"

# Any bytes in a name; the results are UTF-8.
latin=$work/$(printf 'K\xf6rper')
mkdir "$latin"
sed 's/own.geo/block.geo/' "$work/case.toml" >"$latin/case.toml"
"$program" compare "$latin/case.toml" --out "$latin/out" 2>"$work/log" >/dev/null || fail "a folder with a name in Latin-1"
iconv -f UTF-8 -t UTF-8 "$latin/out/results.json" >/dev/null || fail "results.json is no UTF-8"
iconv -f UTF-8 -t UTF-8 "$latin/out/report.html" >/dev/null || fail "report.html is no UTF-8"

echo "resumed after $kept of 4 parts"
