"""Deflection of a cantilever against Poisson's ratio: three models beside Timoshenko's beam.   plot_bending.py [PICTURE]"""
import sys

import matplotlib

matplotlib.use("Agg")  # no display
import matplotlib.pyplot as plt
import numpy as np
import springproof as sp

length, height, E, force = 0.1, 0.02, 1e5, 0.01  # [m], [Pa], [N]
bar = sp.block(size=(length, height, height), cells=(20, 4, 4))
ratios = np.array([-0.4, 0, 0.25, 0.4, 0.45, 0.49])


def deflection(model, nu, **options):
    state = sp.Model(model, bar, sp.Material(E, nu), **options).solve([sp.Displacement("x_min"), sp.Force("x_max", (0, 0, -force))])
    return -state.at([(length, height / 2, height / 2)])[0, 2]


def beam(nu):  # Timoshenko; shear coefficient of a square by Cowper
    I, G, kappa = height**4 / 12, E / (2 * (1 + nu)), 10 * (1 + nu) / (12 + 11 * nu)
    return force * length**3 / (3 * E * I) + force * length / (kappa * G * height**2)


fig, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(ratios, 1e3 * beam(ratios), "k--", label="beam theory")
for model in ("hybmss_avg", "hybmss", "emsm"):
    tips = np.array([deflection(model, nu) for nu in ratios])
    axes.plot(ratios, 1e3 * tips, "o-", label=model)
    print(f"{model:<11} off by {' '.join(f'{100 * d:+.1f}' for d in tips / beam(ratios) - 1)} % at nu = {' '.join(f'{nu:g}' for nu in ratios)}")
axes.set(xlabel="Poisson's ratio", ylabel="deflection of the tip [mm]")
axes.legend()
picture = sys.argv[1] if len(sys.argv) > 1 else "bending.png"
fig.savefig(picture, dpi=120)
print(picture)
