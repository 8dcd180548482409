#!/usr/bin/env bash
# The program that a page prints is the one in examples/, and prints what the page says.   example.sh PROGRAM SOURCE PAGE
. "$(dirname "$0")/lib.sh"
program=$1 source=$2 page=$3

printed=$(awk '/^```cpp$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$page")
if [ "$printed" != "$(cat "$source")" ]; then
  fail "the C++ code of $page is not $source:"
  diff <(echo "$printed") "$source"
fi
# The line after `$ ./NAME`, where NAME is what the page lets the compiler write.
name=$(grep -oE -- '-o [a-z_]+$' "$page" | awk '{ print $2 }')
promised=$(awk -v run="$ ./$name" '$0 == run { getline; print; exit }' "$page")
answer=$("$program") || fail "$program ends with status $?"
[ -n "$promised" ] || fail "no output of ./$name in $page"
[ "$answer" = "$promised" ] || fail "it prints '$answer'; $page says '$promised'"
exit $((failures > 0))
