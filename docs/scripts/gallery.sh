#!/usr/bin/env bash
# The pictures of docs/gallery.md.   docs/scripts/gallery.sh [FOLDER] [NAME...]
# FOLDER (default build/gallery) keeps the results; NAME: only these pictures (bent, twisted, rabbit, ...).  Some ten minutes on two idle cores.
# Needs build/release/springproof, Chromium (no display) and ImageMagick.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)
springproof=${SPRINGPROOF:-$repository/build/release/springproof}
experiments=$repository/comparisons/experiments
folder=$(realpath -m "${1:-$repository/build/gallery}")
only=" ${*:2} "
mkdir -p "$folder" "$repository/docs/gallery"

wanted() { [ "$only" = "  " ] || [[ $only == *" $1 "* ]]; }

# case_with CASE MODELS: a built-in case with these models and without its expectations, in a file of the same name.
case_with() {
  local file=$folder/$(basename "$1").toml
  awk -v models="$2" '/^\[\[(expect|published)\]\]/ { exit }
    /^models = / { print "models = [" models "]"; skip = !/\]$/; next } skip { skip = !/^\]/; next } { print }' "$experiments/$1.toml" >"$file"
  echo "$file"
}

# finish FILE NAME [WIDTH]: a picture of the page, small.
finish() { convert "$1" -resize "${3:-1000}x>" +dither -colors 255 -strip "PNG8:$repository/docs/gallery/$2.png"; }

# picture NAME FIGURE CASE-FILE OPTION...: one figure of a comparison.
picture() {
  wanted "$1" || return 0
  "$springproof" compare "$3" "${@:4}" --out "$folder/$1" --resume --quiet | tail -n 2
  "$springproof" pictures "$folder/$1" --only "$2"
  finish "$(find "$folder/$1/png" -name "*$2*.png" | head -n 1)" "$1"
}

picture bent shapes-displacement "$(case_with large_strain/bending '"hybmss_avg", "hybmss", "emsm"')" --poisson-ratio 0.45
picture twisted shapes-volume_change "$(case_with large_strain/torsion '"hybmss_avg", "hybmss"')" --poisson-ratio 0.25
picture rabbit shapes-displacement-smooth "$(case_with bodies/rabbit '"hybmss_avg", { model = "hybmss_avg", cut = false }, "msm_18"')" --poisson-ratio 0.4
picture cut_cells convergence-reaction_error "$(case_with bodies/cylinder_compression '"hybmss_avg", { model = "hybmss_avg", cut = false }')"
picture wrinkles shapes-displacement "$(case_with golec_2019/ten_seconds/table2_compression_20 '"hybmss", "hybmss_fd"')" --poisson-ratio 0.25
picture squeezed shapes-volume_change "$(case_with kot_2015/fig_9 '"hybmss", { model = "emsm", label = "emsm" }, "hybmss_avg"')" --poisson-ratio 0.47

if wanted motion; then
  cat >"$folder/plucked.toml" <<'END'
what = "A bar held at one end, pulled down at the other, and let go."
kinematics = "hencky"
[body]
geo = "beam.geo"
size_m = [0.4, 0.1, 0.1]
cells = [16, 4, 4]
[material]
youngs_modulus_Pa = 2.5e5
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
force_N = [0, 0, -2]
[dynamics]
duration_s = 1.5
start = "equilibrium"
samples = 400
[[probe]]
name = "tip"
at_m = [0.4, 0.05, 0.05]
[compare]
models = ["hybmss_avg", "hybmss"]
measures = ["probe", "displacement_error"]
END
  picture motion motion-displacement.tip.z "$folder/plucked.toml"
fi

if wanted cracks; then
  "$springproof" compare "$(case_with kot_2014/fig_15 '{ model = "msm_centred", label = "18 springs" }, { model = "msm_centred", label = "14 springs", face_to_cube = 0 }, "msm_random"')" \
    --out "$folder/cracks" --resume --quiet | tail -n 2
  for model in 18_springs 14_springs msm_random; do
    printf '<img src="%s" width="330">\n' "$(cd "$folder/cracks" && echo "$PWD"/*-cracks-$model-25x25x4-nu0.25.svg)"
  done >"$folder/cracks/seen_from_above.html"
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1030,350 --screenshot="$folder/cracks/seen.png" \
    "file://$folder/cracks/seen_from_above.html" >/dev/null 2>&1
  finish "$folder/cracks/seen.png" cracks
fi
