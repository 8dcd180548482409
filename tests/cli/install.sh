#!/usr/bin/env bash
# What cmake --install puts into a folder works there: programs with their data, man page, completion.   install.sh CMAKE BINARY-FOLDER
set -u
cmake=$1 binary=$2
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cd "$prefix" || exit 1

"$cmake" --install "$binary" --prefix "$prefix" >log 2>&1 || { cat log; fail "cmake --install"; exit 1; }
springproof=$prefix/bin/springproof

# Its own data and not those of the source tree: a case and a body that only it has.
cp share/springproof/experiments/golec_2019/compression.toml share/springproof/experiments/only_here.toml
cp share/springproof/geo/block.geo share/springproof/geo/only_here.geo
sed -i 's/^geo = .*/geo = "only_here.geo"/' share/springproof/experiments/only_here.toml
"$springproof" list >listed || fail "springproof list"
grep -q '^  only_here ' listed || fail "an installed case is not listed"
grep -q '^  golec_2019/compression ' listed || fail "an installed case has not its name"
"$springproof" export only_here --to calculix --out deck.inp >log 2>&1 || fail "no deck of an installed case: $(cat log)"
[ -s deck.inp ] || fail "the deck is empty"

"$springproof" --version >version || fail "springproof --version"
for program in bin/springproof-*; do
  case $program in
    */springproof-mesh) grep -q '^springproof-mesh: gmsh [0-9]' version || fail "springproof-mesh is not found" ;;
    */springproof-fem) grep -q '^springproof-fem: deal.II [0-9]' version || fail "springproof-fem is not found" ;;
  esac
done
grep -q '^\.TH SPRINGPROOF 1' share/man/man1/springproof.1 || fail "no man page"
grep -q '^complete ' share/bash-completion/completions/springproof || fail "no completion"
exit $failures
