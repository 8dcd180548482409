#!/usr/bin/env bash
# A force law added as docs/contributing.md says passes the law suite and is a model of springproof.
#   contributing_law.sh BINARY-FOLDER SOURCE-FOLDER JOBS
# In a copy of msm/, tests/ and comparisons/; of the build, what depends on the list of laws is compiled again.
. "$(dirname "$0")/lib.sh"
binary=$(readlink -f "$1") source=$(readlink -f "$2") jobs=$3
cd "$work" || exit 1
page=$source/docs/contributing.md
cp -r "$source/msm" "$source/tests" "$source/comparisons" .
mkdir -p views/msm views/comparisons objects
ln -s "$work/msm" views/msm/msm
ln -s "$work/comparisons" views/comparisons/comparisons

# The files of the page, and its lines where it says.
section() { awk '/^## / { inside = $0 == "## A force law" } inside' "$page"; }
section | awk '
  match($0, /Save as `msm[a-z_\/.]+`/) { name = substr($0, RSTART + 9, RLENGTH - 10) }
  /^```/ { if (inside) name = ""; inside = !inside; next }
  inside && name != "" { print > name }'
[ -s msm/laws/stiffening_springs.h ] && [ -s msm/laws/stiffening_springs.cpp ] || { fail "no law in $page"; exit 1; }
line() { section | grep -F -- "$1" | head -1; }
insert_after() {  # FILE PATTERN LINE
  [ -n "$3" ] || fail "no line for $1 in $page"
  awk -v pattern="$2" -v line="$3" '{ print } !done && index($0, pattern) { print line; done = 1 } END { exit !done }' "$1" >edited || fail "no place in $1"
  mv edited "$1"
}
insert_after msm/laws/laws.h '#include "msm/laws/springs.h"' '#include "msm/laws/stiffening_springs.h"'
sed -i 's/Anchors>;/Anchors, StiffeningSprings>;/' msm/laws/laws.h
insert_after msm/parameters/model_table.h '  angular_springs,' '  stiffening_springs,'
insert_after msm/parameters/model_table.cpp 'const std::vector<ModelRow> table = {' "$(line '{"msm_stiffening"')"
insert_after msm/periodic/laws_of_model.cpp 'if (p.has(angular_springs))' "$(line 'StiffeningSprings{10});' | grep has)"
insert_after tests/laws/law_suite_test.cpp 'all.push_back({"SpringsOfASheet"' "$(line 'all.push_back({"Stiffening"')"

# adapted COMMAND OBJECT: it compiles the sources and headers of this folder.
adapted() {
  sed -E "s# -O3 # -O1 #; s# -MF [^ ]+##; s# -MD -MT [^ ]+##; s# -o [^ ]+ -c# -o $2 -c#; s#$source/tests#$work/tests#g
          s#$binary/arrows/(msm|comparisons) #$work/views/\1 #g; s#-c $source/(msm|comparisons)/#-c $work/\1/#" <<<"$1"
}
# again OBJECT: compiles it from this folder.
again() {
  local object=$1 copy=$work/objects/${1//\//_} command
  command=$(ninja -C "$binary" -t commands "$object" | tail -1)
  if [[ $object == */Unity/* ]]; then
    sed -E "s#$source/(msm|comparisons)/#$work/\1/#" "$binary/${object%.o}" >"${copy%.o}.cpp"
    command=$(sed -E "s# -c [^ ]+# -c ${copy%.o}.cpp#" <<<"$command")
  fi
  (cd "$binary" && bash -c "$(adapted "$command" "$copy")") && echo "$object" >>"$work/compiled"
}
export -f again adapted
export binary source work
ninja -C "$binary" -t deps | awk '
  /^[^ ].*: #deps/ { object = $1; sub(/:$/, "", object) }
  /msm\/laws\/laws.h|msm\/parameters\/model_table.h/ { if (!(object in seen)) print object; seen[object] }' |
  grep -E '^(msm/CMakeFiles/msm.dir|comparisons/CMakeFiles/(comparisons|springproof).dir|tests/CMakeFiles/test_msm.dir/laws)/' >objects_of_law
xargs -P "$jobs" -I{} bash -c 'again "$1"' again {} <objects_of_law
[ "$(sort -u compiled 2>/dev/null | wc -l)" = "$(sort -u objects_of_law | wc -l)" ] || { fail "what depends on the laws does not compile"; exit 1; }

command=$(ninja -C "$binary" -t commands "$(grep -m1 '^msm/' objects_of_law)" | tail -1)  # the flags of msm/
command=$(sed -E "s# -c [^ ]+# -c $work/msm/laws/stiffening_springs.cpp#" <<<"$command")
(cd "$binary" && bash -c "$(adapted "$command" "$work/objects/msm_new_law.o")") || fail "the law does not compile"

# The law suite, and springproof.
link() {  # TARGET OBJECTS...
  local target=$1 command
  shift
  command=$(ninja -C "$binary" -t commands "$target" | tail -1)
  command=${command/ -o $target / -o $work\/bin\/$target }
  if [ "$target" = test_msm ]; then  # of its tests only the law suite
    command=$(sed -E 's# tests/CMakeFiles/test_msm.dir/[^ ]+##g' <<<"$command")
  else
    command=$(sed -E 's# comparisons/CMakeFiles/springproof.dir/[^ ]+##g' <<<"$command")
  fi
  (cd "$binary" && bash -c "${command/ -o / $* -o }")
}
mkdir bin
law=$(ls "$work"/objects/msm_*.o | tr '\n' ' ')
link test_msm "$work"/objects/tests_*.o $law || fail "the law suite is not linked"
bin/test_msm --gtest_filter='LawSuite*:*/LawSuite*' >log 2>&1 || fail "the law suite: $(tail -30 log)"
grep -q 'Stiffening' log || fail "the law suite has no case of the new law"
others=$(ls "$binary"/comparisons/CMakeFiles/springproof.dir/*/*.o "$binary"/comparisons/CMakeFiles/springproof.dir/*.o 2>/dev/null |
  while read -r o; do grep -qxF "${o#"$binary/"}" objects_of_law || echo "$o"; done | tr '\n' ' ')
link springproof "$work"/objects/comparisons_*.o $others $law || fail "springproof is not linked"
cp "$binary"/springproof-mesh "$binary"/springproof-fem bin
mkdir -p share/springproof && cp -r "$source/meshes/geo" "$source/comparisons/experiments" share/springproof
bin/springproof list | grep -q '^  msm_stiffening ' || fail "the new model is not listed"
sed -e 's/^models = .*/models = ["msm_18", "msm_stiffening"]/' -e '/^\[\[expect\]\]/,$d' share/springproof/experiments/golec_2019/compression.toml >cube.toml
bin/springproof compare cube.toml --poisson-ratio 0.25 --out out >log 2>&1 || fail "compare with the new model: status $?: $(tail -5 log)"
value() { awk -F, -v model="$1" '$3 == model && $6 == "volume_change" { print $7; exit }' out/results.csv; }
[ -n "$(value msm_18)" ] && [ "$(value msm_18)" = "$(value msm_stiffening)" ] || fail "at small strain: msm_18 '$(value msm_18)', msm_stiffening '$(value msm_stiffening)'"
exit $((failures > 0))
