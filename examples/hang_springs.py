"""Where a body of springs comes to rest: any springs file, cut cells included, with NumPy, SciPy and springs.py beside this file.

    springproof export body.stl --scale 0.001 -E 5e3 --nu 0.45 --hold bottom --load top --to springs --out body.npz
    python3 hang_springs.py body.npz bottom                     # held at its bottom, under its own weight
    python3 hang_springs.py body.npz bottom top 0 0 -0.02       # or, without weight, 20 mN downwards on its top

Newton's method on the forces of the file, which hold at large strain (but for hourglass_correction); body-hung.obj is the deformed surface.
"""
import sys
from pathlib import Path
try:
    import numpy as np, scipy.sparse as sp
    from scipy.sparse.linalg import splu
except ImportError as missing: sys.exit(f"{missing}: needs NumPy and SciPy (Debian: apt-get install python3-numpy python3-scipy)")
from springs import load, forces, carry, embed, matrices  # or, with the package: from springproof.springs import ...

def colours_of(s, n):
    """Nodes of one colour move no force in common: the tangent takes six evaluations of the forces per colour."""
    cells, ends = s.get("cells", {"nodes": np.empty((0, 8), int)})["nodes"], s["springs"]["nodes"].astype(int).reshape(-1, 2)
    reach = sp.identity(n, format="csr")
    for nodes in (cells, ends, s.get("triangles", np.empty((0, 3), int)), s.get("bonds", {"nodes": np.empty((0, 16), int)})["nodes"]):
        at = sp.csr_matrix((np.ones(nodes.size), (nodes.ravel().astype(int), np.arange(nodes.size) // nodes.shape[1])), (n, len(nodes)))
        reach = reach + at @ at.T
    if "momentum_dispersion" in s["laws"]: reach = reach @ reach  # neighbours of neighbours
    follow = sp.identity(n, format="lil")
    for node, by in zip(s["carried"]["nodes"], s["carried"]["by"]) if "carried" in s else ():
        follow[node] = sum(follow[b] for b in by)
    reach = follow.T.tocsr() @ reach @ follow.tocsr()
    together, colour = (reach.T @ reach).tocsr(), np.full(n, -1)
    for node in range(n):
        taken = colour[together.indices[together.indptr[node]:together.indptr[node + 1]]]
        colour[node] = np.setdiff1d(np.arange(len(taken) + 1), taken)[0]
    return colour, reach.tocoo()

def tangent(s, x, colour, reach, h):
    """-d(forces)/dx by central differences, 3n x 3n."""
    K = sp.csr_matrix((x.size, x.size))
    for axis in range(3):
        moves = [h * ((colour == c)[:, None] & (np.arange(3) == axis)) for c in range(colour.max() + 1)]
        change = np.array([forces(s, x - d) - forces(s, x + d) for d in moves]) / (2 * h)
        for i in range(3):
            K = K + sp.csr_matrix((change[colour[reach.col], reach.row, i], (3 * reach.row + i, 3 * reach.col + axis)), K.shape)
    return K

def rest(s, held, external, say=print):
    """Positions at which the forces are in equilibrium with the external ones [N], n x 3."""
    X, n = s["nodes"]["position_m"], len(s["nodes"]["position_m"])
    free, support = s["nodes"]["mass_kg"] > 0, sp.csr_matrix((3 * n, 3 * n))
    if held in s.get("anchors", {}):  # springs between means of corners and points that stay
        a = s["anchors"][held]
        w = sp.csr_matrix((a["weights"].ravel(), (np.arange(a["nodes"].size) // 8, a["nodes"].ravel())), (len(a["nodes"]), n))
        if "carried" in s: w = w @ sp.csr_matrix(carry(s, np.eye(n)))
        w = sp.kron(w, sp.identity(3), format="csr")
        support = w.T @ sp.block_diag(matrices(a), format="csr") @ w
    else:
        free = free & ~np.isin(np.arange(n), s["patches"][held])
    (colour, reach), dofs, x, largest = colours_of(s, n), np.flatnonzero(np.repeat(free, 3)), X.copy(), abs(external).max()
    K = tangent(s, X, colour, reach, 1e-6 * np.ptp(X))
    small = max(1e-9 * largest, 1e-14 * abs(K).max() * np.ptp(X))  # a light load on a stiff body: round-off of the forces
    def newton(x, share):  # None: no equilibrium found from here
        for _ in range(12):
            r = ((forces(s, x) + share * external).ravel() - support @ (x - X).ravel())[dofs]
            say(f"  {share:.3f} of the load: residual {abs(r).max() / largest:.1e}")
            if not small < abs(r).max() < 1e3 * largest: return x if abs(r).max() <= small else None
            K = (tangent(s, x, colour, reach, 1e-6 * np.ptp(X)) + support).tocsc()
            x = x.copy()
            x.ravel()[dofs] += splu(K[dofs][:, dofs]).solve(r)
            carry(s, x)
    share, step = 0.0, 1.0
    while share < 1:  # the steps of the load are as large as they converge
        found = newton(x, min(1, share + step))
        x, share, step = (x, share, step / 4) if found is None else (found, min(1, share + step), 2 * step)
        if step < 1e-3: sys.exit(f"no equilibrium beyond {share:.3f} of the load")
    return x

if __name__ == "__main__":
    np.seterr(all="ignore")  # where Newton's method fails the load step is cut
    s, held, on, force = load(sys.argv[1]), sys.argv[2], sys.argv[3:4], np.array(sys.argv[4:7], float)
    nodes, surface, share = s["nodes"], s["surface"], np.zeros(len(s["nodes"]["mass_kg"]))
    if not on: share, force = nodes.get("weight_kg", nodes["mass_kg"]), np.array([0, 0, -9.81])
    elif on[0] in s.get("loads", {}): share[s["loads"][on[0]]["nodes"]] = s["loads"][on[0]]["area_m2"] / s["loads"][on[0]]["area_m2"].sum()
    else: share[s["patches"][on[0]]] = 1 / len(s["patches"][on[0]])
    u = rest(s, held, np.outer(share, force)) - nodes["position_m"]
    far = np.linalg.norm(u, axis=1).argmax()
    print(f"moves by up to {np.linalg.norm(u[far]):.4e} m, where it is loaded by {(share @ u / share.sum()).tolist()} m on average")
    moved = surface["position_m"].copy()
    np.add.at(moved, np.repeat(np.arange(len(moved)), np.diff(surface["first"])), surface["weights"][:, None] * u[surface["nodes"]])
    with open(Path(sys.argv[1]).stem + "-hung.obj", "w") as out:
        out.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in moved)
        out.writelines("f %d %d %d\n" % tuple(f) for f in surface["facets"] + 1)
