#!/usr/bin/env bash
# What docs/papers.md says of the code is there: tests, cases, names, and that a function is in the file beside it.   papers.sh SOURCE-FOLDER
. "$(dirname "$0")/../cli/lib.sh"
cd "$1" || exit 1
page=docs/papers.md
found=0

# All tests as SUITE.NAME (a test of a suite with parameters too), all words of the sources.
grep -rhoE '^(TEST|TEST_F|TEST_P|TYPED_TEST)\([A-Za-z0-9_]+, [A-Za-z0-9_]+' --include='*.cpp' tests | sed -E 's/^[A-Z_]+\(//; s/, /./' >"$work/tests"
grep -rhowE '[A-Za-z_][A-Za-z0-9_]*' --include='*.h' --include='*.cpp' --include='*.toml' problem meshes msm fem_reference comparisons tests | sort -u >"$work/words"

# A case, by its name or as NAME_*, CASE/..., CASE.toml.
is_case() { compgen -G "comparisons/experiments/${1%.toml}*" >/dev/null; }

while read -r name; do
  found=$((found + 1))
  case $name in
    experiment.*) name=${name#experiment.}; is_case "${name%/...}" || fail "no case $name" ;;
    golec_2019/* | kot_201[45]/*) name=${name%/...}; is_case "${name%/\*}" || fail "no case $name" ;;
    *.*) grep -qxE "${name//\*/.*}" <(sed 's/\./\\&/' "$work/tests" | tr -d '\\') || fail "no test $name" ;;
    *) for word in ${name//::/ }; do grep -qxF "${word%%(*}" "$work/words" || fail "no name $word in the sources"; done ;;
  esac
done < <(awk '/^```/ { inside = !inside; next } !inside' "$page" | grep -oE '`[^` ]+`' | tr -d '`' |
         grep -E '^((experiment\.)?(golec_2019|kot_2014|kot_2015)/|experiment\.|[A-Z][A-Za-z]+\.[A-Z*]|[A-Za-z][A-Za-z_]*(::[A-Za-z_]+)*(\(\))?$)' | grep -vx 'Suite.Test' | sort -u)

# `name`, `name` (`file`, `file`): every name is declared in a header of these or begins there (a line without an indent).
while IFS=$'\t' read -r names files; do
  for name in $names; do
    found=$((found + 1)) name=${name##*::}
    name=${name%%(*}
    for file in $files; do
      grep -qE "^[^ /].*\\<$name\\>" "$file" && continue 2
      grep -qw -e "$name" "${file%.cpp}.h" 2>/dev/null && continue 2
    done
    fail "$name is not in $files"
  done
done < <(grep -oE '`[A-Za-z_:()]+`(, (member )?`[A-Za-z_:()]+`)* \((, )?(`(problem|meshes|msm|fem_reference|comparisons)/[a-z0-9_/]+\.(cpp|h)`(, )?)+' "$page" |
         sed -E 's/ \(`/\t/; s/`|,|member //g')

# The table of symbols: names, then files, one of which has the name.
while IFS=$'\t' read -r names files; do
  for name in $names; do
    found=$((found + 1)) name=${name##*::}
    # shellcheck disable=SC2086
    [ -z "${files// /}" ] || grep -qrw -e "${name%%(*}" $files || fail "$name is in none of $files"
  done
done < <(awk -F' [|] ' '
  /^## 2/ { exit }
  function spans(text, want,  n, part, i, out) {
    n = split(text, part, "`")
    for (i = 2; i <= n; i += 2) if (part[i] ~ want) out = out part[i] " "
    return out
  }
  NF == 3 && $2 ~ /`/ { print spans($2, "^[A-Za-z_:]+([(][)])?$") "\t" spans($3, "^(problem|meshes|msm|comparisons)/") }' "$page")
[ $found -ge 150 ] || fail "only $found names found"
echo "$found names"
exit $((failures > 0))
