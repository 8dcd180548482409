#!/usr/bin/env bash
# A comparison in shards, without a coordinator: the numbers of one run, whatever dies or starts twice.   shard.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
write_case() {  # NAME POISSON-RATIOS
  { small_case "$2"; cat <<'TOML'; } >"$work/$1.toml"
[[expect]]
model = "hybmss"
measure = "volume_change"
source = "regression"
value = 0
within = 1
TOML
}
write_case first '[-0.5, 0.0, 0.25, 0.4]'
write_case second '[0.1, 0.3]'
# shard K/N [CASE...]: into $out, with the status of the program
shard() {
  local cases=("${@:2}")
  [ ${#cases[@]} -gt 0 ] || cases=("$work/first.toml" "$work/second.toml")
  "$program" compare "${cases[@]}" --shard "$1" --out "$work/$out" >"$work/log" 2>&1
}
report() { "$program" report "$work/$out" "$@" >"$work/log" 2>&1; }
was_refused() {  # WHAT PATTERN, after a command
  [ $? -eq 2 ] && grep -qE "^error: $2" "$work/log" || stop "$1"
}
same() {
  numbers "$work/whole" >"$work/undisturbed" && numbers "$work/$out" | cmp "$work/undisturbed" - || stop "$1: other numbers"
}

"$program" compare "$work/first.toml" "$work/second.toml" --out "$work/whole" >"$work/log" 2>&1 || stop "a plain comparison"

# One after the other, the last first; a report says what is missing, and of whom.
out=five
shard 4/5 || stop "shard 4/5"
report --partial
[ $? -eq 1 ] && grep -qE 'shard 5/5: 1 part missing: (first|second)' "$work/log" || stop "a report of one shard"
rm "$work/five/report.html" "$work/five"/results.*
for k in 5 3 1; do shard $k/5 || stop "shard $k/5"; done
[ ! -e "$work/five/report.html" ] || stop "a shard writes a report"
report; was_refused "a part is missing" ".*five: parts are missing \(start shard 2 again, or add --partial"
grep -qE '^shard 2/5: 1 part missing: (first|second)  nu' "$work/log" || stop "the missing part is not named"
[ ! -e "$work/five/results.csv" ] || stop "results without all parts"
report --partial
[ $? -eq 1 ] || stop "a partial report should end with 1"
[ "$(wc -l <"$work/five/results.csv")" -lt "$(wc -l <"$work/whole/results.csv")" ] || stop "a partial report has everything"
grep -q 'Not computed: Poisson' "$work/five/report.html" || stop "a partial report does not say so"
shard 2/5 || stop "shard 2/5"
report || stop "the report of five shards"
same "five shards"
[ -s "$work/five/report.html" ] || stop "no report"

# At once, each twice; of two that are the same one is refused, or finds the parts of the other.
out=at_once pids=()
for k in 1 2 1 2; do
  "$program" compare "$work/first.toml" "$work/second.toml" --shard $k/2 --jobs 1 --out "$work/at_once" >"$work/log.$k.$RANDOM" 2>&1 &
  pids[${#pids[@]}]=$!
done
for pid in "${pids[@]}"; do
  wait "$pid"
  status=$?
  [ $status -eq 0 ] || [ $status -eq 2 ] || stop "shards at once: status $status"
done
cat "$work"/log.* >"$work/log"
report || stop "the report of shards at once"
same "shards at once"

# Killed at work: meanwhile it is in nobody's way but its own; started again, it keeps what it finished.
write_case third '[0.0, 0.1, 0.15, 0.2, 0.25, 0.3]'
out=killed
FOLDER=$work/killed FEM=$(dirname "$program")/springproof-fem SPRINGPROOF_FEM_PROGRAM=$(dirname "$0")/one_part_fem \
  "$program" compare "$work/third.toml" --shard 1/2 --jobs 1 --out "$work/killed" >/dev/null 2>&1 &
pid=$!
until compgen -G "$work/killed/parts/*nu*.cbor" >/dev/null; do
  kill -0 $pid 2>/dev/null || stop "a shard ended before its first part"
  sleep 0.05
done
shard 1/2 "$work/third.toml"; was_refused "the same shard twice" "--shard: 1/2 is at work in .*killed already"
"$program" compare "$work/third.toml" --out "$work/killed" >"$work/log" 2>&1; was_refused "a comparison beside a shard" "--out: .*killed is in use"
report; was_refused "a report of a shard at work" ".*parts are missing"
grep -q '^shard 1/2 (at work): ' "$work/log" || stop "the report does not say who is at work"
kill -KILL $pid
wait $pid 2>/dev/null
kept=$(ls "$work/killed/parts" | grep -c 'nu.*cbor$')
shard 1/2 "$work/third.toml" || stop "a killed shard started again"
[ "$kept" -eq 1 ] && [ "$(grep -c 'kept from before' "$work/log")" -eq 1 ] || stop "not all $kept parts are kept"

# A damaged part is named, and computed anew by its shard.
shard 2/2 "$work/third.toml" || stop "shard 2/2"
part=$(ls "$work"/killed/parts/*nu0.2.cbor)
printf x | dd of="$part" bs=1 seek=1000 conv=notrunc status=none
report; was_refused "a damaged part" ".*parts are missing"
k=$(sed -nE 's/^shard ([12])\/2: 1 part missing: third  nu0\.2 \(damaged\)$/\1/p' "$work/log")
[ -n "$k" ] || stop "the damage is not said"
shard "$k/2" "$work/third.toml" || stop "the shard of a damaged part"
grep -q 'nu0.2.cbor is damaged; this part is computed anew' "$work/log" || stop "the damaged part is kept"
report || stop "the report after a repair"

# Parts of other inputs.
cp "$work/killed/parts/third-nu0.1.cbor" "$work/killed/parts/third-nu0.2.cbor"
report; was_refused "a part of other inputs" ".*parts are missing"
grep -q 'nu0.2 (computed from other inputs)' "$work/log" || stop "the part of other inputs is taken"

# Shards that do not belong together.
out=five
shard 1/4; was_refused "another number of shards" "--shard: is one of 4, but .*five holds a sweep of 5 shards"
shard 1/5 "$work/first.toml"; was_refused "a case less" "--out: .*five holds a sweep with second  nu0.1 too"
shard 1/5 "$work/first.toml" "$work/second.toml" "$work/third.toml"; was_refused "a case more" "--out: .*five holds a sweep without third  nu0"
sed -i 's/1e4/2e4/' "$work/second.toml"
shard 1/5; was_refused "another input" "--out: .*five holds a sweep in which second  nu0.1 is computed from other inputs"
for bad in 0/4 5/4 3 a/b 1/0 -1/4 1/4x 1/ /4 1/99999999999 ''; do
  shard "$bad"; was_refused "--shard '$bad'" "--shard: is $bad \(allowed: K/N"
done
(cd "$work" && "$program" compare first.toml --shard 1/2) >"$work/log" 2>&1
[ $? -eq 2 ] && grep -q -- '--shard requires --out' "$work/log" || stop "--shard without --out"
out=whole
report; was_refused "a report of no sweep" ".*whole: no sweep.cbor here"
echo "shards give the numbers of one run"
