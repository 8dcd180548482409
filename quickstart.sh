#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, and runs the main job:   ./quickstart.sh
# or the tests:                                                          ./quickstart.sh test
# Arguments of `./quickstart.sh` are passed on to `springproof compare`; without any it runs the experiments of
# Golec et al. (2019) in the linear regime, and a rabbit.  Repeating either command only does what is still to be done.
set -euo pipefail
cd "$(dirname "$0")"

packages=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev libxxhash-dev libgtest-dev
  libdeal.ii-dev libopenblas0-serial libgmsh-dev libcgal-dev libjs-chart.js libjs-three
)

install_missing() {
  local missing=() package
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  echo "installing Debian packages: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "quickstart.sh: not root and no sudo; install these packages first" >&2; exit 1; }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# build TARGET...
build() {
  [ -f build/release/build.ninja ] || cmake --preset release
  cmake --build build/release --target "$@"
}

install_missing
if [ "${1:-}" = test ]; then
  shift
  build all
  ctest --test-dir build/release --output-on-failure -j "$(nproc)" "$@"
else
  build meshes/all msm/all fem_reference/all comparisons/all  # the programs, without the tests
  [ $# -gt 0 ] || set -- golec_2019 bodies/rabbit
  build/release/springproof compare --out springproof-report "$@"
  echo "open springproof-report/report.html in a browser"
fi
