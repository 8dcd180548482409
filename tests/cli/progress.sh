#!/usr/bin/env bash
# Long runs speak: a live line on a terminal, a line per long phase elsewhere, an estimate before long runs.   progress.sh PROGRAM
. "$(dirname "$0")/lib.sh"
program=$1
trap '[ -z "$(jobs -p)" ] || kill $(jobs -p); rm -rf "$work"' EXIT
write_case() {  # NAME REFERENCE_CELLS
  { block_case '[0.3, 0.48]' '[4, 4, 4]'; printf '[reference]\ncells = [%s, %s, %s]\n' "$2" "$2" "$2"; } >"$work/$1.toml"
}
write_case short 8
write_case seconds 8
write_case minutes 96

# Not a terminal, short phases: a line per part, nothing else; --quiet: nothing.
"$program" compare "$work/short.toml" --out "$work/out" 2>"$work/log" >"$work/results" || stop "a short run failed"
[ "$(wc -l <"$work/log")" -eq 2 ] || stop "a short run should say one line per part"
"$program" compare "$work/short.toml" --out "$work/out" --quiet 2>"$work/log" >"$work/results" || stop "a quiet run failed"
[ ! -s "$work/log" ] || stop "--quiet says something"

# Not a terminal, a phase of more than ten seconds: one line.  The first grid is at it until that is said.
cat >"$work/slow" <<SLOW
#!/usr/bin/env bash
for ((i = 1; i < \$#; ++i)); do
  if [ "\${!i}" = --progress ] && [ ! -e "$work/slow_once" ]; then
    : >"$work/slow_once"
    j=\$((i + 1))
    printf 'a phase\nits detail\n' >"\${!j}.new" && mv "\${!j}.new" "\${!j}"
    until grep -q 'so far' "$work/slow_log"; do sleep 0.1; done
  fi
done
exec "$(dirname "$program")/springproof-fem" "\$@"
SLOW
chmod +x "$work/slow"
SPRINGPROOF_FEM_PROGRAM="$work/slow" "$program" compare "$work/short.toml" --poisson-ratio 0.3 --out "$work/slow_out" 2>"$work/slow_log" >"$work/slow_results" &
slow=$!  # it sleeps while the others run

# More than a minute: an estimate, once the coarsest grid has shown how fast this machine is, and how the models compare with it.
"$program" compare "$work/minutes.toml" --out "$work/out" 2>"$work/log" >"$work/results" &
pid=$!
until grep -q 'beside the coarsest grid alone: ' "$work/log"; do kill -0 $pid 2>/dev/null || break; sleep 0.1; done
kill -INT $pid
wait $pid
[ $? -eq 130 ] || stop "an interrupted run should end with 130"
head -1 "$work/log" | grep -Eq '^about ([0-9]+ (s|min|h) )+for 2 parts, [12] at once$' || stop "no estimate of a long run"
grep -Eq '^\[[12]/2\] minutes  nu0\.(3|48): beside the coarsest grid alone: [a-z_]+ [0-9.]+ %' "$work/log" || stop "no first verdict of a long run"

# A terminal: the live line says what springproof-fem is at, and is gone at the end, interrupted or not.
script --version >/dev/null 2>&1 || { echo "no terminal to be had: install util-linux"; exit 77; }
gone_at_the_end() {
  local text
  text=$(cat "$work/log")
  [[ "${text##*finite elements}" == *$'\r\e[K'* ]] || stop "$1"
}
# seen FILE: a solver that ends when the terminal has shown what it was at, and then a detail of it.
cat >"$work/seen" <<SEEN
#!/usr/bin/env bash
"$(dirname "$program")/springproof-fem" "\$@" || exit
for ((i = 1; i < \$#; ++i)); do
  [ "\${!i}" = --progress ] || continue
  j=\$((i + 1))
  read -r phase <"\${!j}"
  until grep -qF "\$phase" "$work/log"; do sleep 0.05; done
  printf '%s\niteration 7\n' "\$phase" >"\${!j}.new" && mv "\${!j}.new" "\${!j}"
  until grep -qF "\$phase, iteration 7, " "$work/log"; do sleep 0.05; done
done
SEEN
chmod +x "$work/seen"
: >"$work/log"
SPRINGPROOF_FEM_PROGRAM="$work/seen" script -qefc "stty cols 200; '$program' compare '$work/seconds.toml' --poisson-ratio 0.3 --jobs 1 --out '$work/out' >'$work/results'" "$work/log" >/dev/null || stop "a run on a terminal failed"
for grid in 'q2 on 2 x 2 x 2' 'q2 on 4 x 4 x 4' 'q2 on 8 x 8 x 8' 'q1 on 4 x 4 x 4'; do
  grep -q "finite elements, $grid cells" "$work/log" || stop "no live line of $grid"
done
grep -q 'finite elements, q' "$work/results" && stop "the live line went to standard output"
gone_at_the_end "the live line is left behind"
: >"$work/log"
script -qefc "stty cols 200; '$program' compare '$work/minutes.toml' --jobs 1 --out '$work/out' & until grep -q 'finite elements[,] ' '$work/log'; do sleep 0.1; done; kill -INT \$!; wait \$!" "$work/log" >/dev/null
[ $? -eq 130 ] || stop "an interrupted run on a terminal should end with 130"
gone_at_the_end "an interrupt leaves the live line behind"

wait $slow || { mv "$work/slow_log" "$work/log"; stop "a slow run failed"; }
mv "$work/slow_log" "$work/log"
[ "$(grep -c '^  \[1/1\] short  nu0.3: a phase, its detail ([0-9]* s so far' "$work/log")" -eq 1 ] || stop "a phase of 11 s should have one line"
grep -q 'a phase' "$work/slow_results" && stop "progress went to standard output"
echo "long runs speak"
