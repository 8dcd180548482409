#!/usr/bin/env bash
# The bench runs, and its figures are finite and positive; how large they are is no test's business.   bench.sh SPRINGPROOF
. "$(dirname "$0")/lib.sh"
program=$1

for what in dynamics statics; do
  "$program" bench $what --quick --json "$work/$what.json" >"$work/$what.txt" 2>"$work/$what.err"
  status=$?
  [ $status -eq 0 ] || { fail "$what ended with $status"; cat "$work/$what.txt" "$work/$what.err"; }
  # Every row with a result has one line "judged", a number above 0.
  awk -F ': ' -v what=$what '
    /^ *"judged"/ { sub(/,$/, "", $2); n++; if (!($2 + 0 > 0 && $2 + 0 < 1e12)) { print "no good ratio: " $0; bad = 1 } }
    /"ok": false/ { print "a row without a result"; bad = 1 }
    END { if (n < 5) { print n " rows"; bad = 1 } exit bad }' "$work/$what.json" || fail "$what: figures"
  grep -q "targets met" "$work/$what.txt" || fail "$what: no count of targets"
done
grep -q '"name": "DRAM"' "$work/dynamics.json" || fail "no limits of the memory"
grep -q '"bandwidth_share"' "$work/dynamics.json" || fail "no share of the machine's limits"
grep -q '"what": "random network over the plain loop"' "$work/dynamics.json" || fail "no disordered network"
grep -q '2 threads.*random network' "$work/dynamics.json" || fail "no word on a disordered network's threads"
if command -v lmp >/dev/null; then grep -q '"name": "LAMMPS"' "$work/dynamics.json" || fail "no row against LAMMPS"; fi
SPRINGPROOF_LAMMPS=/bin/false "$program" bench dynamics --quick >"$work/out" 2>&1 && fail "a LAMMPS that fails passes unnoticed"
"$program" bench nothing >/dev/null 2>"$work/err"
[ $? -eq 2 ] || fail "an unknown bench is accepted"

# Interrupted: what is measured is kept.
"$program" bench dynamics --quick --json "$work/half.json" >"$work/out" 2>&1 &
pid=$!
while kill -0 $pid 2>/dev/null && ! grep -q "HybMSS over HybMSS-FD" "$work/out"; do sleep 0.2; done  # ctest has the time limit
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "an interrupted bench ended with $?"
grep -q '"judged"' "$work/half.json" || fail "an interrupted bench keeps nothing"
[ $failures -eq 0 ] && echo "the bench runs"
exit $((failures > 0))
