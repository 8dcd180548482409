#!/usr/bin/env bash
# bench engines: what is missing is said with how to install it, what answers nonsense is reported, and the run goes on.
#   bench_engines.sh SPRINGPROOF SOURCES
. "$(dirname "$0")/lib.sh"
program=$1 sources=$2/comparisons/bench/engines

# An engine that says what it likes, and no packages for the others.
printf '#!/bin/sh\necho "{\\"engine\\": \\"Liar 1.0\\", \\"steps\\": 1, \\"seconds\\": 0, \\"positions_m\\": [], \\"samples\\": [], \\"forces_N\\": [[]]}"\n' >"$work/liar"
chmod +x "$work/liar"
SPRINGPROOF_ENGINES=$work/nothing SPRINGPROOF_ENGINE_BULLET=$work/liar "$program" bench engines --quick \
  --json "$work/e.json" --out "$work/page" >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 1 ] || fail "ended with $status: $(tail -5 "$work/err")"
grep -q "^Bullet.*NO RESULT: answer of bullet not believed" "$work/out" || fail "a liar is believed: $(cat "$work/out")"
for engine in Jolt MuJoCo; do
  grep -q "^$engine: not measured: " "$work/out" || fail "$engine is missing, and nothing is said"
done
if command -v node >/dev/null; then
  grep -q "Jolt: not measured: springproof bench engines --install" "$work/out" || fail "not said how to install Jolt"
  grep -q "the ruler.*met" "$work/out" || fail "no ruler, or a bad one: $(cat "$work/out")"
fi
grep -qE "^hybmss_bt +-0\.[0-9] +-2\.[0-9] +-6\.[0-9]$" "$work/out" || fail "our models' tips are missing: $(cat "$work/out")"
grep -q '"quantity": "energy, torsion"' "$work/e.json" || fail "no energies in the JSON"
cmp -s "$work/e.json" "$work/page/bench.json" || fail "two JSON files differ"
grep -q 'id="engines"' "$work/page/bench.html" || fail "no section in the page"

"$program" bench engines --engine physx >"$work/out" 2>&1
[ $? -eq 2 ] || fail "an unknown engine is accepted"
SPRINGPROOF_ENGINES=$work/nothing "$program" bench engines --quick --engine mujoco >"$work/out" 2>&1
grep -q "^MuJoCo: not measured: " "$work/out" && ! grep -q "^Jolt" "$work/out" || fail "--engine in small letters: $(cat "$work/out")"
PATH=$work/nothing "$program" bench engines --install >"$work/out" 2>&1
[ $? -eq 1 ] && grep -q "npm is not on PATH" "$work/out" || fail "--install without npm: $(cat "$work/out")"

mkdir -p "$work/project/node_modules"
echo '{ "name": "of-others" }' >"$work/project/package.json"
SPRINGPROOF_ENGINES=$work/project "$program" bench engines --install >"$work/out" 2>&1
[ $? -eq 2 ] && grep -q "packages of another program" "$work/out" && grep -q of-others "$work/project/package.json" && [ -d "$work/project/node_modules" ] ||
  fail "the project of others: $(cat "$work/out")"

# Versions are exact and the lock file names no host.
grep -qE '"(\^|~|>|\*|latest)' "$sources/package.json" && fail "versions that move in package.json"
grep -qE 'resolved|https?:' "$sources/package-lock.json" && fail "a host in package-lock.json"
[ "$(grep -c integrity "$sources/package-lock.json")" -eq 2 ] || fail "package-lock.json does not lock two packages"
[ $failures -eq 0 ] && echo "engines are measured, or it is said why not"
exit $((failures > 0))
