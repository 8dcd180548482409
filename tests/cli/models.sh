#!/usr/bin/env bash
# docs/models.md has a section for each model of the table and for nothing else, and says in each what the reader came for;
# `springproof material` knows each of them, and `homogenise` tells bias from scatter.
#   models.sh PROGRAM SOURCE-FOLDER
. "$(dirname "$0")/lib.sh"
program=$1 page=$2/docs/models.md

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
# Which are springs: the table of the page is that of the program, and the best of each kind follow from the numbers of docs/measured/models.md.
while read -r row made; do
  line=$(grep -E "^\| $(sed 's/+/[+]/' <<<"$made") \| \[?\`" "$page")
  grep -qF "\`$row\`" <<<"$line" || fail "docs/models.md does not say that $row is $made"
done < <("$program" list | awk '/^Models/ { inside = 1; next } inside && NF == 0 { exit } inside { print $1, substr($0, 19, 26) }')
"$2/docs/scripts/best_of_kind.sh" "$program" | while read -r line; do grep -qxF "$line" "$page" || echo "$line"; done >"$work/missing"
[ ! -s "$work/missing" ] || fail "docs/models.md lacks lines of docs/scripts/best_of_kind.sh: $(cat "$work/missing")"
"$program" homogenise -E 1e4 --nu 0.25 --model msm_random --seeds 5 | grep -qE 'a bias of the model: .*K by [+]3 %, [0-9]+ standard errors' ||
  fail "homogenise takes for scatter what is off by many standard errors of the mean"
"$program" homogenise -E 1e4 --nu 0.25 --model msm_random | grep -q -- '--seeds 10' ||
  fail "homogenise of one network does not say how bias and scatter are told apart"
echo "$(wc -w <<<"$rows") models"
exit $((failures > 0))
