#!/usr/bin/env bash
# Every source is as clang-format writes it; 77 where clang-format 14 is missing: others differ in details.   format.sh FOLDER...
set -u
command -v clang-format-14 >/dev/null || { echo "clang-format-14 is not installed (apt-get install clang-format-14)"; exit 77; }
find "$@" -name '*.h' -o -name '*.cpp' | xargs clang-format-14 --dry-run -Werror || { echo "FAILED: run clang-format-14 -i on these"; exit 1; }
