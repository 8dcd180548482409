#!/usr/bin/env bash
# The table of observed orders in docs/measured/accuracy.md, from the tests that observe them.   orders.sh [BUILD-FOLDER]
# Two discretisations each, the second with half of the edges and steps of the first.
set -eu
build=${1:-build/release}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for program in test_msm test_fem; do
  "$build/$program" --gtest_filter='*Manufactured*:*FemOrder*:RecoveredStress.*' --gtest_output="xml:$out/$program.xml" >"$out/log" ||
    { cat "$out/log" >&2; exit 1; }
done
echo '| | theory | observed |'
echo '|---|---|---|'
grep -hoP '<property name="order" value="\K[^"]*' "$out"/test_*.xml | sed 's/ν = /ν=/g; s/small strain, //g; s/, small strain//g' | awk -F ' *[|] *' '
  !($2 in of) { names[++n] = $2; theory[$2] = $4 }
  { of[$2] = of[$2] (of[$2] ? "; " : "") $3 " " $5 }
  END { for (i = 1; i <= n; ++i) print "| " names[i] " | " theory[names[i]] " | " of[names[i]] " |" }'
