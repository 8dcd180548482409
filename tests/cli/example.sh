#!/usr/bin/env bash
# The lines of a program that a page prints are those of the one in examples/, which prints what the page says.
#   example.sh PROGRAM SOURCE PAGE
. "$(dirname "$0")/lib.sh"
program=$1 source=$2 page=$3

printed=$(awk '/^```cpp$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$page")
[ "$(wc -l <<<"$printed")" -ge 5 ] || fail "no C++ code in $page"
others=$(diff <(echo "$printed") "$source" | grep '^<') && fail "lines of $page that are not in $source, or not in this order: $others"
# The line after `$ ./NAME`, where NAME is what the page lets the compiler write.
name=$(grep -oE -- '-o [a-z_]+$' "$page" | awk '{ print $2 }')
promised=$(awk -v run="$ ./$name" '$0 == run { getline; print; exit }' "$page")
answer=$("$program") || fail "$program ends with status $?"
[ -n "$promised" ] || fail "no output of ./$name in $page"
[ "$answer" = "$promised" ] || fail "it prints '$answer'; $page says '$promised'"
exit $((failures > 0))
