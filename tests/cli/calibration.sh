#!/usr/bin/env bash
# The reference's stated uncertainties, held against values that are known: how many lie inside, and how wide the bars are.
# usage: calibration.sh SPRINGPROOF OUT LEAST COMMAND...   COMMAND: arguments of springproof in one word; LEAST: known values wanted
. "$(dirname "$0")/lib.sh"
springproof=$1
out=$2
least=$3
shift 3
log=$work/log
for command in "$@"; do
  # shellcheck disable=SC2086
  "$springproof" $command --out "$out/${command// /_}" >"$log.one" 2>&1 || fail "$command: exit status $?"
  cat "$log.one"
  cat "$log.one" >>"$log"
done
# Of several commands each prints a table; the shares are those of all.
awk -v least="$least" '
  /^(hexahedra|tetrahedra|bodies in files|near-incompressible|finite strain|in motion|frequencies|all) .*%/ {
    kind = $0
    sub(/ +[0-9].*/, "", kind)
    quantities[kind] += $(NF - 4)
    inside[kind] += $(NF - 3)
    if (kind == "all") median += $(NF - 1) * $(NF - 4)
  }
  END {
    print "known quantities of all commands, inside, share"
    for (kind in quantities) {
      share = 100 * inside[kind] / quantities[kind]
      print kind ": " quantities[kind] ", " inside[kind] ", " share " %"
      if (share < 95 && quantities[kind] - inside[kind] > 1) { print "FAILED: fewer than 95 % inside: " kind; failed = 1 }
    }
    if (quantities["all"] < least) { print "FAILED: " quantities["all"] + 0 " quantities, " least " wanted"; failed = 1 }
    if (median < 0.05 * quantities["all"]) { print "FAILED: the median |error| is below 0.05 of the uncertainty: bars 20 times too wide"; failed = 1 }
    exit failed
  }' "$log" || failures=1
exit $((failures > 0))
