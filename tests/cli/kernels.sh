#!/usr/bin/env bash
# Kernels bring no inline function into the program that another processor could not run.   kernels.sh BUILD-FOLDER
set -u
command -v nm >/dev/null || { echo "no nm"; exit 77; }
failed=0
checked=0
for set in portable avx2 avx512; do
  for object in "$1"/msm/CMakeFiles/msm_$set.dir/kernels/*.o; do
    [ -e "$object" ] || continue
    checked=$((checked + 1))
    foreign=$(nm -C --defined-only "$object" | grep -E ' [WVuTB] ' | grep -v -e "springproof::$set::" -e "DW.ref.__gxx_personality_v0")
    [ -z "$foreign" ] && continue
    echo "FAILED: $object defines"
    echo "$foreign"
    failed=1
  done
done
[ $checked -gt 0 ] || { echo "FAILED: no kernels in $1"; exit 1; }
echo "$checked kernels"
exit $failed
