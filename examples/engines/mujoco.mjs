// MuJoCo (Apache-2.0, npm @mujoco/mujoco): the flex of tetrahedra of a body exported with --to mujoco.
import init from '@mujoco/mujoco';
import {frame, gravity, settle, text} from './settle.mjs';

const mujoco = await init(), model = mujoco.MjModel.from_xml_string(text), data = new mujoco.MjData(model);
model.opt.timestep = frame;
[0, 0, -gravity].forEach((g, c) => { model.opt.gravity[c] = g; });
mujoco.mj_forward(model, data);

settle({
  positions: () => Array.from(data.flexvert_xpos),
  step: () => mujoco.mj_step(model, data),
  slow: share => data.qvel.forEach((v, k) => { data.qvel[k] = share * v; }),
});
