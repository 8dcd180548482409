#!/usr/bin/env bash
# A closed or full log ends no run, and an answer that is lost is never status 0.   streams.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
[ -e /dev/full ] || { echo "there is no /dev/full"; exit 77; }
small_case '[0.25, 0.4]' >"$work/case.toml"
compare=(compare "$work/case.toml" --jobs 1 --out)

# What is said of the run is lost, not the run: full, closed, a reader that has ended.
mkfifo "$work/pipe"
exec 3<>"$work/pipe" 4>"$work/pipe" 3>&-
"$program" "${compare[@]}" "$work/out" >"$work/answer" 2>"$work/log" || stop "a run with all its streams failed"
[ -s "$work/log" ] || stop "this run says nothing: it proves nothing"
: >"$work/log"
same() { cmp -s "$work/out/results.csv" "$1/results.csv" && [ -s "$1/report.html" ] || stop "$2: other results"; }
"$program" "${compare[@]}" "$work/full" >"$work/answer" 2>/dev/full || stop "a full log ends the run ($?)"
same "$work/full" "a full log"
"$program" "${compare[@]}" "$work/closed" >"$work/answer" 2>&- || stop "a closed log ends the run ($?)"
same "$work/closed" "a closed log"
"$program" "${compare[@]}" "$work/unread" >"$work/answer" 2>&4 || stop "a log that nobody reads ends the run ($?)"
same "$work/unread" "a log that nobody reads"

# The answer is lost: the files are there, and the status tells.
lost() {  # STATUS WHAT
  [ "$1" -ne 0 ] && [ "$1" -lt 128 ] || stop "$2: status $1"
  grep -q '^error: standard output cannot be written: ' "$work/log" || stop "$2: it is not said"
}
"$program" "${compare[@]}" "$work/mute" >&- 2>"$work/log"
lost $? "compare, closed"
same "$work/mute" "standard output closed"
"$program" "${compare[@]}" "$work/mute" >&- 2>&-
[ $? -eq 1 ] || stop "compare, all closed: a lost answer is status 0"
same "$work/mute" "all closed"
own() {  # of the commands of the program
  "$program" "$@" >/dev/full 2>"$work/log"
  lost $? "$* >/dev/full"
  "$program" "$@" >&- 2>"$work/log"
  lost $? "$* >&-"
}
own --help
own --version
own compare --help
own list
own describe bash
own describe man
own material -E 1e4 --nu 0.3 --cell-size 0.1
own homogenise --model msm_18 -E 1e4 --nu 0.25 --json
own homogenise --model msm_18 -E 1e4 --nu 0.25
own diff "$work/out" "$work/full"
own export "$work/case.toml" --poisson-ratio 0.25 --model hybmss --to springs --out "$work/springs.json"
own frequencies "$work/case.toml" --poisson-ratio 0.25 --modes 2
"$program" "${compare[@]}" "$work/mute" >/dev/full 2>"$work/log"
lost $? "compare >/dev/full"
for name in springproof-mesh springproof-fem springproof-bench springproof-mpi; do
  other=$(dirname "$program")/$name
  [ -x "$other" ] || continue
  argument=--help
  [ $name = springproof-mesh ] && argument=--version
  "$other" $argument >/dev/full 2>"$work/log"
  lost $? "$name $argument >/dev/full"
done

# Who reads the first lines only ends the program as every other, without a word.
"$program" list 2>"$work/log" >&4
[ $? -eq 141 ] && [ ! -s "$work/log" ] || stop "an answer that is read no further"
echo "no run is lost with its log, no answer unsaid"
