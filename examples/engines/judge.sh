#!/usr/bin/env bash
# Real-time engines judged as any model is: bar.toml is exported, an engine lets it come to rest under its weight, and
# `springproof compare` sets what it wrote beside springs and finite elements.
#
#   judge.sh SPRINGPROOF FOLDER [ENGINE...]
#
# ENGINE: springs (a program of one's own), jolt, mujoco, bullet; default: all.  FOLDER gets the exported bodies, a CSV
# file for each engine, the case and its report.  What is not installed is named and left out.
# Exit status: that of compare, 77 if no engine is installed, another if one fails.
set -eu
program=$1 out=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
[ $# -gt 0 ] || set -- springs jolt mujoco bullet
mkdir -p "$out"
cp "$here/bar.toml" "$out/engines.toml"

# What ENGINE needs that is not there.
lacks() {
  case $1 in
    bullet) pkg-config --exists bullet 2>/dev/null || echo "Debian's packages libbullet-dev and pkg-config" ;;
    *) command -v node >/dev/null || echo "node" ;;
  esac
  case $1 in
    jolt) [ -d "$here/node_modules/jolt-physics" ] || echo "its package: npm ci in $here" ;;
    mujoco) [ -d "$here/node_modules/@mujoco/mujoco" ] || echo "its package: npm ci in $here" ;;
  esac
}

judged=
for engine in "$@"; do
  lacking=$(lacks "$engine")
  if [ -n "$lacking" ]; then
    echo "$engine: not judged: install ${lacking//$'\n'/, }"
    continue
  fi
  to=$engine body=$out/$engine.json run=(node "$here/$engine.mjs")
  case $engine in
    springs) to=jolt ;;
    mujoco) body=$out/mujoco.xml ;;
    bullet)
      run=("$out/bullet")
      # shellcheck disable=SC2046
      "${CXX:-c++}" -std=c++20 -O2 -w $(pkg-config --cflags bullet) "$here/bullet.cpp" -o "$out/bullet" $(pkg-config --libs bullet)
      ;;
  esac
  "$program" export "$out/engines.toml" --to "$to" --out "$body"
  "${run[@]}" "$body" "$out/$engine.csv"
  cat >>"$out/engines.toml" <<TOML

[[external]]
name = "$engine"
file = "$engine.csv"
poisson_ratio = 0.25
springs = false
TOML
  judged=yes
done
[ -n "$judged" ] || exit 77
"$program" compare "$out/engines.toml" --out "$out/report"
