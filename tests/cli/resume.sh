#!/usr/bin/env bash
# An interrupted comparison keeps what is finished and goes on from there.   resume.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
{ small_case '[-0.5, 0.0, 0.25, 0.4]'; cat <<'TOML'; } >"$work/case.toml"
[[expect]]
model = "hybmss"
measure = "displacement_error"
source = "extrapolated FEM"
within = 0.5
TOML
# at_work FOLDER [MORE]: a comparison that has finished a part, and the models and MORE grids of the next; its process is $pid.
at_work() {
  FOLDER=$1 MORE=${2:-0} FEM=$(dirname "$program")/springproof-fem SPRINGPROOF_FEM_PROGRAM=$(dirname "$0")/one_part_fem \
    "$program" compare "$work/case.toml" --out "$1" --jobs 1 2>"$work/log.first" >/dev/null &
  pid=$!
  until [ "$(cat "$1.asked" 2>/dev/null | wc -l)" -gt "${2:-0}" ]; do
    kill -0 $pid 2>/dev/null || stop "a comparison ended before its first part"
    sleep 0.05
  done
}
# ended_by SIGNAL: the comparison $pid, whatever it is at, which by itself would never end.
ended_by() {
  kill -"$1" $pid
  for _ in $(seq 600); do kill -0 $pid 2>/dev/null || break; sleep 0.1; done
  kill -0 $pid 2>/dev/null && { kill -9 $pid; stop "$1 does not end a run"; }
  wait $pid
  [ $? -eq 130 ] || stop "a run that is ended by $1 should end with 130"
}
at_work "$work/out" 2
ended_by INT
[ ! -e "$work/out/report.html" ] || stop "an interrupted run should not leave a report"
kept=$(ls "$work/out/parts" | grep -c 'nu.*cbor$')
[ "$kept" -eq 1 ] || stop "$kept of 4 parts kept"
# Of the part at hand what is finished: its model and two grids.
[ "$(ls "$work"/out/parts/*.runs | grep -c '^model')" -eq 1 ] && [ "$(ls "$work"/out/parts/*.runs | grep -c '^grid')" -eq 2 ] ||
  stop "kept of the part at hand: $(ls "$work"/out/parts/*.runs)"
grep -q "^interrupted; what is finished is kept in $work/out: the same command with --resume goes on from there" "$work/log.first" || stop "it is not said: $(cat "$work/log.first")"
# asked FOLDER [OPTION]: how many grids a comparison into the folder solves.
cat >"$work/counting_fem" <<COUNT
#!/usr/bin/env bash
[ "\$1" = --version ] || echo grid >>"$work/asked"
exec "$(dirname "$program")/springproof-fem" "\$@"
COUNT
chmod +x "$work/counting_fem"
asked() {
  : >"$work/asked"
  SPRINGPROOF_FEM_PROGRAM=$work/counting_fem "$program" compare "$work/case.toml" --jobs 1 --out "$@" 2>"$work/log" >/dev/null || stop "comparing into $* failed"
  wc -l <"$work/asked"
}
damaged=$(ls "$work"/out/parts/*.runs/grid* | head -1)
printf x >>"$damaged"
resumed=$(asked "$work/out" --resume) || exit 1
grep -q "$(basename "$damaged") is damaged; this run is made anew" "$work/log" || stop "a damaged run is not noted: $(cat "$work/log")"
[ "$(grep -c 'kept from before' "$work/log")" -eq "$kept" ] || stop "not all $kept parts were taken back"
[ -s "$work/out/report.html" ] && [ -s "$work/out/results.csv" ] || stop "no results"
[ -z "$(ls "$work/out/parts" | grep -v 'cbor$')" ] || stop "left of finished parts: $(ls "$work/out/parts")"
cp "$work/out/results.csv" "$work/resumed.csv"
fresh=$(asked "$work/out") || exit 1
cmp -s "$work/resumed.csv" "$work/out/results.csv" || stop "a resumed run gives other numbers than a fresh one"
# Of four parts, one and one grid of another were there, and whole.
[ "$resumed" -eq $((fresh * 3 / 4 - 1)) ] || stop "$resumed grids after the interrupt, of $fresh in all"

# The first interrupt ends a model that would go on for years; so does SIGTERM.
sed -e '/^\[reference\]/,$d' -e 's/^models.*/&\nmeasures = ["motion"]/' "$work/case.toml" >"$work/long.toml"
printf '[reference]\nelements = []\n[dynamics]\nduration_s = 1e6\nequilibrium = false\n' >>"$work/long.toml"
sed -i -e '1i kinematics = "hencky"' -e 's/^poisson_ratio.*/&\ndensity_kg_m3 = 1000/' "$work/long.toml"
for signal in INT TERM; do
  "$program" compare "$work/long.toml" --out "$work/long$signal" --jobs 1 >"$work/log" 2>&1 &
  pid=$!
  until [ -e "$work/long$signal/parts" ]; do kill -0 $pid 2>/dev/null || stop "a long motion ended at once"; sleep 0.05; done
  sleep 1
  ended_by $signal
  grep -q '^interrupted; what is finished is kept' "$work/log" || stop "$signal during a model: it is not said"
done

# A flipped bit is found wherever it lies, and the part computed anew; the others are kept.
part=$(ls "$work"/out/parts/*nu0.25* | head -1)
size=$(stat -c %s "$part")
for at in 3 25 $((size / 2)) $((size - 1)); do
  byte=$(od -An -tu1 -j "$at" -N 1 "$part")
  printf "\\x$(printf %x $((byte ^ 1)))" | dd of="$part" bs=1 seek="$at" conv=notrunc status=none
  "$program" compare "$work/case.toml" --out "$work/out" --resume 2>"$work/log" >/dev/null || stop "resuming with a damaged part failed"
  grep -q "nu0.25.cbor is damaged; this part is computed anew" "$work/log" || stop "byte $at: the damage is not said"
  [ "$(grep -c 'kept from before' "$work/log")" -eq 3 ] || stop "byte $at: not all other parts were taken back"
  cmp -s "$work/resumed.csv" "$work/out/results.csv" || stop "byte $at: a damaged part gives other numbers"
done

# Folders in use; the lock of a killed program holds nobody.
at_work "$work/busy"
"$program" compare "$work/case.toml" --out "$work/busy" --resume 2>"$work/log" >/dev/null
[ $? -eq 2 ] && grep -q "^error: --out: .*busy is in use by another springproof" "$work/log" || stop "two at a time in one folder"
kill -KILL $pid
wait $pid 2>/dev/null
"$program" compare "$work/case.toml" --out "$work/busy" --resume 2>"$work/log" >/dev/null || stop "the lock of a killed program holds"

# What a script includes counts as its own text.
sed -i 's/\[-0.5.*\]/0.25/; s/block.geo/own.geo/' "$work/case.toml"
block=$(dirname "$0")/../../meshes/geo/block.geo
cp "$block" "$work/deep.geo"
echo 'Include "between.geo";' >"$work/own.geo"
echo 'Include "deep.geo";' >"$work/between.geo"
again() { "$program" compare "$work/case.toml" --out "$work/script" --resume 2>"$work/log" >/dev/null || stop "the script's case failed"; }
again
again
grep -q 'kept from before' "$work/log" || stop "nothing has changed, but the part is not taken back"
echo '// changed' >>"$work/deep.geo"
again
grep -q 'kept from before' "$work/log" && stop "a part is kept although a file that its script includes has changed"

# Any bytes in a name; the results are UTF-8.
latin=$work/$(printf 'K\xf6rper')
mkdir "$latin"
sed 's/own.geo/block.geo/' "$work/case.toml" >"$latin/case.toml"
"$program" compare "$latin/case.toml" --out "$latin/out" 2>"$work/log" >/dev/null || stop "a folder with a name in Latin-1"
iconv -f UTF-8 -t UTF-8 "$latin/out/results.json" >/dev/null || stop "results.json is no UTF-8"
iconv -f UTF-8 -t UTF-8 "$latin/out/report.html" >/dev/null || stop "report.html is no UTF-8"

echo "resumed after $kept of 4 parts"
