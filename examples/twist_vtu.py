"""Twists a bar by a quarter turn and writes its motion back for ParaView and PyVista.   twist_vtu.py [FOLDER]

    paraview twist/motion.pvd       # or: pyvista.read("twist/motion.pvd")
"""
import pathlib
import sys

import numpy as np
import springproof as sp

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "twist")
folder.mkdir(exist_ok=True)
bar = sp.block(size=(0.02, 0.02, 0.08), cells=(4, 4, 16))
model = sp.Model("hybmss_avg", bar, sp.Material(E=1e5, nu=0.45, density=1000))

# Large displacement: the top turned about the bar's axis.
twisted = model.solve([sp.Displacement("z_min"), sp.Rotation("z_max", point=(0.01, 0.01, 0), axis=(0, 0, 1), angle=np.pi / 2)], large=True)
torque = twisted.reactions["z_max"][1, 2]
print(f"torque {1e3 * torque:.4f} mN m, volume changes by {100 * twisted.volume_change:.3f} %")

# Let loose: it swings about its shape at rest, held at the bottom.
motion = model.motion([sp.Displacement("z_min")], damping=5)
motion.set_state(model.positions + twisted.displacement, np.zeros_like(model.positions))
series = []
for picture in range(20):
    name = f"{picture:02}.vtu"
    sp.write_vtu(folder / name, bar, model.on_body(motion.positions - model.positions), velocity=model.on_body(motion.velocities))
    series.append((motion.time, name))
    motion.step(max(1, round(2.5e-3 / motion.time_step)))
sp.write_pvd(folder / "motion.pvd", series)
print(f"{len(series)} pictures in {folder}, {motion.steps} steps of {motion.time_step:.3g} s by {motion.description}")
print(f"energy {1e3 * (motion.kinetic_energy + motion.elastic_energy):.4f} mJ after {motion.time:.3f} s")
