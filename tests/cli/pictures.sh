#!/usr/bin/env bash
# The figures of a report as PNG files.   pictures.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
expect() {   # expect STATUS TEXT COMMAND...: the command ends with it and says it
  local status=$1 text=$2
  shift 2
  "$@" >"$work/log" 2>&1
  [ $? -eq "$status" ] || stop "status is not $status: $*"
  grep -q "$text" "$work/log" || stop "does not say '$text': $*"
}
expect 2 "no report.html here" "$program" pictures "$work"

cat >"$work/case one.toml" <<'TOML'
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [[2, 2, 2], [4, 4, 4]]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.25, 0.4]
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, -0.1]
[reference]
elements = []
[compare]
models = ["hybmss", "msm_18"]
measures = ["displacement_error", "volume_change"]
TOML
out="$work/out & out"   # a folder whose name needs care
"$program" compare "$work/case one.toml" --out "$out" >"$work/log" 2>&1
[ -s "$out/report.html" ] || stop "no report"
expect 2 "apt-get install chromium" env PATH=/nowhere "$program" pictures "$out"
command -v chromium >/dev/null || { echo "chromium is not installed (apt-get install chromium)"; exit 77; }
expect 1 "no picture has 'nothing like it'" "$program" pictures "$out" --only "nothing like it"
expect 1 "not finished after 0.01 s" "$program" pictures "$out" --time-limit 0.01
expect 0 "4 pictures in" "$program" pictures "$out" --only shapes
for name in displacement-nu0.25 displacement-nu0.4 volume_change-nu0.25 volume_change-nu0.4; do
  file=$(echo "$out"/png/*-case_one-shapes-$name.png)   # after the folder of the case
  [ -s "$file" ] || stop "$file is not there"
  [ "$(head -c 4 "$file" | tail -c 3)" = PNG ] || stop "$file is no PNG"
done

# Of several cases that have a reference also the figure of them all.
sed -e 's/^elements = \[\]$/cells = [8, 8, 8]/' "$work/case one.toml" >"$work/one.toml"
sed -e 's/-0.1\]/0.1]/' "$work/one.toml" >"$work/two.toml"
"$program" compare "$work/one.toml" "$work/two.toml" --out "$work/both" >"$work/log" 2>&1
grep -q 'no reference' "$work/log" && { echo "4 pictures; springproof-fem is not built"; exit 0; }
expect 0 "1 pictures in" "$program" pictures "$work/both" --only error-against-poisson-ratio
[ -s "$work/both/png/error-against-poisson-ratio.png" ] || stop "the figure of both cases is not there"
echo "5 pictures"
