"""Hangs a body of averaged springs up and drops it on a plane, by the numbers of a springs file alone: no springproof in here.

    springproof export CASE --model hybmss_avg --to springs --out body.npz     # whole cubes: cut = false in the case
    python3 drop_springs.py body.npz [PATCH]        # held by a patch of the file; without: by the body's highest nodes
"""
import json, sys
import numpy as np

z = np.load(sys.argv[1]) if sys.argv[1].endswith(".npz") else None
def arrays(v):  # a tree with its lists as arrays
    if isinstance(v, dict): return {key: arrays(w) for key, w in v.items()}
    return z[v[4:]] if isinstance(v, str) and v.startswith("npy:") else np.array(v) if isinstance(v, list) else v
s = arrays(json.loads(bytes(z["springs.json"])) if z else json.load(open(sys.argv[1])))
X, mass, cells, edge = s["nodes"]["position_m"], s["nodes"]["mass_kg"][:, None], s["cells"]["nodes"], s["cells"]["edge_m"]
if np.ndim(edge) or {"proportions", "fraction"} & s["cells"].keys(): sys.exit("cut cells, cells of several sizes, or boxes: examples/springs.py has them")
law, g = s["laws"]["averaged_springs"], np.array([0, 0, -9.81])
G, K = law["shear_modulus_Pa"], law["lame_lambda_Pa"] + 2 / 3 * law["shear_modulus_Pa"]
SIGN = 2.0 * np.array([[0,0,0], [1,0,0], [1,1,0], [0,1,0], [0,0,1], [1,0,1], [1,1,1], [0,1,1]]) - 1  # corners of a cell
H = np.column_stack([SIGN[:, [1, 2, 0]] * SIGN[:, [2, 0, 1]] / 2, SIGN.prod(axis=1)])  # their patterns yz zx xy xyz

def forces(x):  # of Hencky's law in the mean deformation gradient F of each cell, and of its hourglass springs
    F = np.einsum("cni,nj->cij", x[cells], SIGN) / (4 * edge)
    C, J = F.transpose(0, 2, 1) @ F, np.linalg.det(F)[:, None, None]
    I1, m = np.trace(C, axis1=1, axis2=2)[:, None, None], J**(-2 / 3)
    I2 = (I1**2 - (C**2).sum(axis=(1, 2), keepdims=True)) / 2
    y = (m * I1 + m**2 * I2 - 6) / 4
    c = G / 2 * (1 - y / 3 + 2 * y**2 / 15)
    P = c * (m + m**2 * I1) * F - c * m**2 * F @ C + (K * np.log(J) - c * (m * I1 + 2 * m**2 * I2) / 3) * np.linalg.inv(F).transpose(0, 2, 1)
    q = np.einsum("cni,nm->cim", x[cells], H)
    v = np.einsum("cij,cim->cmj", F, q)
    own, w = np.einsum("cmm->cm", v[:, :3]), law["bending"] * v[:, :3] + law["coupling"] * v[:, :3].transpose(0, 2, 1)
    w[:, range(3), range(3)] = law["torsion"] * (own + own.sum(axis=1)[:, None]) + law["twist"] * own
    w = G * edge / 2 * np.concatenate([w, law["warping"] / 4 * v[:, 3:]], axis=1)
    f = np.zeros(x.shape)
    np.add.at(f, cells, -np.einsum("cij,nj->cni", edge**3 * P + q @ w, SIGN) / (4 * edge) - np.einsum("nm,cij,cmj->cni", H, F, w))
    return f

middle = (mass * X).sum(axis=0) / mass.sum()  # the weight is that of the true body, to which a field a + b x r is added
r, a = X - middle, s["surface"]["position_m"][s["surface"]["facets"]] - middle
lack = s["density_kg_m3"] * np.linalg.det(a) / 6 @ np.column_stack([np.ones(len(a)), a.sum(axis=1) / 4]) - [mass.sum(), 0, 0, 0]
inertia = np.einsum("n,nij->ij", mass[:, 0], (r**2).sum(axis=1)[:, None, None] * np.eye(3) - r[:, :, None] * r[:, None])
weight = mass * ((1 + lack[0] / mass.sum()) * g + np.cross(np.linalg.solve(inertia, np.cross(lack[1:], g)), r))

free = np.ones((len(X), 1))
free[s["patches"][sys.argv[2]] if len(sys.argv) > 2 else X[:, 2] > X[:, 2].max() - edge / 2] = 0
u, b = np.zeros(X.shape), free * weight  # K u = weight by conjugate gradients, K p by differences of the forces
p, bb, enough = b, (b * b).sum(), 1e-20 * (b * b).sum()
while bb > enough:
    h = 1e-5 * edge / abs(p).max()
    Kp = free * (forces(X - h * p) - forces(X + h * p)) / (2 * h)
    u, b, before = u + bb / (p * Kp).sum() * p, b - bb / (p * Kp).sum() * Kp, bb
    p, bb = b + (b * b).sum() / before * p, (b * b).sum()
print(f"held by {np.count_nonzero(free == 0)} nodes it sags by {-u[:, 2].min():.9e} m at node {u[:, 2].argmin()}")

x, v, t, dt, floor = X.copy(), 0 * X, 0, 0.95 * s["derived"]["safe_time_step_s"], X[:, 2].min() - np.ptp(X, axis=0).max() / 10
while t < 2 and ((x[:, 2] > floor).all() or (mass * v)[:, 2].sum() < 0):  # until its middle rises again
    v, t = v + dt * (forces(x) / mass + g), t + dt  # semi-implicit Euler
    x = x + dt * v
    v[x[:, 2] <= floor, 2], x[:, 2] = np.maximum(v[x[:, 2] <= floor, 2], 0), np.maximum(x[:, 2], floor)
print(f"dropped from {np.ptp(X, axis=0).max() / 10:.3g} m it rebounds after {t:.4f} s, squeezed to {np.ptp(x[:, 2]) / np.ptp(X[:, 2]):.3f} of its height")
