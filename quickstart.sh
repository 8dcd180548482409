#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, and runs the main job:   ./quickstart.sh
# or the tests:                                                          ./quickstart.sh test
# or a Python package to import, in build/release/python:                ./quickstart.sh python
# Arguments of `./quickstart.sh` are passed on to `springproof compare`, those of `./quickstart.sh test` to ctest; without
# any the first runs three experiments of Golec et al. (2019) in the linear regime, and a rabbit, at four Poisson's
# ratios.  Repeating either command only does what is still to be done.  Each step says in a few lines how far it is; all of what it prints is in build/log/.
set -euo pipefail
cd "$(dirname "$0")"

packages=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev libxxhash-dev zlib1g-dev libgtest-dev
  libdeal.ii-dev libopenblas0-serial libgmsh-dev libcgal-dev libtinygltf-dev libjs-chart.js libjs-three
)

# A line per tenth of the steps that ninja and ctest number; all of what a failing one prints; ctest's summary.
progress='
  function tenth(done, all) { if (all != of) { of = all; last = 0 }; if (int(10 * done / all) > last) { last = int(10 * done / all); printf "  %d of %d\n", done, all; fflush() } }
  /^Test project/             { testing = 1 }
  !testing && /^\[[0-9]+\/[0-9]+\]/ { failing = 0; split(substr($1, 2), n, /[\/\]]/); tenth(n[1], n[2]); next }
  /^FAILED: /                 { failing = 1 }
  /^ *[0-9]+\/[0-9]+ Test +#/ { failing = !/Passed|Skipped/; gsub(/\.\.\.\.+/, "..."); if (failing) print
                                split($1, n, "/"); tenth(n[1], n[2]); next }
  /^ *Start +[0-9]+:/         { failing = 0 }
  /tests passed,/             { summary = 1 }
  failing || summary          { print; fflush() }'

by_line=(awk)  # mawk, Debian's awk, would wait for 4 KiB of lines
awk -W version </dev/null 2>/dev/null | grep -q '^mawk' && by_line=(awk -W interactive)

# step NAME WHAT COMMAND ...: what is done, how far it is, and where all of its output is; the end of that where it fails.
step() {
  local log=build/log/$1.log what=$2 status=0 start=$SECONDS
  shift 2
  mkdir -p build/log
  echo "$what (log: $log)"
  "$@" 2>&1 | tee "$log" | "${by_line[@]}" "$progress" || status=$?
  if [ $status -ne 0 ]; then
    echo "quickstart.sh: this failed after $((SECONDS - start)) s: $*" >&2
    grep -q 'tests passed,' "$log" || tail -n 25 "$log" >&2
    echo "quickstart.sh: the whole log is $log" >&2
    exit $status
  fi
  echo "  done in $((SECONDS - start)) s"
}

# Why tests did not run: what each of them said, of ctest's own log.
say_what_did_not_run() {
  awk 'FNR == NR { if (/\(Skipped\)$/) skipped[$3]; next }
       / Test: /           { name = $NF; why = "" }
       /: Skipped$/        { if (why == "" && (getline line) > 0) why = line }
       /^<end of output>$/ { if (name in skipped) print "  " name ": " (why == "" ? last : why) }
       { last = $0 }' build/log/test.log build/release/Testing/Temporary/LastTest.log
}

install_missing() {
  local missing=() package as_root=()
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "quickstart.sh: not root and no sudo; install these packages first: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  step lists "reading Debian's package lists" "${as_root[@]}" apt-get update
  step install "installing ${missing[*]}" \
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
}

# build TARGET ...
build() {
  step configure "configuring" cmake --preset release  # always: what has been installed since is seen
  step build "building" cmake --build build/release --target "$@"
}

of_python=(pybind11-dev python3-dev python3-numpy)
case ${1:-} in
  test) packages+=(clang-format-14 "${of_python[@]}" python3-scipy python3-pytest python3-pip python3-setuptools) ;;  # of the tests cli.format, python.* and cli.springs
  python) packages+=("${of_python[@]}") ;;
esac
install_missing
if [ "${1:-}" = test ]; then
  shift
  build all
  # Without those that take another compiler or many minutes: ctest --test-dir build/release -L long (or bodies, recipe, fuzz, hostile)
  step test "running the tests, $(nproc) at a time" ctest --test-dir build/release --output-on-failure -j "$(nproc)" -LE "long|bodies|recipe|fuzz|hostile" "$@"
  say_what_did_not_run
elif [ "${1:-}" = python ]; then
  build springproof springproof-mesh springproof-fem springproof-python
  PYTHONPATH=build/release/python /usr/bin/python3 -c "import springproof"
  echo "PYTHONPATH=$PWD/build/release/python /usr/bin/python3     # import springproof"
else
  build springproof springproof-mesh springproof-fem  # without the bench, the tests and what runs on several processes
  [ $# -gt 0 ] || set -- golec_2019/bending golec_2019/compression golec_2019/torsion bodies/rabbit --poisson-ratio=-0.5,0.25,0.4,0.499
  build/release/springproof compare --out springproof-report "$@"
  echo "open springproof-report/report.html in a browser"
fi
