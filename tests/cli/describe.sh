#!/usr/bin/env bash
# The man page and the completion know every command and option of --help, and work; docs/keys.md is what the program prints.   describe.sh PROGRAM SOURCE-FOLDER
. "$(dirname "$0")/lib.sh"
program=$1 source=$2

"$program" describe man >"$work/springproof.1" || { fail "describe man: status $?"; exit 1; }
"$program" describe bash >"$work/springproof" || { fail "describe bash: status $?"; exit 1; }
"$program" describe rtf >"$work/out" 2>&1; [ $? -eq 2 ] || fail "describe rtf is not refused"
page=$(sed 's/\\-/-/g; s/\\f[A-Z]//g' "$work/springproof.1")
# shellcheck source=/dev/null
source "$work/springproof" || fail "the completion is no script for bash"

# complete_words WORD...: what may follow when the last of them is begun.
complete_words() {
  COMP_WORDS=(springproof "$@") COMP_CWORD=$#
  _springproof
  echo " ${COMPREPLY[*]} "
}

commands=$("$program" --help | awk '/^Subcommands:/ { inside = 1; next } inside && /^  [a-z]/ { print $1 }')
[ "$(wc -w <<<"$commands")" -ge 8 ] || fail "only these commands in --help: $commands"
for command in $commands; do
  grep -q "^\.SS springproof $command" <<<"$page" || fail "no command $command in the man page"
  [[ $(complete_words "${command:0:3}") == *" $command "* ]] || fail "${command:0:3} is not completed to $command"
  [ "$command" != bench ] || continue  # another program's options
  for option in $("$program" "$command" --help | grep -oE '^  -[^ ]*' | tr ',' '\n' | sed -E 's/^ +//; s/[{=].*//'); do
    awk -v begin=".SS springproof $command" 'index($0, begin) == 1 { inside = 1; next } /^\.S/ { inside = 0 } inside' <<<"$page" |
      grep -qE -- "(^|[ ,])$option([ ,]|$)" || fail "no $command $option in the man page"
    [[ $(complete_words "$command" "$option") == *" $option "* ]] || fail "$command $option is not completed"
  done
done

[[ $(complete_words material --model hybmss_b) == *" hybmss_bt "* ]] || fail "no models after --model"
[[ $(complete_words compare golec_2019/comp) == *" golec_2019/compression "* ]] || fail "no built-in cases after compare"
[[ $(complete_words compare golec_2019/compression --out "$work/spring") == *"$work/springproof.1"* ]] || fail "no files after --out"
[[ $(complete_words material --model "$work/") != *"$work"* ]] || fail "files after --model"
[[ $(complete_words descr) != *describe* ]] || fail "the hidden command is completed"

"$program" describe keys | diff "$source/docs/keys.md" - >"$work/diff" ||
  fail "docs/keys.md is not what springproof describe keys prints:"$'\n'"$(head "$work/diff")"

# The variables that the sources read.
variables=$(grep -rhoE '"SPRINGPROOF_[A-Z_]+"' --include='*.cpp' "$source"/{problem,meshes,msm,fem_reference,comparisons} | tr -d '"' | sort -u)
[ "$(wc -w <<<"$variables")" -ge 6 ] || fail "only these variables found: $variables"
for variable in $variables; do grep -q "^$variable$" <<<"$page" || fail "no $variable in the man page"; done

if command -v groff >/dev/null; then
  warnings=$(groff -man -ww -Tutf8 "$work/springproof.1" 2>&1 >"$work/out")
  [ -z "$warnings" ] || fail "groff warns: $warnings"
  grep -q 'NAME' "$work/out" || fail "groff prints nothing"
fi
exit $((failures > 0))
