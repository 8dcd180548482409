#!/usr/bin/env bash
# An engine's bar beside our springs' and finite elements', if the engine is installed.
#   engine_judged.sh PROGRAM SOURCES ENGINE FROM TO      the tip sinks between FROM and TO of what msm_18's does
. "$(dirname "$0")/../cli/lib.sh"
program=$1 engine=$3
"$2/examples/engines/judge.sh" "$program" "$work" "$engine" >"$work/log" 2>&1
status=$?
[ $status -ne 77 ] || { cat "$work/log"; exit 77; }
[ $status -eq 0 ] || stop "judge.sh ended with $status"
sunk() { entry "$work/report/results.csv" value "model=$1" measure=displacement.tip.z; }
awk -v e="$(sunk "$engine")" -v m="$(sunk msm_18)" -v from="$4" -v to="$5" \
  'BEGIN { print e / m " of the tip of msm_18"; exit !(m < 0 && e / m >= from && e / m <= to) }' || fail "the tip of $engine" "$work/log"
exit $((failures > 0))
