#!/usr/bin/env bash
# The reference's stated uncertainties, held against values that are known: how many lie inside, and how wide the bars are.
# usage: calibration.sh SPRINGPROOF OUT
set -u
springproof=$1
out=$2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"$springproof" compare calibration --jobs 1 --out "$out" >"$log" 2>&1
status=$?
cat "$log"
[ $status -eq 0 ] || { echo "FAILED: exit status $status"; exit 1; }
awk '
  $1 == "all"                                  { quantities = $2; median = $(NF - 1) }
  /^(hexahedra|tetrahedra|near-incompressible|finite strain|all) /  { share = $(NF - 2); sub("%", "", share)
                                                 if (share + 0 < 95) { print "FAILED: fewer than 95 % inside: " $0; failed = 1 } }
  END {
    if (quantities < 200) { print "FAILED: " quantities + 0 " quantities, 200 wanted"; failed = 1 }
    if (median < 0.05) { print "FAILED: the median |error| is " median + 0 " of the uncertainty: bars 20 times too wide"; failed = 1 }
    exit failed
  }' "$log"
