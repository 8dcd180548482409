#!/usr/bin/env bash
# The rooms (folders) of each module include each other in one direction, and no circle of includes has more units (X.h
# and X.cpp) than a class and its parts.   rooms.sh MODULE...
. "$(dirname "$0")/../cli/lib.sh"
largest_circle=3
for module in "$@"; do
  units=$(grep -rE "^#include \"$module/" --include=*.h --include=*.cpp "$module" |
          sed -E 's/^([^:]*)\.(h|cpp):#include "([^"]*)\.[a-z]+".*/\1 \3/' | awk '$1 != $2' | sort -u)
  arrows=$(sed -E 's#/[^/ ]*( |$)#\1#g' <<<"$units" | awk '$1 != $2' | sort -u)
  if circle=$(tsort <<<"$arrows" 2>&1 >/dev/null) && [ -z "$circle" ]; then
    echo "$module: $(wc -l <<<"$arrows") arrows between rooms, no circle"
  else
    fail "rooms of $module include each other in a circle:"$'\n'"$circle"
  fi
  # Units that reach each other.
  circles=$(awk '
    { next_of[$1] = next_of[$1] " " $2; all[$1]; all[$2] }
    function walk(from, unit,  list, n, i) {
      n = split(next_of[unit], list, " ")
      for (i = 1; i <= n; ++i) if (!((from, list[i]) in reached)) { reached[from, list[i]]; walk(from, list[i]) }
    }
    END {
      for (u in all) walk(u, u)
      for (u in all) {
        if (u in named) continue
        text = u; size = 1
        for (v in all) if (v != u && (u, v) in reached && (v, u) in reached) { text = text " " v; ++size; named[v] }
        if (size > '$largest_circle') print text
      }
    }' <<<"$units")
  [ -z "$circles" ] || fail "units of $module include each other in a circle of more than $largest_circle:"$'\n'"$circles"
done
exit $((failures > 0))
