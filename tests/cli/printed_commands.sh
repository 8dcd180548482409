#!/usr/bin/env bash
# Every command that a page prints does what the page says.   printed_commands.sh SOURCE-FOLDER BINARY-FOLDER PAGE...
# Commands stand in blocks marked sh, or behind "$ " in blocks without a mark, where what they print follows.  They run in a
# folder that looks like the source tree; case files are those that the page prints.
. "$(dirname "$0")/lib.sh"
source=$1 binary=$2
shift 2

# THE list: what is done with a command, "run [MORE ARGUMENTS]" or "check WHY NOT RUN": that its options and cases exist.
plan() {
  local springproof=build/release/springproof
  case $1 in
    B=build/release | "g++ "* | ./bar) echo run ;;
    "$springproof list" | "$springproof material "* | "$springproof homogenise "* | "$springproof export "* | "$springproof describe "*) echo run ;;
    "$springproof new "*) echo run ;;
    "/usr/bin/python3 examples/hang_springs.py "*) /usr/bin/python3 -c "import scipy" 2>/dev/null && echo run || echo "check it needs SciPy" ;;
    "$springproof compare silicone-bar.toml "*) echo "run --poisson-ratio 0.25" ;;
    "$springproof compare liver.toml "*) echo run ;;
    ./quickstart.sh | "./quickstart.sh test") echo "check it installs, builds and runs everything" ;;
    "ctest --test-dir build/release -"* | "cmake --build build/release --target "*) echo "check ctest would run itself" ;;
    "$springproof compare golec_2019 --shard "* | "$springproof report "*) echo "check it takes a shared folder; cli.shard runs such" ;;
    "sbatch "* | "parallel "*) echo "check it needs a cluster" ;;
    "mpirun "* | "$springproof compare bodies/rabbit_5000 "*) echo "check minutes; cli.mpi_models runs such" ;;
    "$springproof compare golec_2019/"* | "$springproof compare verification" | "$springproof compare calibration" | \
      "$springproof compare large_strain" | "$springproof compare motion")
      echo "check minutes; the tests experiment.* run these cases" ;;
    "$springproof frequencies "*) echo "check it takes half a minute; cli.frequencies runs such" ;;
    "$springproof cross-check "*) echo "check it needs CalculiX; cli.cross_check runs it" ;;
    "$springproof reproduce "*) echo "check minutes; cli.reproduce draws figures from results" ;;
    "$springproof advise "*) echo "check it may end with status 1; cli.advise runs such" ;;
    "$springproof bench "*) echo "check minutes; cli.bench runs such" ;;
    "$springproof diff "*) echo "check it takes the folders of two runs; the tests Differences.* compare such" ;;
    "$springproof pictures"*) echo "check it needs Chromium; cli.pictures runs it" ;;
  esac
}

# The case files of a page.  A file is named by the comment on its first line or by
# the text before it: Save as `NAME.toml`.
write_cases() {
  awk '
    /^```toml$/ { inside = 1; first = 1; next }
    /^```/      { if (inside) name = ""; inside = 0; next }
    !inside && match($0, /Save as `[a-z-]+\.toml`/) { name = substr($0, RSTART + 9, RLENGTH - 10) }
    inside && first { first = 0; if (match($0, /^# [a-z-]+\.toml/)) name = substr($0, 3, RLENGTH - 2) }
    inside && name != "" { print > name }' "$1"
}

# A box in millimetres, the README's body.
write_body() {
  echo "solid liver"
  awk 'BEGIN {
    n = split("0 4 7 3 1 2 6 5 0 1 5 4 3 7 6 2 0 3 2 1 4 5 6 7", corner, " ")
    for (face = 1; face < n; face += 4)
      for (half = 1; half <= 2; ++half) {
        print "facet normal 0 0 0\nouter loop"
        for (k = 0; k < 3; ++k) {
          c = corner[face + (k > 0 ? k + half - 1 : 0)]
          print "vertex", (c % 4 == 1 || c % 4 == 2 ? 120 : 0), (c % 4 >= 2 ? 60 : -20), (c >= 4 ? 40 : 0)
        }
        print "endloop\nendfacet"
      }
  }'
  echo "endsolid liver"
}

# "LINE<tab>COMMAND" for each command of a page, "LINE<tab>> TEXT" for what it prints, "LINE<tab>? COMMAND" for one in the
# text, "LINE<tab>! COMMAND" for one that looks like output.
commands_of() {
  awk -v OFS='\t' '
    function command(line, text) {
      if (held == "") at = line
      held = held text
      if (sub(/\\$/, "", held)) return
      sub(/ +# .*/, "", held); sub(/ +$/, "", held)
      if (held != "" && held !~ /^#/) print at, held
      held = ""
    }
    /^```/ { kind = inside ? "" : ($0 == "```" ? "plain" : substr($0, 4)); inside = !inside; next }
    kind ~ /^(sh|bash|console)$/ { command(NR, $0); next }
    kind == "plain" && (held != "" || /^\$ /) { sub(/^\$ /, ""); command(NR, $0); next }
    kind == "plain" && /^(build\/release\/|\.\/)/ { print NR, "! " $0; next }
    kind == "plain" && NF && $0 != "..." { print NR, "> " $0; next }
    !inside { n = split($0, span, "`"); for (i = 2; i <= n; i += 2) if (span[i] ~ /^springproof [a-z]/) print NR, "? build/release/" span[i] }' "$1"
}

# Whether the words of a line are printed in one line of $output; numbers to 1 %, and what is zero but for rounding.
printed() {
  awk -v want="$1" '
    function plain(word) { gsub(/^\(|[),:]+$/, "", word); return word }
    function number(word) { return word ~ /^[+-]?[0-9.]+(e[+-]?[0-9]+)?$/ }
    function size(x) { return x < 0 ? -x : x }
    function same(a, b) {
      if (a == b) return 1
      a = plain(a); b = plain(b)
      return number(a) && number(b) && (size(a - b) <= 0.01 * size(a) || size(a) < 1e-9 && size(b) < 1e-9)
    }
    BEGIN { n = split(want, w, " ") }
    NF == n { for (i = 1; i <= n && same(w[i], $i); ++i); if (i > n) { found = 1; exit } }
    END { exit !found }' "$output"
}

# A script of the source tree exists and knows its arguments.
check_script() {
  local script=$1 word
  bash -n "$source/$script" || return 1
  for word in "${@:2}"; do grep -qw -- "$word" "$source/$script" || { echo "no $word in $script"; return 1; }; done
}

# What ctest or cmake is to take (the last word: a test, a label, a target) is somewhere in the sources.
check_name() {
  local folders=()
  for folder in tests examples comparisons msm; do folders+=("$source/$folder"); done
  grep -rqwF --include='*_test.cpp' --include=CMakeLists.txt -- "${*: -1}" "${folders[@]}" || { echo "no ${*: -1}"; return 1; }
}

# Options are those of --help, cases those of `list`.
check() {
  local words word help takes_value=0 cases
  read -ra words <<<"$1"
  case ${words[0]} in
    build/release/springproof) ;;
    mpirun) [ -x "${words[3]}" ] || return 0; words=("${words[3]}" "" "${words[@]:4}") ;;
    ctest | cmake) check_name "${words[@]}"; return ;;
    sbatch | parallel) check "$(sed -E "s/.* '([^']*)'.*/\1/" <<<"$1")"; return ;;
    *) check_script "${words[@]}"; return ;;
  esac
  help=$("${words[0]}" ${words[1]:+"${words[1]}"} --help) || { echo "no command ${words[1]}"; return 1; }
  cases=$(build/release/springproof list)
  for word in "${words[@]:2}"; do
    if [ $takes_value = 1 ]; then takes_value=0; continue; fi
    case $word in
      -*) grep -qE -- "(^|[ ,])${word%%=*}([ ,]|$)" <<<"$help" || { echo "no option $word"; return 1; }
          grep -qE -- "(^|[ ,])$word [A-Z]" <<<"$help" && takes_value=1 ;;
      [A-Z]*) ;;  # stands for a name
      *) [ "${words[1]}" = bench ] || [ -e "$word" ] || grep -qE "^  ${word}[ /]" <<<"$cases" || { echo "no case $word"; return 1; } ;;
    esac
  done
  return 0
}

cd "$work" || exit 1
mkdir build && ln -s "$binary" build/release && ln -s "$source/examples" examples
output=$work/output
write_body >liver.stl

for page in "$@"; do
  write_cases "$source/$page"
  found=0 whole=0
  while IFS=$'\t' read -r line command; do
    at="$page:$line: $command"
    case $command in
      "> "*) [ $whole = 0 ] || printed "${command#> }" || fail "$page:$line: not printed: ${command#> }"; continue ;;
      "! "*) fail "$page:$line: mark this block sh, or put '$ ' before its commands"; continue ;;
      "? "*) check "${command#"? "}" || fail "$at"; continue ;;
    esac
    found=$((found + 1)) whole=0
    what=$(plan "$command")
    case $what in
      run*)
        if [[ $command =~ ^[A-Z]+=[^\ ]+$ ]]; then eval "export $command"; continue; fi
        timeout 120 bash -c "$command${what#run}" >"$output" 2>&1 </dev/null || fail "$at: status $?: $(tail -n 3 "$output")"
        [ "$what" != run ] || whole=1 ;;
      check*) check "$command" || fail "$at" ;;
      *) fail "$at: neither run nor checked: add it to the list in tests/cli/printed_commands.sh" ;;
    esac
  done < <(commands_of "$source/$page")
  echo "$page: $found commands"
  [ $found -ge 4 ] || fail "$page: only $found commands found"
done
exit $((failures > 0))
