#!/usr/bin/env bash
# What cmake --install puts into a folder works there: programs with their data, man page, completion.   install.sh CMAKE BINARY-FOLDER SOURCE-FOLDER
. "$(dirname "$0")/lib.sh"
cmake=$1 binary=$2 source=$3
prefix=$work
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
mapfile -t bare < <(grep -E '^  [a-z0-9_]+/' listed | grep -vE '^  [^ ]+ +([0-9]+ (s|min|h) )+ ?[A-Z]')
[ ${#bare[@]} = 0 ] || fail "cases without a time or without words: ${bare[*]}"
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

# Another program finds the library, and nothing of it in the source tree.
grep -rl "$source" lib/cmake >paths && fail "paths of the source tree in $(cat paths)"
mkdir other && cp "$source"/examples/*.cpp other
cat >other/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(other LANGUAGES C CXX)
find_package(springproof REQUIRED)
foreach(program embed_msm drop_springs own_model)
  add_executable(${program} ${program}.cpp)
  target_link_libraries(${program} PRIVATE springproof::msm)
endforeach()
END
# With this machine's instructions: vectors of Eigen are handed over to a library that has been built without them.
if "$cmake" -S other -B other/build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS="-O0 -march=native" >log 2>&1 && "$cmake" --build other/build >>log 2>&1; then
  other/build/own_model | grep -q "safe step" || fail "the program with a network of its own"
  other/build/embed_msm | grep '^tip ' || fail "the program that embeds springproof::msm"
  "$springproof" export only_here.geo --size 0.1 0.1 0.1 --cells 4 4 4 -E 1e5 --nu 0.45 --to springs --out springs.json >log 2>&1 || fail "no springs of an installed case: $(cat log)"
  other/build/drop_springs springs.json | grep ' rebounds by ' || fail "the program that loads a springs file"
else
  cat log; fail "springproof::msm cannot be used"
fi

# The Debian package, unpacked into an empty root: its program runs there, and its library by pkg-config.
if command -v dpkg-shlibdeps >/dev/null && command -v pkg-config >/dev/null; then
  grep -q 'CPACK_DEBIAN_PACKAGE_SHLIBDEPS "ON"' "$binary/CPackConfig.cmake" || fail "the package does not look for its dependencies"
  # Here it does not: dpkg-shlibdeps searches 200 libraries for 25 s.
  "$(dirname "$cmake")/cpack" --config "$binary/CPackConfig.cmake" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -D CPACK_DEBIAN_PACKAGE_SHLIBDEPS=OFF -B "$prefix/packed" >log 2>&1 || { cat log; fail "cpack"; }
  dpkg -x packed/springproof_*.deb root || fail "the package cannot be unpacked"
  root/usr/bin/springproof list | grep -q '^  golec_2019/compression ' || fail "the packaged program does not find its cases"
  export PKG_CONFIG_PATH=$prefix/root/usr/lib/pkgconfig
  if g++ other/embed_msm.cpp -o packed/bar $(pkg-config --cflags --libs springproof) >log 2>&1; then
    packed/bar | grep -q '^tip ' || fail "the program built by pkg-config"
  else
    cat log; fail "pkg-config --cflags --libs springproof does not suffice"
  fi
fi

# By hand, without the flags that CMake passes on, it is refused at once.
for eigen in /usr/include/eigen3 /usr/local/include/eigen3; do
  [ -d $eigen ] && g++ -std=c++20 -E -o /dev/null -I"$prefix/include/springproof" -isystem $eigen other/embed_msm.cpp 2>log
done
grep -q '#error "compile with -DEIGEN_MAX_ALIGN_BYTES=64' log || fail "another alignment of Eigen is not refused"
exit $((failures > 0))
