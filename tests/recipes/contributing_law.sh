#!/usr/bin/env bash
# What docs/contributing.md says of force laws, of a subcommand, of an export format and of a section of the report is all that they
# take: the laws pass the law suite and are models of springproof.
#   contributing_law.sh BINARY-FOLDER SOURCE-FOLDER JOBS
# In a copy of msm/, tests/ and comparisons/; of the build, what depends on the list of laws is compiled again.
. "$(dirname "$0")/../cli/lib.sh"
binary=$(readlink -f "$1") source=$(readlink -f "$2") jobs=$3
cd "$work" || exit 1
page=$source/docs/contributing.md
cp -r "$source/msm" "$source/tests" "$source/comparisons" .
mkdir -p views/msm views/comparisons objects
ln -s "$work/msm" views/msm/msm
ln -s "$work/comparisons" views/comparisons/comparisons

# The files of the page, and its lines where it says.
section() { awk -v heading="## $1" '/^## / { inside = $0 == heading } inside' "$page"; }
for name in "A force law" "A law of cells with constants of each" "A section of the report" "A subcommand"; do
  section "$name" | awk '
    match($0, /Save as `(msm|comparisons)[a-z_\/.]+`/) { name = substr($0, RSTART + 9, RLENGTH - 10) }
    /^```/ { if (inside) name = ""; inside = !inside; next }
    inside && name != "" { print > name }'
done
for file in msm/laws/{stiffening_springs,graded_volumes}.{h,cpp} comparisons/commands/count_command.cpp comparisons/report/page/counted.js; do
  [ -s "$file" ] || { fail "no $file in $page"; exit 1; }
done
# The block of code of a section that has these words.   block SECTION WORDS
block() { section "$1" | awk -v words="$2" '/^ *```/ { if (inside && index(text, words)) { printf "%s", text; exit } inside = !inside; text = ""; next } inside { text = text $0 "\n" }'; }
insert_after() {  # FILE PATTERN TEXT
  [ -n "$3" ] || fail "nothing for $1 in $page"
  TEXT=$3 awk -v pattern="$2" '{ print } !done && index($0, pattern) { print ENVIRON["TEXT"]; done = 1 } END { exit !done }' "$1" >edited || fail "no place in $1"
  mv edited "$1"
}
for law in stiffening_springs graded_volumes; do
  insert_after msm/laws/laws.h '#include "msm/laws/springs.h"' "#include \"msm/laws/$law.h\""
  insert_after msm/parameters/model_table.h '  angular_springs,' "  $law,"
done
sed -i 's/Anchors>;/Anchors, StiffeningSprings, GradedVolumes>;/' msm/laws/laws.h
law() {  # SECTION WORDS-OF-ITS-ROW WORDS-OF-ITS-LINE WORDS-OF-ITS-CASE
  insert_after msm/parameters/model_table.cpp 'const std::vector<ModelRow> table = {' "$(block "$1" "$2")"
  insert_after msm/periodic/laws_of_model.cpp 'if (p.has(angular_springs))' "$(block "$1" "$3")"
  insert_after tests/laws/law_suite_test.cpp 'all.push_back({"SpringsOfASheet"' "$(block "$1" "$4")"
}
law "A force law" '{"msm_stiffening"' 'laws.push_back(Stiffening' 'all.push_back({"Stiffening"'
law "A law of cells with constants of each" '{"hybmss_graded"' 'laws.push_back(GradedVolumes' 'all.push_back({"Graded"'
insert_after comparisons/commands/commands.h '// Each adds its options' "$(block "A subcommand" 'RunCommand count_command(CLI::App& parser);')"
insert_after comparisons/commands/main.cpp 'constexpr Subcommand subcommands[] = {' "$(block "A subcommand" '{"count"')"
insert_after comparisons/commands/export/export_command.cpp 'constexpr ExportForm forms[] = {' "$(block "An export format" '{"points"')"
TEXT=$(block "An export format" 'int export_points') awk '/^\/\/\/ A form of export/ { print ENVIRON["TEXT"] "\n" } { print }' \
  comparisons/commands/export/export_command.cpp >edited
mv edited comparisons/commands/export/export_command.cpp
insert_after comparisons/report.cmake 'report/page/fem_column.js' "$(block "A section of the report" 'page/counted.js')"
insert_after comparisons/report/page/report.js 'const sections = [' "$(block "A section of the report" "id: 'counted'")"

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

# new MODULE SOURCE: compiles a file that is new, with the flags of its module.
new() {
  local command
  command=$(ninja -C "$binary" -t commands "$(grep -m1 "^$1/" objects_of_law)" | tail -1)
  command=$(sed -E "s# -c [^ ]+# -c $work/$2#" <<<"$command")
  (cd "$binary" && bash -c "$(adapted "$command" "$work/objects/${1//\//_}_new_$(basename "$2" .cpp).o")") || fail "$2 does not compile"
}
new msm msm/laws/stiffening_springs.cpp
new msm msm/laws/graded_volumes.cpp
new comparisons/CMakeFiles/springproof.dir comparisons/commands/count_command.cpp

# The page of the report, of the scripts that comparisons/report.cmake names.
scripts=$(sed -nE "s#^ +([a-z_]+=)\\$\\{report_dir\\}#\\1$work/comparisons#p" comparisons/report.cmake | paste -sd ';')
libraries=$(ninja -C "$binary" -t commands comparisons/report_assets.cpp | grep -o 'chart_js=[^"]*')
cmake "-DASSETS=$scripts;$libraries" -DOUTPUT="$work/report_assets.cpp" -P comparisons/report/embed.cmake || fail "the page is not embedded"
command=$(ninja -C "$binary" -t commands comparisons/CMakeFiles/report.dir/report_assets.cpp.o | tail -1)
command=$(sed -E "s# -c [^ ]+# -c $work/report_assets.cpp#" <<<"$command")
(cd "$binary" && bash -c "$(adapted "$command" "$work/objects/comparisons_report_assets.o")") || fail "the page does not compile"

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
grep -q 'Stiffening' log && grep -q 'Graded' log || fail "the law suite has no case of the new laws"
others=$(cd "$binary" && find comparisons/CMakeFiles/springproof.dir -name '*.o' | grep -vxF -f "$work/objects_of_law" | tr '\n' ' ')
link springproof "$work"/objects/comparisons_*.o $others $law || fail "springproof is not linked"
cp "$binary"/springproof-mesh "$binary"/springproof-fem bin
mkdir -p share/springproof && cp -r "$source/meshes/geo" "$source/comparisons/experiments" share/springproof
value() { awk -F, -v model="$1" '$3 == model && $6 == "volume_change" { print $7; exit }' out/results.csv; }
same() {  # A NEW MODEL AND AN OLD ONE, AT A POISSON'S RATIO: the same at small strain
  bin/springproof list | grep -q "^  $1 " || fail "$1 is not listed"
  sed -e "s/^models = .*/models = [\"$1\", \"$2\"]/" -e '/^\[\[expect\]\]/,$d' share/springproof/experiments/golec_2019/compression.toml >cube.toml
  bin/springproof compare cube.toml --poisson-ratio "$3" --out out >log 2>&1 || fail "compare with $1: status $?: $(tail -5 log)"
  awk -v new="$(value "$1")" -v old="$(value "$2")" 'BEGIN { exit !(old != 0 && (new - old) ^ 2 <= (1e-6 * old) ^ 2) }' ||
    fail "at small strain: $1 '$(value "$1")', $2 '$(value "$2")'"
}
same msm_stiffening msm_18 0.25
same hybmss_graded hybmss 0.4

# The section of the report, drawn where there is a browser.
grep -q '^function countedSection' out/report.html || fail "the report has no script of the new section"
if command -v chromium >/dev/null; then
  timeout 300 chromium --headless --no-sandbox --user-data-dir="$work/profile" --dump-dom "file://$work/out/report.html" >dom 2>log
  grep -q '<a href="#counted">Counted runs</a>' dom && grep -q '<table class="counted">' dom || fail "the new section is not drawn: $(tail -3 log)"
fi

# The subcommand and the export format.
bin/springproof --help | grep -q '^ *count ' || fail "the subcommand is not in --help"
models=$(grep -cE '^ +\{"[a-z0-9_]+", +"' msm/parameters/model_table.cpp)
bin/springproof count | grep -qx "$models models" || fail "counted: $(bin/springproof count), of $models"
bin/springproof export cube.toml --to points --out points.csv >log 2>&1 || fail "export: $(cat log)"
head -1 points.csv | grep -qx 'x_m,y_m,z_m' && [ "$(wc -l <points.csv)" -gt 8 ] || fail "the points: $(head -3 points.csv)"
exit $((failures > 0))
