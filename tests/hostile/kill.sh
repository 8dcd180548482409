#!/usr/bin/env bash
# kill -9 at random moments: --resume goes on from there, to the numbers of an undisturbed run; no child survives, and the next
# start leaves nothing in the temporary folder.                                 kill.sh PROGRAM [KILLS [SEED]]
. "$(dirname "$0")/../cli/lib.sh"
program=$1 kills=${2:-50} seed=${3:-$(date +%s)}
RANDOM=$((seed % 32768))
mkdir "$work/tmp"
export TMPDIR=$work/tmp SPRINGPROOF_KILL_TEST=$work
{ small_case '[-0.5, 0.0, 0.25, 0.4]'; cat <<'TOML'; } >"$work/case.toml"
[[expect]]
model = "hybmss"
measure = "displacement_error"
source = "extrapolated FEM"
within = 10
TOML
start() { "$program" $arguments --out "$work/$1" >"$work/log" 2>&1; }
compare() {
  numbers "$work/$1" >"$work/numbers" || stop "no results"
  cmp "$work/undisturbed" "$work/numbers" || stop "other numbers than those of an undisturbed run"
}
# Programs that a start has left running: each has inherited the variable.
survivors() { grep -lzs "^SPRINGPROOF_KILL_TEST=$work\$" /proc/[0-9]*/environ; }
none_survives() {
  for _ in $(seq 50); do
    left=$(for p in $(survivors); do readlink "${p%environ}exe"; done | grep springproof) || return 0
    sleep 0.1
  done
  stop "still running five seconds later: $left"
}

arguments="compare $work/case.toml --jobs 2 --resume"
killed=0 finished=0
echo "seed $seed"
begin=$(date +%s%N)
start whole
whole=$?  # 1 where the reference is too coarse, or not there
[ $whole -le 1 ] || stop "the undisturbed run failed"
milliseconds=$((($(date +%s%N) - begin) / 1000000))
numbers "$work/whole" >"$work/undisturbed" || stop "no results of the undisturbed run"
while [ $killed -lt "$kills" ]; do
  (exec "$program" $arguments --out "$work/out" >"$work/log" 2>&1) &
  pid=$!
  moment=$((RANDOM * milliseconds / 32768))
  sleep "$(printf '%d.%03d' $((moment / 1000)) $((moment % 1000)))"
  kill -9 $pid 2>/dev/null
  wait $pid 2>/dev/null
  status=$?
  if [ $status -eq 137 ]; then
    killed=$((killed + 1))
    none_survives
  else
    [ $status -eq $whole ] || stop "a resumed run ended with $status and not with $whole"
    finished=$((finished + 1))
    compare out
    rm -rf "$work/out"
  fi
done
start out
[ $? -eq $whole ] || stop "resuming failed"
compare out
[ -z "$(ls -A "$TMPDIR")" ] || stop "left in the temporary folder: $(ls -A "$TMPDIR")"
echo "$killed kills, $((finished + 1)) runs finished with the same numbers (seed $seed)"
