# The forces of every law of a springs file, and explicit steps, with NumPy alone: docs/springs_file.md says what the fields are.
#   python3 springs.py FILE     prints how far these forces are from those that the file gives
# As a module: s = load("body.json"); f = forces(s, x) [N]; step(...) moves the body by one step; a point follows the nodes and
# weights that embed(s, points) gives it: np.einsum("pn,pni->pi", weights, x[nodes]).
import json, sys
import numpy as np

def load(name):
    """The tree of the file, its lists as arrays."""
    z = np.load(name) if name.endswith(".npz") else None
    def arrays(v):
        if isinstance(v, dict): return {key: arrays(w) for key, w in v.items()}
        if isinstance(v, str) and v.startswith("npy:"): return z[v[4:]]
        return np.array(v) if isinstance(v, list) else v
    return arrays(json.loads(z["springs.json"]) if z else json.load(open(name)))

SIGN = 2 * np.array([[0,0,0], [1,0,0], [1,1,0], [0,1,0], [0,0,1], [1,0,1], [1,1,1], [0,1,1]]) - 1  # xi of the corners

def dispersion(law, ends, k, L, stretch, n):  # tensions that momentum dispersion adds
    sink = law.get("group", np.arange(n))[ends]  # s x 2: the node whose J an end adds to
    q, kL, L2, one = law["q"], np.outer(k * L, [1, 1]), np.outer(L, [1, 1]), np.ones((len(k), 2))
    if law["form"] in ("symmetric", "finite_strain"):
        w = law.get("weight", kL)
        a, c, norm = w, q * w, w * L2
    elif law["form"] == "share_weighted":
        share = one * law["weight"][:, None] if "weight" in law else one
        a, c, norm = q * kL, share / L2, share
    elif law["form"] == "published": a, c, norm = q * kL, 1 / L2, one
    else: a, c, norm = q * kL / L2**2, L2, one  # published_transposed
    total, J = np.zeros(n), np.zeros(n)
    np.add.at(total, sink, norm)
    np.add.at(J, sink, a * stretch[:, None])
    return (c / total[sink] * J[sink]).sum(axis=1)

def volume(law, cells, V, x, f):
    a, b, c = np.einsum("nd,cne->dce", SIGN, x[cells]) / 4  # mean edge vectors
    bc, ca, ab = np.cross(b, c), np.cross(c, a), np.cross(a, b)
    J = (a * bc).sum(axis=1) / V
    slope = J - 1 if law["form"] == "paper" else 3 * (np.cbrt(J) - 1) / np.cbrt(J)**2
    gradient = np.einsum("nd,dce->cne", SIGN, np.array([bc, ca, ab])) / 4
    np.add.at(f, cells, -(law["kappa_Pa"] * slope)[:, None, None] * gradient)

def hourglass(law, k, cells, u, f):  # u: displacements from rest
    force, u = np.zeros((len(cells), 8, 3)), u[cells]
    mode = lambda p, q: SIGN[:, p] * SIGN[:, q] / np.sqrt(8)
    for y in range(3):
        p, q = (y + 1) % 3, (y + 2) % 3
        up, uq = u[:, :, p] @ mode(p, y), u[:, :, q] @ mode(q, y)
        force[:, :, p] += np.outer(k["hourglass_bending_N_m"] * up + k["hourglass_coupling_N_m"] * uq, mode(p, y))
        force[:, :, q] += np.outer(k["hourglass_bending_N_m"] * uq + k["hourglass_coupling_N_m"] * up, mode(q, y))
    twist = np.array([u[:, :, m] @ mode((m + 1) % 3, (m + 2) % 3) for m in range(3)])
    for m in range(3):
        t = k["hourglass_torsion_N_m"] * twist[m] + k["hourglass_torsion_coupling_N_m"] * twist.sum(axis=0)
        force[:, :, m] += np.outer(t, mode((m + 1) % 3, (m + 2) % 3))
    np.add.at(f, cells, -force)

def angles(law, triangles, x, X, f):
    def at_corner(x, a, b, c):
        d1, d2 = x[b] - x[a], x[c] - x[a]
        n = np.cross(d1, d2)
        return np.arctan2(np.linalg.norm(n, axis=1), (d1 * d2).sum(axis=1)), d1, d2, n / np.linalg.norm(n, axis=1)[:, None]
    for corner in range(3):
        a, b, c = (triangles[:, (corner + m) % 3] for m in range(3))
        phi, d1, d2, n = at_corner(x, a, b, c)
        moment = (law["beta_Nm"] * (phi - at_corner(X, a, b, c)[0]))[:, None]
        on_b = moment * np.cross(n, d1) / (d1**2).sum(axis=1)[:, None]
        on_c = moment * np.cross(d2, n) / (d2**2).sum(axis=1)[:, None]
        for node, force in ((a, -on_b - on_c), (b, on_b), (c, on_c)): np.add.at(f, node, force)

def moments(cells):  # of the parts of the cells that the body fills; of whole cells where the file has none
    full = {"fraction": 1, "mean": np.zeros(3), "mixed": np.zeros(3), "variance": np.full(3, 1 / 12)}
    ones = np.ones(len(cells["nodes"]))
    return [cells.get(key, np.multiply.outer(ones, value)) for key, value in full.items()]

def stress(law, F):  # P = dW/dF of a cell
    G, K, J, H = law["shear_modulus_Pa"], law["lame_lambda_Pa"] + 2 / 3 * law["shear_modulus_Pa"], np.linalg.det(F), np.linalg.inv(F).transpose(0, 2, 1)
    C = np.einsum("cki,ckj->cij", F, F)
    I1, J, curve, column = np.trace(C, axis1=1, axis2=2)[:, None, None], J[:, None, None], law["curve"], lambda v: v[:, None, None]
    volume = K * (J - 1) * J * H if curve in ("neo_hooke_isochoric", "springs_neo_hooke") else K * np.log(J) * H
    if curve == "neo_hooke": return G * (F - H) + law["lame_lambda_Pa"] * np.log(J) * H
    if curve == "neo_hooke_isochoric": return G * J**(-2 / 3) * (F - I1 / 3 * H) + volume
    if curve == "hencky":
        I2, m, n = (I1**2 - column((C**2).sum(axis=(1, 2)))) / 2, J**(-2 / 3), J**(-4 / 3)
        y = (m * I1 + n * I2 - 6) / 4
        return G / 2 * (1 - y / 3 + 2 / 15 * y**2) * (m * (F - I1 / 3 * H) + n * (I1 * F - F @ C - 2 / 3 * I2 * H)) + volume
    p, r = (-4.17, -2.91) if curve == "springs_hencky" else (-0.83, -5.38)
    for at in np.ndindex(3, 3, 3):  # thirteen springs
        e = np.array(at) - 1
        if e @ (9, 3, 1) <= 0: continue
        N = e / np.linalg.norm(e)
        d, k = F @ N, 15 * G * {1: 2 / 21, 2: 8 / 105, 3: 9 / 140}[int(e @ e)]
        q = column((d**2).sum(axis=1))
        t = np.log(q) / 2 - np.log(J) / 3
        volume = volume + k * t * (1 + t * (p / 2 + t * r / 6)) * (np.einsum("ci,j->cij", d, N) / q - H / 3)
    return volume

PATTERN = np.column_stack([SIGN[:, 1] * SIGN[:, 2] / 2, SIGN[:, 2] * SIGN[:, 0] / 2, SIGN[:, 0] * SIGN[:, 1] / 2, SIGN.prod(axis=1)])

def deformation(cells, x):  # mean gradients g of the corners' weights; of their positions F, and the patterns q that it does not see
    (_, c, p, _), l, at = moments(cells), cells["edge_m"], x[cells["nodes"]]
    box, g = np.array(cells.get("proportions", [1, 1, 1])), np.empty(at.shape)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        sj, sk = SIGN[:, j], SIGN[:, k]
        g[:, :, i] = SIGN[:, i] / (box[i] * np.reshape(l, (-1, 1))) * (1 / 4 + (np.outer(c[:, j], sj) + np.outer(c[:, k], sk)) / 2 + np.outer(p[:, i], sj * sk))
    return g, np.einsum("cai,caj->cij", at, g), np.einsum("cai,am->cmi", at, PATTERN)

def add_cells(cells, g, F, q, w, stress, f):  # w: dE/dv, v = F^T q; stress: dE/dF beside it
    total = stress + np.einsum("cmi,cmj->cij", q, w)
    np.add.at(f, cells["nodes"], -np.einsum("cij,caj->cai", total, g) - np.einsum("cij,cmj,am->cai", F, w, PATTERN))

def stretched(cells, x):  # of measured cells: y = (l log U, v), and dE/dx of s = dE/dy
    g, F, q = deformation(cells, x)
    v, l = np.einsum("cij,cmi->cmj", F, q), cells["edge_m"]
    C, V = np.linalg.eigh(np.einsum("cki,ckj->cij", F, F))
    e = np.einsum("cik,ck,cjk->cij", V, np.log(C) / 2, V)  # log U
    strain = l * np.stack([e[:, 0, 0], e[:, 1, 1], e[:, 2, 2], 2 * e[:, 1, 2], 2 * e[:, 2, 0], 2 * e[:, 0, 1]], axis=1)
    t = C[:, :, None] / C[:, None, :] - 1
    slope = np.where(t == 0, 1, np.log1p(t) / np.where(t == 0, 1, t)) / (2 * C[:, None, :])  # divided differences of log(C) / 2
    def pull(s, f):
        S = np.einsum("cki,ckl,clj->cij", V, l * s[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]], V) * slope
        P = 2 * np.einsum("cik,ckl,clm,cjm->cij", F, V, S, V)
        P[np.linalg.det(F) <= 0] = np.nan  # inside out
        add_cells(cells, g, F, q, s[:, 6:].reshape(-1, 4, 3), P, f)
    return np.concatenate([strain, v.reshape(-1, 12)], axis=1), pull

def times_form(law, y):  # M y, M by its lower triangle
    form, (i, j) = np.zeros((len(y), 18, 18)), np.tril_indices(18)
    form[:, i, j] = form[:, j, i] = law["form_N_m"].reshape(len(y), -1)
    return np.einsum("cij,cj->ci", form, y)

def without_volume(y):  # the mean of its first three
    return y - np.where(np.arange(18) < 3, y[..., :3].mean(axis=-1, keepdims=True), 0)

def measured(law, cells, x, f):
    y, pull = stretched(cells, x)
    pull(times_form(law, y), f)

def materials(law, cells):  # the constants and the cells of each material
    if "material" not in cells: return [(law, cells)]
    of = [cells["material"] == m for m in range(1 + len(law["regions"]))]
    return [(one, {key: v[here] if np.shape(v)[:1] == here.shape else v for key, v in cells.items()}) for one, here in zip([law, *law["regions"]], of) if here.any()]

def bonds(s, x, f):  # between the means of cells of two materials; K v, v = F^T gap, F of both cells where K is no multiple of 1
    b, frame = s["bonds"], np.concatenate([SIGN, SIGN]) / (8 * s["cells"]["edge_m"])
    w, K, at = b["weights"] * np.repeat([1, -1], 8), b["stiffness_N_m"].reshape(-1, 3, 3), x[b["nodes"]]
    turns = (K != K[:, :1, :1] * np.eye(3)).any(axis=(1, 2))[:, None, None]
    gap, F = np.einsum("bn,bni->bi", w, at), np.where(turns, np.einsum("bni,nj->bij", at, frame), np.eye(3))
    force = np.einsum("bij,bkj,bk->bi", K, F.transpose(0, 2, 1), gap)
    np.add.at(f, b["nodes"], -w[:, :, None] * np.einsum("bij,bj->bi", F, force)[:, None, :] - turns * np.einsum("nj,bj,bi->bni", frame, force, gap))

def hourglass_springs(law, cells, v):  # dE/dv of the patterns, E = v . w / 2
    (alpha, c, p, S), l, box = moments(cells), cells["edge_m"], np.array(cells.get("proportions", [1, 1, 1]))
    rho, V, w = np.maximum(12 * S, 0.1) * box**2, box[:, None] * (v[:, :3] + c[:, :, None] * v[:, 3:]), np.empty(v.shape)
    for j in range(3):
        k, m = (j + 1) % 3, (j + 2) % 3
        for a, b in ((k, m), (m, k)): w[:, a, b] = rho[:, j] * (law["bending"] * V[:, a, b] + law["coupling"] * V[:, b, a])
        w[:, j, j] = law["torsion"] * (rho[:, k] * (V[:, j, j] + V[:, m, m]) + rho[:, m] * (V[:, j, j] + V[:, k, k]))
        w[:, j, j] += law["twist"] * (rho[:, k] + rho[:, m]) / 2 * V[:, j, j]
        w[:, 3, j] = law["warping"] / 4 * (0.3 * rho[:, k] * rho[:, m] + rho[:, j] * (rho[:, k] + rho[:, m])) / 2.3 * v[:, 3, j]
    w[:, :3] *= box[:, None]
    w[:, 3] += np.einsum("cm,cmj->cj", c, w[:, :3])
    return (alpha * law["shear_modulus_Pa"] * l / 2)[:, None, None] * w

def averaged(law, cells, x, f):
    if law["shift"]: sys.exit("averaged springs with a shift are linear: not here")
    g, F, q = deformation(cells, x)
    w = hourglass_springs(law, cells, np.einsum("cij,cmi->cmj", F, q))
    add_cells(cells, g, F, q, w, (moments(cells)[0] * cells["edge_m"]**3)[:, None, None] * stress(law, F), f)

def relax(s, dt, x):
    """Advances the branches by a step of dt [s] that ends at x, exactly for strains that change evenly; dt = np.inf: relaxed at x."""
    r, E = s["relaxation"], strains(s, x)
    if "Q" not in r: r["E"], r["Q"] = np.zeros(E.shape), np.zeros(r["share"].shape + E.shape)  # relaxed at rest
    ratio = (dt / r["time_s"]).reshape(-1, *[1] * E.ndim)
    r["Q"] = np.exp(-ratio) * r["Q"] - (np.expm1(-ratio) / ratio if dt > 0 else -1) * (E - r["E"])
    r["E"] = E

def strains(s, x):  # that branches follow
    if "measured_cells" in s["laws"]: return without_volume(stretched(s["cells"], carry(s, x.copy()))[0])
    _, F, q = deformation(s["cells"], carry(s, x.copy()))
    E = (np.einsum("cki,ckj->cij", F, F) - np.eye(3)) / 2
    return np.concatenate([E - np.trace(E, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3), np.einsum("cij,cmi->cmj", F, q)], axis=1)

def branch_forces(s, x):
    """The forces of the branches at x, to which they were advanced last [N], n x 3."""
    r, cells, f, at = s["relaxation"], s["cells"], np.zeros(x.shape), carry(s, x.copy())
    Q = np.tensordot(r["share"], r["Q"], 1)
    if law := s["laws"].get("measured_cells"):
        stretched(cells, at)[1](without_volume(times_form(law, Q)), f)
    else:
        g, F, q = deformation(cells, at)
        stress = (2 * r["shear_modulus_Pa"] * moments(cells)[0] * cells["edge_m"]**3)[:, None, None] * np.einsum("cij,cjk->cik", F, Q[:, :3])
        add_cells(cells, g, F, q, hourglass_springs(r, cells, Q[:, 3:]), stress, f)
    return hand_back(s, f)

def directions(s, N, share):  # of the springs of a lattice of cells; of other networks all alike
    if "cells" in s:
        e, of = np.unique(np.round(N, 6), axis=0, return_inverse=True)
        return e / np.linalg.norm(e, axis=1)[:, None], np.bincount(of.ravel(), share) / share.sum()
    e = np.array([np.array(at) - 1 for at in np.ndindex(3, 3, 3) if (np.array(at) - 1) @ (9, 3, 1) > 0])
    squared = (e**2).sum(axis=1)
    return e / np.sqrt(squared)[:, None], np.choose(squared - 1, [2 / 21, 8 / 105, 9 / 140])

def at_nodes(law, s, ends, k, L, x, X, f):  # momentum dispersion of finite strain
    D, d = X[ends[:, 1]] - X[ends[:, 0]], x[ends[:, 1]] - x[ends[:, 0]]
    N, w = D / np.linalg.norm(D, axis=1)[:, None], law.get("weight", np.outer(k * L, [1, 1]))
    sink, B, F = law.get("group", np.arange(len(x)))[ends], np.zeros((len(x), 3, 3)), np.zeros((len(x), 3, 3))
    np.add.at(B, sink, w[:, :, None, None] * np.einsum("si,sj->sij", D, N)[:, None])
    GV = np.trace(B, axis1=1, axis2=2) / 30
    B[GV == 0] = F[GV == 0] = np.eye(3)  # nodes that receive nothing
    g = w[:, :, None] * np.einsum("seij,sj->sei", np.linalg.inv(B)[sink], N)
    np.add.at(F, sink, np.einsum("si,sej->seij", d, g))
    ratio = 10 / 3 * law["q"]  # (lambda - G) / G
    P = stress({"shear_modulus_Pa": 1, "lame_lambda_Pa": 1 + ratio, "curve": law["curve"]}, F)
    e, share = directions(s, N, k * L**2)
    Fe = np.einsum("nij,dj->ndi", F, e)
    l = np.linalg.norm(Fe, axis=2)
    tension = 15 * (l - 1) + (0 if "weight" in law else 9 * ratio) * ((l - 1) @ share)[:, None]  # the springs' own
    P -= np.einsum("d,nd,ndi,dj->nij", share, tension / l, Fe, e)
    force = np.einsum("s,seij,sej->si", np.ones(len(k)), (GV[:, None, None] * P)[sink], g)
    np.add.at(f, ends[:, 0], force)
    np.add.at(f, ends[:, 1], -force)

def anchor(s, name, x, displacement=0):
    """Forces by which a support holds the patch of a body of cut cells [N], n x 3."""
    a, f = s["anchors"][name], np.zeros(x.shape)
    d = np.einsum("ca,cai->ci", a["weights"], carry(s, x.copy())[a["nodes"]]) - a["position_m"] - displacement
    np.add.at(f, a["nodes"], -np.einsum("ca,cij,cj->cai", a["weights"], matrices(a), d))
    return hand_back(s, f)

def matrices(a):  # of anchors or bonds; of anchors in files before version 7 a number each
    K = a["stiffness_N_m"]
    return K.reshape(-1, 3, 3) if K.ndim > 1 else K[:, None, None] * np.eye(3)

def time_step(s): return 0.95 * s["derived"]["safe_time_step_s"]

def support_mass(s, name):
    """By what explicit steps divide the forces on the nodes at a support beside their mass [kg], n: it has no weight and
    no damping.  Of a support that moves, its acceleration times this is one more force."""
    a, mu = s["anchors"][name], np.zeros(len(s["nodes"]["mass_kg"]))
    w = abs(a["weights"])
    np.add.at(mu, a["nodes"], time_step(s)**2 / 4 * abs(matrices(a)).sum(axis=2).max(axis=1)[:, None] * w * w.sum(axis=1, keepdims=True))
    return hand_back(s, mu)

def carry(s, x):  # carried nodes into their places
    if "carried" in s:
        for node, by in zip(s["carried"]["nodes"], s["carried"]["by"]): x[node] = x[by].mean(axis=0)
    return x

def hand_back(s, f):  # the forces on them, to those that carry them
    if "carried" in s:
        for node, by in zip(s["carried"]["nodes"][::-1], s["carried"]["by"][::-1]):
            np.add.at(f, by, f[node] / 4)
            f[node] = 0
    return f

def embed(s, points):
    """The nodes and weights of the cell that carries each point [m], p x 3: both p x 8; points outside by the nearest cell."""
    corners = s["nodes"]["position_m"][s["cells"]["nodes"]]
    low, size = corners[:, 0], corners[:, 6] - corners[:, 0]
    cell = np.concatenate([abs((p[:, None] - low) / size - 0.5).max(axis=2).argmin(axis=1) for p in np.array_split(points, len(points) // 500 + 1)])
    xi = ((points - low[cell]) / size[cell])[:, None, :]
    return s["cells"]["nodes"][cell], np.where(SIGN > 0, xi, 1 - xi).prod(axis=2)

def forces(s, x):
    """Internal forces at positions x, without those of branches [N], n x 3."""
    x = carry(s, x.copy())
    laws, X, ends = s["laws"], s["nodes"]["position_m"], s["springs"]["nodes"].astype(int).reshape(-1, 2)
    k, L, f = s["springs"]["stiffness_N_m"], s["springs"]["rest_length_m"], np.zeros(x.shape)
    d = x[ends[:, 1]] - x[ends[:, 0]]
    length = np.linalg.norm(d, axis=1)
    tension = k * (length - L) if "springs" in laws else 0 * k
    if law := laws.get("momentum_dispersion"):
        finite = law["form"] == "finite_strain"
        if finite: at_nodes(law, s, ends, k, L, x, X, f)
        if not (finite and "weight" in law): tension = tension + dispersion(law, ends, k, L, length - L, len(x))
    pull = (tension / length)[:, None] * d
    np.add.at(f, ends[:, 0], pull)
    np.add.at(f, ends[:, 1], -pull)
    if law := laws.get("volume_correction"): volume(law, s["cells"]["nodes"], s["cells"]["edge_m"]**3, x, f)
    if law := laws.get("hourglass_correction"): hourglass(law, s["derived"], s["cells"]["nodes"], x - X, f)
    if law := laws.get("averaged_springs"):
        for of in materials(law, s["cells"]): averaged(*of, x, f)
    if "bonds" in s: bonds(s, x, f)
    if law := laws.get("measured_cells"): measured(law, s["cells"], x, f)
    if law := laws.get("angular_springs"): angles(law, s["triangles"], x, X, f)
    return hand_back(s, f)

def step(s, x, v, external, of_supports=0):
    """Semi-implicit Euler.  external: gravity, contact, anchor() of the supports [N]; of_supports: the sum of support_mass()."""
    m, inner = (s["nodes"]["mass_kg"] + of_supports)[:, None], forces(s, x)
    if "relaxation" in s:
        relax(s, time_step(s), x)
        inner += branch_forces(s, x)
    v += time_step(s) * np.divide(inner + hand_back(s, external.copy()), m, out=np.zeros(x.shape), where=m > 0)
    x += time_step(s) * v
    carry(s, x)

if __name__ == "__main__":
    s = load(sys.argv[1])
    X, check = s["nodes"]["position_m"], s["check"]
    off = abs(forces(s, check["position_m"]) - check["force_N"]).max() / abs(check["force_N"]).max()
    if "relaxation" in s:
        for dt, progress in zip(check["step_s"], check["progress"]): relax(s, dt, X + progress * (check["position_m"] - X))
        off = max(off, abs(branch_forces(s, check["position_m"]) - check["branch_force_N"]).max() / abs(check["branch_force_N"]).max())
    print(f"largest difference {off:.1e} of the largest force")
