# What the tests of the command line share; they read it in.
set -u
failures=0
work=$(mktemp -d)  # a folder of the test's own
trap 'rm -rf "$work"' EXIT

# fail WORDS [FILE...]: says it, prints the files and counts.
fail() {
  echo "FAILED: $1"
  shift
  [ $# -eq 0 ] || cat "$@"
  failures=$((failures + 1))
}

# stop WORDS: fails with $work/log, and the test ends.
stop() {
  fail "$1" "$work/log"
  exit 1
}

# refused PATTERN ARGUMENTS...: $program ends with 2 and says why.
refused() {
  local pattern=$1
  shift
  "$program" "$@" >"$work/log" 2>&1
  [ $? -eq 2 ] && grep -qE -- "$pattern" "$work/log" || fail "not refused: $*" "$work/log"
}

# entry CSV COLUMN NAME=VALUE...: that column of the rows whose columns NAME are VALUE.
entry() {
  awk -F, -v column="$2" -v wanted="${*:3}" '
    NR == 1 { n = split(wanted, want, "[ =]"); for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { for (i = 1; i < n; i += 2) if ($at[want[i]] != want[i + 1]) next; print $at[column] }' "$1"
}

# numbers FOLDER: its results.csv and results.json, but for times and memory.
numbers() { cat "$1/results.csv" && grep -vE '"(generated|seconds|set_up_seconds|memory_MiB)"' "$1/results.json"; }

# block_case POISSON-RATIOS [CELLS]: a block whose top is lifted by a hundredth.
block_case() {
  cat <<TOML
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = ${2:-[2, 2, 2]}
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = $1
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
TOML
}

# small_case POISSON-RATIOS: the block by one model, beside finite elements.
small_case() {
  block_case "$1"
  cat <<'TOML'
[compare]
models = ["hybmss"]
[reference]
cells = [4, 4, 4]
TOML
}
