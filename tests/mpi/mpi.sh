#!/usr/bin/env bash
# Two processes, and three of a body-fitted mesh, find what one finds, to 1e-9; they share that mesh out.
#   mpi.sh SPRINGPROOF-FEM SPRINGPROOF
program=$1 springproof=$2
. "$(dirname "$0")/mpi_common"

# A block held at both ends, under its weight.   make_case NAME KINEMATICS
make_case() {
  cat >"$work/$1.toml" <<TOML
kinematics = "$2"
[body]
geo = "block.geo"
size_m = [1, 1, 2]
cells = [4, 4, 8]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
density_kg_m3 = 1000
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0.05, 0.02, -0.2]
[[load]]
gravity_m_s2 = [0, 1, 0]
[[probe]]
name = "middle"
at_m = [0.5, 0.5, 1]
[[probe]]
name = "corner"
at_m = [1, 0, 0.75]
[[probe]]
name = "inside"
at_m = [0.31, 0.77, 1.23]
TOML
}

# Curved hexahedra under a pressure.
cat >"$work/cylinder.toml" <<TOML
[body]
geo = "thick_cylinder.geo"
size_m = [9, 9, 1]
cells = [12, 6, 1]
[material]
youngs_modulus_Pa = 1000
poisson_ratio = 0.25
[[load]]
on = ["z_min", "z_max"]
displacement_m = ["free", "free", 0]
[[load]]
on = "x_min"
displacement_m = [0, "free", "free"]
[[load]]
on = "y_min"
displacement_m = ["free", 0, "free"]
[[load]]
on = "inner"
pressure_Pa = 1
[[probe]]
name = "middle"
at_m = [6, 0, 0.5]
[[probe]]
name = "inside"
at_m = [3, 3, 0.25]
TOML
# Probes at nodes of its mesh, some of which are on the boundary between parts.
for radius in 3.5 4 4.5 5 5.5 6.5 7 7.5 8 8.5; do
  printf '[[probe]]\nname = "inside at %s"\nat_m = [%s, 0, 0]\n' $radius $radius >>"$work/cylinder.toml"
done

compare() { same_numbers "$1" "$2" "volume|reaction|middle|corner|inside" 1e-9 9; }

# check [PROCESSES] CASE ARGUMENTS
check() {
  local name=$1 processes=2
  if [[ $name =~ ^[0-9]+$ ]]; then
    processes=$1 name=$2
    shift
  fi
  shift
  "$program" "$work/$name.toml" --tolerance 1e-12 --digits 14 "$@" >"$work/one" 2>&1 || { fail "one process, $name $*" "$work/one"; return; }
  mpirun -np $processes "$program" "$work/$name.toml" --tolerance 1e-12 --digits 14 "$@" >"$work/more" 2>&1 || { fail "$processes processes, $name $*" "$work/more"; return; }
  compare "$work/one" "$work/more" || { fail "$processes processes, $name $*"; return; }
  echo "same: $processes processes, $name $*"
}

# No process of the last check stores more than this share of the cells.   shared_out SHARE
shared_out() {
  awk -v share="$1" '/^ *processes / { most = $7; all = $9 } END { exit !(all > 0 && most <= share * all) }' "$work/more" ||
    fail "not shared out: $(grep processes "$work/more")"
}

make_case block linear
make_case hencky hencky
check block --cells 6 6 12
check block --cells 6 6 12 --poisson-ratio 0.499
check block --cells 6 6 8 --grading 1.5 --element q1
check hencky --cells 4 4 8
check hencky --cells 4 4 8 --poisson-ratio 0.499
check block --cells 4 4 8 --element p2
check block --cells 4 4 8 --element p2 --poisson-ratio 0.499
check hencky --cells 3 3 4 --element p2
check block --cells 4 4 8 --solver assembled
check cylinder --poisson-ratio 0.499
check 3 cylinder
check 3 cylinder --cells 12 6 1 --element p2 --poisson-ratio 0.499
check 3 cylinder --cells 24 12 2 --element p2
shared_out 0.5
check 3 cylinder --cells 24 12 2 --poisson-ratio 0.499
shared_out 0.5

# A ball given by its facets, with probes outside: the reference of `compare`, on three meshes.
awk 'function at(i, j, a, b) { a = i * pi / 8; b = j * pi / 8; return sprintf("vertex %.9g %.9g %.9g\n", sin(a) * cos(b), sin(a) * sin(b), cos(a)) }
     function facet(a, b, c) { printf "facet normal 0 0 0\nouter loop\n%s%s%sendloop\nendfacet\n", a, b, c }
     BEGIN { pi = atan2(0, -1); print "solid ball"
       for (i = 0; i < 8; i++) for (j = 0; j < 16; j++) {
         k = (j + 1) % 16
         if (i < 7) facet(at(i, j % (i ? 16 : 1)), at(i + 1, j), at(i + 1, k))
         if (i > 0) facet(at(i, j), at(i + 1, i < 7 ? k : 0), at(i, k)) }
       print "endsolid" }' >"$work/ball.stl"
cat >"$work/ball.toml" <<TOML
[body]
geo = "ball.stl"
voxels = 60
[[patch]]
name = "held"
beyond = { point_m = [0, 0, -0.2], normal = [0, 0, -1] }
[[patch]]
name = "pulled"
beyond = { point_m = [0, 0, 0.2], normal = [0, 0, 1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.25, 0.499]
[[load]]
on = "held"
displacement_m = [0, 0, 0]
[[load]]
on = "pulled"
force_N = [3, 0, 1]
[[probe]]
name = "left"
at_m = [-1.1, 0.02, 0.03]
[[probe]]
name = "front"
at_m = [0.3, -1.05, 0.1]
[[probe]]
name = "edge"
at_m = [0.7, 0.75, 0.05]
[compare]
models = []
measures = ["volume_change", "reaction", "probe"]
[reference]
elements = ["p2"]
edge_m = 0.25
TOML
# The solver on \$PROCESSES processes, its tolerance set to 1e-12.
cat >"$work/fem" <<SH
#!/usr/bin/env bash
[ "\$1" != --request ] || python3 -c '
import struct, sys
request = bytearray(open(sys.argv[1], "rb").read())
at = request.index(b"tolerance\xfb") + 10
request[at : at + 8] = struct.pack(">d", 1e-12)
open(sys.argv[1], "wb").write(request)' "\$2"
[ \$PROCESSES -gt 1 ] && exec mpirun -q -np \$PROCESSES "$program" "\$@"
exec "$program" "\$@"
SH
chmod +x "$work/fem"
for processes in 1 2; do
  PROCESSES=$processes SPRINGPROOF_FEM_PROGRAM=$work/fem "$springproof" compare "$work/ball.toml" --jobs 1 --out "$work/ball$processes" >"$work/out" 2>&1 ||
    grep -q "No expectations" "$work/out" || fail "ball, $processes processes" "$work/out"
  # The components of one measure on all meshes in one line.
  awk -F, 'NR > 1 { name = $6; sub(/[.](x|y|z|magnitude)$/, "", name); name = $3 " nu=" $4 " " name; at[name] = at[name] " " $7 }
           END { for (name in at) print name at[name] }' "$work/ball$processes/results.csv" | sort >"$work/numbers$processes"
done
same_numbers "$work/numbers1" "$work/numbers2" . 1e-9 12 && echo "same: 2 processes, ball" || fail "ball"

# gmsh runs as often as for one process.
cat >"$work/mesh" <<SH
#!/usr/bin/env bash
echo >>"$work/meshed"
exec "$(dirname "$program")/springproof-mesh" "\$@"
SH
chmod +x "$work/mesh"
for case in block cylinder; do
  for processes in 1 3; do
    : >"$work/meshed"
    SPRINGPROOF_MESH_CACHE= SPRINGPROOF_MESH_PROGRAM=$work/mesh mpirun -q -np $processes "$program" "$work/$case.toml" --element q1 >"$work/out" 2>&1 || cat "$work/out"
    mv "$work/meshed" "$work/meshed$processes"
  done
  [ -s "$work/meshed1" ] && cmp -s "$work/meshed1" "$work/meshed3" || fail "$case is meshed by more than one process"
done

# What one process alone can see is told to all: one message, exit status 2.   refuse CASE MESSAGE ARGUMENTS
refuse() {
  mpirun -q -np 2 "$program" "$work/$1.toml" "${@:3}" >"$work/out" 2>"$work/err"
  local status=$?
  [ $status -eq 2 ] && [ "$(grep -c "$2" "$work/err")" -eq 1 ] && { echo "refused: $1"; return; }
  fail "$1 ended with $status" "$work/err"
}
make_case outside linear
sed -i 's/at_m = \[0.31, .*/at_m = [0.31, 0.77, 3]/' "$work/outside.toml"
refuse outside "is outside the body"
make_case conflict linear
printf '[[load]]\non = "x_min"\ndisplacement_m = ["free", "free", 0]\n' >>"$work/conflict.toml"
refuse conflict "prescribe different"
make_case loose linear
sed -i -e 's/displacement_m = \[0, 0, 0\]/displacement_m = ["free", "free", 0]/' -e 's/displacement_m = \[0.05, 0.02, -0.2\]/displacement_m = ["free", "free", -0.2]/' "$work/loose.toml"
refuse loose "is not held"
refuse cylinder "2 processes for a mesh of 1 cells" --cells 1 1 1
sed 's/geo = .*/geo = "broken.geo"/' "$work/cylinder.toml" >"$work/broken.toml"
echo "Point(1) = {0, 0, 0};" >"$work/broken.geo"
refuse broken "broken.geo"
exit $((failures > 0))
