#!/usr/bin/env bash
# A class of one name is defined in one file, unless in anonymous namespaces: linkers take the first of two and say nothing.
#   one_definition.sh FOLDER...
set -u
files=$(find "$@" -name '*.h' -o -name '*.cpp')
[ -n "$files" ] || { echo "no sources in $*"; exit 1; }
# Prints "NAME FILE" for every class at the level of a named namespace.
found=$(awk '
  FNR == 1 { depth = 0; anonymous = 0; split("", scope); split("", named); head = ""; in_comment = 0 }
  {
    line = $0
    if (in_comment) { if (!sub(/^.*\*\//, "", line)) next; in_comment = 0 }
    gsub(/\\./, "", line); gsub(/"[^"]*"/, "", line); gsub(/\047[^\047]\047/, "", line)
    gsub(/\/\*[^*]*\*\//, "", line); sub(/\/\/.*/, "", line)
    if (sub(/\/\*.*/, "", line)) in_comment = 1
    if (line ~ /^[ \t]*#/) next
    n = length(line)
    for (i = 1; i <= n; ++i) {
      c = substr(line, i, 1)
      if (c == "{") { open_scope(); head = "" }
      else if (c == "}") { close_scope(); head = "" }
      else if (c == ";") head = ""
      else head = head c
    }
    head = head " "
  }
  function open_scope(   words, name) {
    ++depth
    gsub(/template *<[^{]*> *(struct|class)/, "struct", head)
    gsub(/^[ \t]+/, "", head)
    if (head ~ /^(inline )?namespace/) {
      name = head; sub(/^(inline )?namespace */, "", name); gsub(/[ \t]/, "", name)
      scope[depth] = name == "" ? "anonymous" : "namespace"
      named[depth] = name
    } else {
      scope[depth] = "other"
      if (outside() && head ~ /^(struct|class|union|enum( class| struct)?) +[A-Za-z_]/ && head !~ /[()=]/) {
        name = head
        sub(/^(struct|class|union|enum( class| struct)?) +/, "", name); sub(/ .*/, "", name); sub(/:$/, "", name)
        if (name !~ /</) print place() name, FILENAME
      }
    }
  }
  function close_scope() { if (depth > 0) { delete scope[depth]; delete named[depth]; --depth } }
  function outside(   d) { for (d = 1; d < depth; ++d) if (scope[d] != "namespace") return 0; return 1 }
  function place(   d, p) { p = ""; for (d = 1; d < depth; ++d) p = p named[d] "::"; return p }
' $files | sort -u)
[ "$(wc -l <<<"$found")" -ge 5 ] || { echo "only $(wc -l <<<"$found") classes found: the search is broken"; exit 1; }
twice=$(awk '{ print $1 }' <<<"$found" | sort | uniq -d)
for name in $twice; do
  echo "FAILED: $name is defined in$(awk -v name="$name" '$1 == name { printf " %s", $2 }' <<<"$found")"
done
[ -z "$twice" ] && echo "$(wc -l <<<"$found") classes, each defined in one file"
exit $([ -z "$twice" ]; echo $?)
