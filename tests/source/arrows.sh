#!/usr/bin/env bash
# problem <- meshes <- {msm, fem_reference} <- comparisons: each module finds the headers of what lies below it and none of
# what lies beside or above.   arrows.sh COMPILER BUILD_DIRECTORY EIGEN_INCLUDE
. "$(dirname "$0")/../cli/lib.sh"
compiler=$1 views=$(readlink -f "$2")/arrows eigen=$3
cd /  # a quoted include is looked for in the working directory too
declare -A below=(
  [problem]="problem" [meshes]="problem meshes" [msm]="problem meshes msm"
  [fem_reference]="problem meshes fem_reference" [comparisons]="problem meshes msm fem_reference comparisons"
)
declare -A header=(
  [problem]=problem/material.h [meshes]=meshes/mesh.h [msm]=msm/topology/network.h
  [fem_reference]=fem_reference/exchange/reference.h [comparisons]=comparisons/results/records.h
)
for module in "${!below[@]}"; do
  paths=(-isystem "$eigen")
  for m in ${below[$module]}; do paths+=("-I$views/$m"); done
  for other in "${!header[@]}"; do
    allowed=no
    [[ " ${below[$module]} " == *" $other "* ]] && allowed=yes
    compiles=no
    echo "#include \"${header[$other]}\"" | "$compiler" -std=c++20 -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 "${paths[@]}" -M -x c++ - >/dev/null 2>&1 && compiles=yes
    [ $allowed = $compiles ] || fail "in $module, ${header[$other]} is found: $compiles, allowed: $allowed"
  done
done
grep -rnE '#include +"\.\./' --include=*.h --include=*.cpp "$(readlink -f "$views/problem/problem/..")"/{problem,meshes,msm,fem_reference,comparisons} &&
  fail "includes that go around the arrows"
[ $failures -eq 0 ] && echo "arrows hold"
exit $((failures > 0))
