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
