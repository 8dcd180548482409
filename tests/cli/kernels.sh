#!/usr/bin/env bash
# Kernels bring no inline function into the program that another processor could not run.   kernels.sh BUILD-FOLDER
. "$(dirname "$0")/lib.sh"
command -v nm >/dev/null || { echo "no nm"; exit 77; }
checked=0
for set in portable avx2 avx512; do
  for object in "$1"/msm/CMakeFiles/msm_$set.dir/kernels/compiled/*.o; do
    [ -e "$object" ] || continue
    checked=$((checked + 1))
    foreign=$(nm -C --defined-only "$object" | grep -E ' [WVuTB] ' | grep -v -e "springproof::$set::" -e "DW.ref.__gxx_personality_v0")
    [ -z "$foreign" ] && continue
    fail "$object defines"$'\n'"$foreign"
  done
done
[ $checked -gt 0 ] || { echo "FAILED: no kernels in $1"; exit 1; }
echo "$checked kernels"
exit $((failures > 0))
