#!/usr/bin/env bash
# What docs/contributing.md says to add is all that it takes.   contributing.sh BINARY-FOLDER SOURCE-FOLDER COMPILER INCLUDE-FOLDERS
. "$(dirname "$0")/../cli/lib.sh"
binary=$1 source=$2 compiler=$3
IFS=';' read -ra includes <<<"$4"
cd "$work" || exit 1
page=$source/docs/contributing.md

# A body and a case: files of the page, beside the built-in ones of a program that lies as an installed one does.
mkdir -p bin build share/springproof
cp -r "$source/meshes/geo" "$source/comparisons/experiments" share/springproof
cp "$binary"/springproof "$binary"/springproof-mesh "$binary"/springproof-fem bin || fail "programs are missing"
ln -s ../bin build/release
awk '
  match($0, /Save as `[a-z_\/.]+`/) { name = substr($0, RSTART + 9, RLENGTH - 10) }
  /^```/ { if (inside) name = ""; inside = !inside; next }
  inside && name ~ /^(meshes|comparisons)/ {
    file = name
    sub(/^meshes\/geo/, "share/springproof/geo", file); sub(/^comparisons\/experiments/, "share/springproof/experiments", file)
    print > file
  }' "$page"
bin/springproof list | grep -q '^  bodies/wedge ' || fail "the new case is not listed"
command=$(awk '/^```sh$/ { getline; print; exit }' "$page")
[ -n "$command" ] || fail "no command in $page"
bash -c "$command" >log 2>&1 || fail "$command: status $?: $(cat log)"
grep -q '^1 of 1 expectations hold' log || fail "the case is not judged: $(cat log)"

# The unit of the build that SOURCE belongs to, compiled with EDITED in its place.   compile_with SOURCE EDITED OBJECT
compile_with() {
  local module=${1%%/*} object unity command
  object=$module/CMakeFiles/$module.dir/${1#*/}.o
  unity=$(grep -lF "/$1\"" "$binary/$module/CMakeFiles/$module.dir/Unity/"*.cxx 2>/dev/null | head -1)
  cp "$2" "$3.cpp"
  if [ -n "$unity" ]; then
    object=${unity#"$binary/"}.o
    sed "s|\"[^\"]*/$1\"|\"$work/$2\"|" "$unity" >"$3.cpp"
  fi
  command=$(ninja -C "$binary" -t commands "$object" | tail -1)
  (cd "$binary" && bash -c "$(sed -E "s| -O3 | -O1 |; s| -MF [^ ]+||; s| -MD -MT [^ ]+||; s| -o [^ ]+ -c [^ ]+| -o $work/$3 -c $work/$3.cpp|" <<<"$command")")
}

# A model: the row of the page in the table, and the same by an option of hybmss.
# The first line of the Nth block of code of a section.   snippet SECTION N
snippet() {
  awk -v section="## $1" -v wanted="$2" '
    /^## / { inside = $0 == section; n = 0 }
    inside && /^ *```cpp$/ { n++; getline; if (n == wanted) { print; exit } }' "$page"
}
row=$(snippet "A model" 1)
awk -v row="$row" '{ print } /^const std::vector<ModelRow> table = \{/ { print row }' "$source/msm/parameters/model_table.cpp" >model_table.cpp
flags=(-std=c++20 -O0 -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -I"$binary/arrows/msm" -I"$binary/arrows/meshes" -I"$binary/arrows/problem" "${includes[@]/#/-isystem}")
libraries=(-L"$binary/msm" -lmsm -L"$binary/meshes" -lmeshes -L"$binary/problem" -lproblem -ltomlplusplus -lfmt -lz)
sed -e 's/int main()/int main(int count, char**)/' \
    -e 's/resolve({.*});/resolve(count > 1 ? ModelChoice{"hybmss_1", {}, "", {}} : ModelChoice{"hybmss", {{"face_to_cube", 1.0}}, "", {}});/' \
    "$source/examples/embed_msm.cpp" >bar.cpp
if compile_with msm/parameters/model_table.cpp model_table.cpp model_table.o &&
   "$compiler" "${flags[@]}" bar.cpp model_table.o "${libraries[@]}" -o bar; then
  added=$(./bar added)
  chosen=$(./bar)
  [ -n "$added" ] || fail "the new model prints nothing"
  [ "$added" = "$chosen" ] || fail "the new model gives '$added', hybmss with A = 1 '$chosen'"
else
  fail "msm/parameters/model_table.cpp does not compile with the new row"
fi

# A measure: the row and the line of the page, compiled into springproof, and expected of the new case.
awk -v row="$(snippet "A measure" 1)" '{ print } /^  static const std::vector<Measure> table = \{/ { print row }' "$source/problem/case_file/measures.cpp" >table.cpp
awk -v line="$(snippet "A measure" 2)" '{ print } /out = \{\{"volume_change"/ { print line }' "$source/comparisons/judge/measures.cpp" >judge.cpp
link=$(ninja -C "$binary" -t commands springproof | tail -1)
if compile_with problem/case_file/measures.cpp table.cpp table.o && compile_with comparisons/judge/measures.cpp judge.cpp judge.o &&
   (cd "$binary" && bash -c "${link/ -o springproof / $work/table.o $work/judge.o -o $work/bin/springproof }"); then
  case=share/springproof/experiments/bodies/wedge.toml
  sed -i 's/measures = \[/measures = ["volume_ratio", /' "$case"
  printf '[[expect]]\nmodel = "hybmss"\nmeasure = "volume_ratio"\nsource = "analytic"\nvalue = 1\nwithin = 0.01\n' >>"$case"
  bin/springproof list | grep -q '^  volume_ratio ' || fail "the new measure is not listed"
  bin/springproof compare bodies/wedge --out measured >log 2>&1 || fail "the case with the new measure: status $?: $(cat log)"
  grep -q '^2 of 2 expectations hold' log || fail "the new measure is not judged: $(cat log)"
  grep -q ',volume_ratio,0.99' measured/results.csv || grep -q ',volume_ratio,1' measured/results.csv || fail "no row of the new measure"
else
  fail "springproof does not build with the new measure"
fi
exit $((failures > 0))
