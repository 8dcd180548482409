#!/usr/bin/env bash
# Public headers say what each of their names is.   reference.sh SOURCE-FOLDER
# Doxygen warns of nothing in them; of headers that programs begin with, every parameter and return value is described.
. "$(dirname "$0")/../cli/lib.sh"
cd "$1" || exit 1
command -v doxygen >/dev/null || { echo "doxygen is not installed (apt-get install doxygen)"; exit 77; }

# Headers that a program begins with: all functions of a task on the first page of the reference.
begin="msm/models.h msm/parameters/model_table.h msm/laws/laws.h msm/topology/network.h msm/embedding/boundary.h
  msm/statics/equilibrium.h msm/dynamics/dynamics.h msm/dynamics/time_step.h msm/dynamics/natural_modes.h
  msm/exchange/springs_file.h meshes/mesh.h"
# warnings SETTING...: of the reference with these settings.
warnings() { { cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $work"; printf '%s\n' "$@"; } | doxygen - 2>&1; }
all=$(warnings "GENERATE_HTML = NO" "GENERATE_TAGFILE = $work/names")
[ -z "$all" ] || { echo "$all"; fail "warnings of public headers"; }
described=$(grep -c '<compound kind="file">' "$work/names")
[ "$described" -ge 50 ] || fail "only $described headers are described"
# Doxygen 1.9.4 knows what functions lack only where it writes pages.
of_functions=$(warnings "INPUT = ${begin//$'\n'/ } docs/reference.dox" "WARN_NO_PARAMDOC = YES" "SEARCHENGINE = NO" "SOURCE_BROWSER = NO" "VERBATIM_HEADERS = NO" |
  grep -E '(parameters|return type) of member|following parameter')
[ -z "$of_functions" ] || { echo "$of_functions"; fail "parameters or return values"; }

# What examples and pages include is public.
public=$(sed -n '/^INPUT /,/[^\\]$/p' docs/Doxyfile)
while read -r header; do
  [ -e "$header" ] || { fail "$header is named and not there"; continue; }
  grep -qF -e "$header" -e "$(dirname "$header") " <<<"$public" || fail "$header is included by examples or pages, and not public (docs/Doxyfile)"
done < <(grep -hoE '^#include "(problem|meshes|msm)/[^"]+"' examples/*.cpp docs/tutorial.md docs/springs_file.md | cut -d'"' -f2 | sort -u)
echo "$described headers"
exit $((failures > 0))
