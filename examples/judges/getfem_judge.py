#!/usr/bin/python3
"""A case of a block by GetFEM, a finite element program of others, beside our reference.

    getfem_judge.py CASE.toml OUT.csv CELLS CELLS CELLS

Needs Debian's python3-getfem and Python's tomllib (3.11).  The case: a block.geo or beam.geo in boxes, one material, faces held or
moved by `displacement_m` in all three directions, weight.  Laws: neo_hooke, hencky (elements Q2), linear (Q2-P1 displacement and
pressure, Taylor and Hood's).  Three grids, of CELLS along x, y and z and twice half more, graded to the faces held.  OUT.csv gets the displacements of the finest at the nodes of the case's cells, for an [[external]] table, which is printed with the
forces of the supports and an estimate of their error: the last step over r^p - 1, with the observed order p, 2 at most.
"""
import itertools
import sys
import tomllib

import getfem as gf
import numpy as np

RATIO = 1.5
STRESS = {  # first Piola-Kirchhoff
    "neo_hooke": "G*(F - Inv(F)') + lam*log(Det(F))*Inv(F)'",
    "hencky": "Inv(F)'*(G*Logm(F'*F) + lam*log(Det(F))*Id(3))",
}


def graded(length, cells, ends):
    """Nodes along an axis, closer near the ends [low, high] that are held."""
    t = np.linspace(0, 1, cells + 1)
    if all(ends):
        t = (1 - np.cos(np.pi * t)) / 2
    elif ends[0]:
        t = 1 - np.sin(np.pi / 2 * (1 - t))
    elif ends[1]:
        t = np.sin(np.pi / 2 * t)
    return length * t


def faces_of(mesh):
    """Region numbers 1 ... 6: x_min, x_max, y_min, ..."""
    for axis, high in itertools.product(range(3), range(2)):
        normal = np.zeros(3)
        normal[axis] = 2 * high - 1
        mesh.set_region(2 * axis + high + 1, mesh.outer_faces_with_direction(normal, 0.01))


def solve(case, cells):
    """Displacement at the nodes of the case's cells, forces of the supports, number of unknowns."""
    size, law = case["body"]["size_m"], case.get("kinematics", "linear")
    nu, E = case["material"]["poisson_ratio"], case["material"]["youngs_modulus_Pa"]
    moved = {l["on"]: np.array(l["displacement_m"], float) for l in case["load"] if "displacement_m" in l}
    weight = sum((np.array(l["gravity_m_s2"], float) for l in case["load"] if "gravity_m_s2" in l), np.zeros(3))
    weight = weight * case["material"].get("density_kg_m3", 0)
    names = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
    ends = [[names[2 * a] in moved, names[2 * a + 1] in moved] for a in range(3)]
    free = [ends[a] if any(ends[a]) else [True, True] for a in range(3)]  # edges of a held face lie at the sides
    mesh = gf.Mesh("cartesian Q1", *(graded(size[a], cells[a], free[a]) for a in range(3)))
    faces_of(mesh)
    mfu, mfp = gf.MeshFem(mesh, 3), gf.MeshFem(mesh, 1)
    mfu.set_fem(gf.Fem("FEM_QK(3,2)"))
    mfp.set_fem(gf.Fem("FEM_QK(3,1)"))
    mim = gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,6)"))
    md = gf.Model("real")
    md.add_fem_variable("u", mfu)
    md.add_initialized_data("G", E / 2 / (1 + nu))
    md.add_initialized_data("lam", E * nu / (1 + nu) / (1 - 2 * nu))
    md.add_initialized_data("f", weight)
    if law == "linear":
        md.add_fem_variable("p", mfp)
        internal = "(G*(Grad_u + Grad_u') + p*Id(3)):Grad_Test_u"
        md.add_linear_term(mim, internal + " + (Trace(Grad_u) - p/lam)*Test_p")
    else:
        md.add_macro("F", "(Id(3) + Grad_u)")
        internal = f"({STRESS[law]}):Grad_Test_u"
        md.add_nonlinear_term(mim, internal)
    md.add_source_term(mim, "f.Test_u")
    for face, at in moved.items():
        md.add_initialized_data(face, 0 * at)
        md.add_Dirichlet_condition_with_simplification("u", names.index(face) + 1, face)
    steps = 1 if law == "linear" else 4
    for k in range(1, steps + 1):
        for face, at in moved.items():
            md.set_variable(face, at * k / steps)
        md.set_variable("f", weight * k / steps)
        md.solve("lsolver", "mumps", "max_res", 1e-9 * E * min(size) ** 2, "max_iter", 40)
    first, count = md.interval_of_variable("u")
    residual = gf.asm("generic", mim, 1, internal + " - f.Test_u", -1, md)[first : first + count]
    forces = {}
    for face in moved:
        dofs = mfu.basic_dof_on_region(names.index(face) + 1)
        force = np.array([residual[dofs[dofs % 3 == c]].sum() for c in range(3)])
        forces[face] = np.where(np.abs(force) > 1e-9 * np.linalg.norm(force), force, 0)
    nodes = [np.linspace(0, size[a], n + 1) for a, n in enumerate(case["body"]["cells"])]
    return (np.array(list(itertools.product(*nodes))), quadratic(mfu.basic_dof_nodes()[:, ::3].T, md.variable("u").reshape(-1, 3), nodes),
            forces, md.nbdof())


def quadratic(X, u, at):
    """Values u at the nodes X of a grid of boxes Q2, interpolated to a grid `at`."""
    axes = [np.unique(np.round(X[:, a], 9)) for a in range(3)]
    grid = np.zeros([len(axis) for axis in axes] + [3])
    grid[tuple(np.abs(axis[:, None] - X[:, a]).argmin(0) for a, axis in enumerate(axes))] = u
    for a, axis in enumerate(axes):
        weights = np.zeros((len(at[a]), len(axis)))
        for i, x in enumerate(at[a]):
            first = min(2 * (np.searchsorted(axis[::2], x, side="right") - 1), len(axis) - 3)
            three = axis[first : first + 3]
            for k in range(3):
                others = np.delete(three, k)
                weights[i, first + k] = np.prod(x - others) / np.prod(three[k] - others)
        grid = np.moveaxis(np.tensordot(weights, grid, (1, a)), 0, a)
    return grid.reshape(-1, 3)


def limit(values):
    """Estimated error of the last of three values by their observed order, 2 at most."""
    a, b, c = values
    first, last = np.linalg.norm(b - a), np.linalg.norm(c - b)
    order = np.clip(np.log(first / last) / np.log(RATIO), 0.5, 2)
    return last / (RATIO**order - 1), order


def main():
    gf.util_trace_level(0)
    gf.util_warning_level(0)
    with open(sys.argv[1], "rb") as file:
        case = tomllib.load(file)
    coarse = [int(n) for n in sys.argv[3:6]]
    runs = []
    for k in range(3):
        runs.append(solve(case, [int(round(n * RATIO**k)) for n in coarse]))
        print(f"# {runs[-1][3]} unknowns: " + ", ".join(f"{face} {force}" for face, force in runs[-1][2].items()), flush=True)
    nodes, u, forces, _ = runs[-1]
    error, order = limit([r[1] for r in runs])
    print(f"# displacement: uncertain by {100 * error / np.linalg.norm(u):.3f} %, order {order:.1f}")
    for face in forces:
        error, order = limit([r[2][face] for r in runs])
        print(f"# force of {face}: uncertain by {error:.3g} N ({100 * error / np.linalg.norm(forces[face]):.3f} %), order {order:.1f}")
    reactions = ", ".join(f"{face} = [{f[0]:.6g}, {f[1]:.6g}, {f[2]:.6g}]" for face, f in forces.items())
    print(f"reaction_N = {{ {reactions} }}")
    with open(sys.argv[2], "w", encoding="ascii") as out:
        out.write("x,y,z,ux,uy,uz\n")
        for row in np.hstack([nodes, u]):
            out.write(",".join(f"{v:.7g}" for v in row) + "\n")


if __name__ == "__main__":
    main()
