"""Plays springs on your own mesh in Blender: the body is held at one patch, its weight sets in, and the motion is kept as shape keys.

    springproof export body.obj --scale 0.01 -E 5e3 --nu 0.45 --hold bottom --carry body.obj --to springs --out body.npz
    blender --background --python blender_springs.py -- body.npz bottom 48 body.blend    # 48 frames at 24 a second

Vertices have the order of the file that --carry names. springs.py lies beside this file; Blender's Python has NumPy.
"""
import sys
from pathlib import Path
import bpy
import numpy as np
sys.path.insert(0, str(Path(__file__).resolve().parent))
from springs import load, anchor, step, support_mass, time_step

name, held, frames, out = sys.argv[sys.argv.index("--") + 1:]
s, frames, fps, damping, ramp = load(name), int(frames), 24, 1.0, 0.5  # [1/s]; the weight grows for so long [s]
surface, X, mass = s["surface"], s["nodes"]["position_m"], s["nodes"]["mass_kg"][:, None]
x, v, t, mu = X.copy(), 0 * X, 0, support_mass(s, held)
weight = s["nodes"]["weight_kg"][:, None] * [0, 0, -9.81]
of = np.repeat(np.arange(len(surface["position_m"])), np.diff(surface["first"]))  # the vertex of each entry

mesh = bpy.data.meshes.new(Path(name).stem)
mesh.from_pydata(surface["position_m"].tolist(), [], surface["facets"].tolist())
body = bpy.data.objects.new(mesh.name, mesh)
bpy.context.scene.collection.objects.link(body)
body.shape_key_add(name="rest")
mesh.shape_keys.use_relative = False  # the keys lie on one axis of time, ten units apart
scene = bpy.context.scene
scene.render.fps, scene.frame_start, scene.frame_end = fps, 0, frames
for frame in range(1, frames + 1):
    while t < frame / fps:
        step(s, x, v, min(1, t / ramp) * weight - damping * mass * v + anchor(s, held, x), mu)
        t += time_step(s)
    moved = surface["position_m"].copy()
    np.add.at(moved, of, surface["weights"][:, None] * (x - X)[surface["nodes"]])
    body.shape_key_add(name=f"frame {frame}").data.foreach_set("co", moved.ravel())
    if np.isnan(x).any(): sys.exit(f"frame {frame}: a cell has turned inside out: a stiffer material, a slower load or smaller cells")
    print(f"frame {frame} of {frames}: moved by up to {abs(x - X).max():.3g} m")
for frame in (0, frames):
    mesh.shape_keys.eval_time = 10 * frame
    mesh.shape_keys.keyframe_insert("eval_time", frame=frame)
for curve in mesh.shape_keys.animation_data.action.fcurves:
    for point in curve.keyframe_points: point.interpolation = "LINEAR"
bpy.ops.wm.save_as_mainfile(filepath=str(Path(out).resolve()))
