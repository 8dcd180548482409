#!/usr/bin/env bash
# docs/models.md has a section for each model of the table and for nothing else, and says in each what the reader came for;
# `springproof material` knows each of them.
#   models.sh PROGRAM SOURCE-FOLDER
set -u
program=$1 page=$2/docs/models.md
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

rows=$("$program" list | awk '/^Models/ { inside = 1; next } inside && NF == 0 { exit } inside { print $1 }')
[ "$(wc -w <<<"$rows")" -ge 10 ] || fail "springproof list: only these models: $rows"
sections=$(sed -nE 's/^## ([a-z_0-9]+)$/\1/p' "$page")
for row in $rows; do
  grep -qx "$row" <<<"$sections" || { fail "docs/models.md has no section $row"; continue; }
  text=$(awk -v heading="## $row" '$0 == heading { inside = 1; next } /^## / { inside = 0 } inside' "$page")
  for point in Energy Exact Range Springs Take; do grep -qE "^- $point" <<<"$text" || fail "docs/models.md, $row: no line '- $point'"; done
  "$program" material --model "$row" -E 1e5 --nu 0.25 >/dev/null 2>&1 || fail "springproof material --model $row"
done
for section in $sections; do grep -qx "$section" <<<"$rows" || fail "docs/models.md describes $section, which is no model"; done
echo "$(wc -w <<<"$rows") models"
exit $((failures > 0))
