#!/usr/bin/env bash
# Every test that docs/measured/reliability.md names is there.   reliability.sh SOURCE-FOLDER
. "$(dirname "$0")/lib.sh"
cd "$1" || exit 1
names=$(grep -oE '`[A-Z][A-Za-z]+\.[A-Z][A-Za-z]+`|`(cli|experiment)\.[a-z_]+`' docs/measured/reliability.md | tr -d '`' | sort -u)
for name in $names; do
  case $name in
    cli.* | experiment.*) grep -hqE "add_test\(NAME $name " tests/CMakeLists.txt tests/experiments.cmake ;;
    *) grep -rqE "TEST(_[FP])?\(${name%.*}, ${name#*.}\)" tests --include=*.cpp ;;
  esac || fail "docs/measured/reliability.md names $name, which is no test"
done
[ "$(wc -w <<<"$names")" -ge 40 ] || { echo "FAILED: only $(wc -w <<<"$names") names found"; exit 1; }
echo "$(wc -w <<<"$names") tests named"
exit $((failures > 0))
