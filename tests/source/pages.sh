#!/usr/bin/env bash
# Every file and heading that a page refers to is there: targets of links, and `paths` that begin with a folder of the source tree.
# A decision has at most 120 words, and a line in the index; README and docs have at most 55,000, of which users' pages 20,000.
#   pages.sh SOURCE-FOLDER
. "$(dirname "$0")/../cli/lib.sh"
cd "$1" || exit 1
found=0

# The anchors of a page's headings, as web pages of it have them: lower case, no punctuation, blanks as dashes.
anchors() { sed -nE 's/^#+ //p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E "s/[^[:alnum:] _-]//g; s/ /-/g"; }

# A path, which may have a * in it, or stand for a header and its source.
is_there() {
  local file
  for file in $1 $1.*; do [ ! -e "$file" ] || return 0; done
  return 1
}

# Text outside of code blocks, but for files that the reader is to write.
text_of() { awk '/^```/ { inside = !inside; next } !inside { gsub(/Save as `[^`]*`/, ""); print }' "$1"; }

mapfile -t pages < <(find . -maxdepth 1 -name '*.md'; find docs -name '*.md')
for page in "${pages[@]}"; do
  while read -r target; do
    found=$((found + 1))
    file=${target%%#*} anchor=
    [[ $target != *"#"* ]] || anchor=${target#*#}
    path=$(dirname "$page")/$file
    [ -n "$file" ] || path=$page
    if [ ! -e "$path" ]; then
      fail "$page links to $target"
    elif [ -n "$anchor" ] && [[ $path == *.md ]] && ! anchors "$path" | grep -qxF "$anchor"; then
      fail "$page links to $target: no such heading"
    fi
  done < <(text_of "$page" | grep -oE '\]\([^)]+\)' | sed -E 's/^\]\(//; s/\)$//' | grep -vE '^[a-z]+:')
  while read -r path; do
    found=$((found + 1))
    is_there "$path" || fail "$page names $path"
  done < <(text_of "$page" | grep -oE '`(problem|meshes|msm|fem_reference|comparisons|tests|docs|examples)/[A-Za-z0-9_./*-]*`' | tr -d '`' | sort -u)
done

# "WORDS<tab>TITLE" for each heading of a page and the text up to the next; bars and rules of tables are no words.
words_by_heading() {
  awk -v OFS='\t' '
    /^#+ / { if (title != "") print words, title; title = $0; sub(/^#+ /, "", title); words = 0; next }
    { for (i = 1; i <= NF; ++i) words += $i !~ /^[-|:]+$/ }
    END { print words, title }' "$1"
}

decisions=0
for page in docs/decisions/*.md; do
  while IFS=$'\t' read -r words title; do
    [ "$words" -le 120 ] || fail "$page: \"$title\" has $words words, a decision has at most 120"
  done < <(words_by_heading "$page")
  while read -r anchor; do
    decisions=$((decisions + 1))
    grep -qF "](${page#docs/}#$anchor)" docs/decisions.md || fail "$page#$anchor is not in docs/decisions.md"
  done < <(anchors <(grep '^##' "$page"))
done
# Words of pages; bars and rules of tables are no words.
words_of() { cat "$@" | awk '{ for (i = 1; i <= NF; ++i) words += $i !~ /^[-|:]+$/ } END { print words }'; }

most_words=55000
words=$(words_of README.md docs/*.md docs/*/*.md)
[ "$words" -le $most_words ] || fail "README and docs have $words words (at most $most_words)"
# Users' pages: all but those for whoever works on the project, the papers, and what was measured (docs/measured/).
most_users_words=20000
mapfile -t users_pages < <(ls README.md docs/*.md | grep -vE '/(contributing|decisions|failed_attempts|papers)[.]md$')
users_words=$(words_of "${users_pages[@]}")
[ "$users_words" -le $most_users_words ] || fail "users' pages have $users_words words (at most $most_users_words): say a thing once, measurements in docs/measured/"
[ ${#users_pages[@]} -ge 15 ] || fail "only ${#users_pages[@]} users' pages found"
[ $decisions -ge 50 ] || fail "only $decisions decisions found"
[ $found -ge 50 ] || fail "only $found links and paths found"
echo "$found links and paths, $decisions decisions, $words words, $users_words of them in users' pages"
exit $((failures > 0))
