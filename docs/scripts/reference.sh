#!/usr/bin/env bash
# The reference of the library's public headers as web pages.   docs/scripts/reference.sh [FOLDER]
# FOLDER (default build/reference): its html/index.html is the first page.  Needs doxygen.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/reference}
mkdir -p "$folder"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } | doxygen -
echo "reference: $folder/html/index.html"
