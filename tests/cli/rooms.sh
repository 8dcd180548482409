#!/usr/bin/env bash
# The rooms (folders) of each module include each other in one direction.   rooms.sh MODULE...
set -u
failures=0
for module in "$@"; do
  arrows=$(grep -rE "^#include \"$module/" --include=*.h --include=*.cpp "$module" | sed -E 's/^([^:]*)\/[^/]*:#include "([^"]*)\/[^/"]*".*/\1 \2/' |
           awk '$1 != $2' | sort -u)
  if circle=$(tsort <<<"$arrows" 2>&1 >/dev/null) && [ -z "$circle" ]; then
    echo "$module: $(wc -l <<<"$arrows") arrows between rooms, no circle"
  else
    echo "FAILED: rooms of $module include each other in a circle:"
    echo "$circle"
    failures=$((failures + 1))
  fi
done
exit $((failures > 0))
