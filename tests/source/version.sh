#!/usr/bin/env bash
# --version names the program's version, and that of every library that the build files look for; CITATION.cff and CHANGELOG.md
# are of that version.   version.sh PROGRAM SOURCE-FOLDER
. "$(dirname "$0")/../cli/lib.sh"
program=$1 source=$2

answer=$("$program" --version) || fail "status $?"
echo "$answer"
version=$(sed -nE 's/^project\(springproof VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")
[ "$(head -n 1 <<<"$answer")" = "springproof $version" ] || fail "the first line is not springproof $version"

grep -qx "version: $version" "$source/CITATION.cff" || fail "CITATION.cff is not of version $version"
grep -qE "^## $version( |$)" "$source/CHANGELOG.md" || fail "CHANGELOG.md has no section $version"
titles=$(sed -nE 's/^    title: "(.*)"$/\1/p' "$source/CITATION.cff")
[ "$(wc -l <<<"$titles")" -eq 3 ] || fail "CITATION.cff does not cite the three papers, but $titles"
papers=$(tr '\n' ' ' <"$source/docs/papers.md" | tr -s ' ')
while read -r title; do
  grep -qF "*$title*" <<<"$papers" || fail "docs/papers.md has no paper '$title'"
done <<<"$titles"

# As find_package, find_library and pkg_check_modules of the build files call them; what is none of the program, or has no number.
no_library=' Threads GTest PkgConfig MPI MPI_C Python pybind11 BULLET '
libraries=$(find "$source" -path "$source/build" -prune -o \( -name CMakeLists.txt -o -name '*.cmake' \) -print0 |
  xargs -0 sed -nE -e 's/.*find_package\(([A-Za-z0-9._+]+).*/\1/p' -e 's/.*find_library\([A-Z_]+ ([a-z0-9]+) .*/\1/p' \
                   -e 's/.*pkg_check_modules\(([A-Z_]+) .*/\1/p' | sort -u)
[ "$(wc -w <<<"$libraries")" -ge 10 ] || fail "only these libraries found: $libraries"
for library in $libraries; do
  [[ $no_library == *" $library "* ]] && continue
  case $library in
    Eigen3) name=Eigen ;;
    nlohmann_json) name=nlohmann-json ;;
    tomlplusplus) name=toml++ ;;
    *) name=$library ;;
  esac
  if [ "$library" = deal.II ] && grep -q '^springproof-fem: is not here' <<<"$answer"; then continue; fi
  if [ "$library" = PETSC ] && ! pkg-config --exists PETSc; then continue; fi
  grep -qiE "(^|[ ,])${name//+/\\+} [0-9]+\.[0-9]+" <<<"$answer" || fail "no version of $name"
done
exit $((failures > 0))
