// MuJoCo (Apache-2.0, npm @mujoco/mujoco, WASM): a flex of the exported block.  Collisions and damping are off.
// Set-ups: export (the exported MJCF, linear tetrahedra), full (a grid of linear tetrahedra), trilinear (on the cells),
// quadratic (on cells of twice the edge).
import {readFileSync} from 'node:fs';
import {main, packageFile, packageVersion} from './adapter.mjs';

/// A block of cells as a flexcomp of type grid.
function mjcf(task, model, pins) {
  const {edge_m: h} = model.cells, X = model.nodes.position_m, {material} = model;
  const low = [0, 1, 2].map(c => X.reduce((a, p) => Math.min(a, p[c]), Infinity));
  const cells = [0, 1, 2].map(c => Math.round((X.reduce((a, p) => Math.max(a, p[c]), -Infinity) - low[c]) / h));
  const coarse = task.set_up === 'quadratic' ? 2 : 1;
  const dof = task.set_up === 'full' ? 'full' : `${task.set_up}" cellcount="${cells.map(n => n / coarse).join(' ')}`;
  const mass = model.nodes.mass_kg.reduce((a, b) => a + b, 0);
  return `<mujoco><option integrator="discrete"/>
<worldbody><body name="held"><flexcomp name="body" type="grid" dim="3" dof="${dof}" count="${cells.map(n => n + 1).join(' ')}"
 spacing="${h} ${h} ${h}" pos="${low.map((a, c) => a + cells[c] * h / 2).join(' ')}" radius="1e-3" mass="${mass}">
<elasticity young="${material.youngs_modulus_Pa}" poisson="${material.poisson_ratio}" damping="0"/>
<contact selfcollide="none" internal="false" contype="0" conaffinity="0"/>${pins.length ? `<pin id="${pins.join(' ')}"/>` : ''}
</flexcomp></body></worldbody></mujoco>`;
}

await main(async (task, model) => {
  const {default: init} = await import(packageFile('@mujoco/mujoco', 'mujoco.js'));
  const mujoco = await init();
  const X = model.nodes.position_m, n = X.length;
  const held = new Set(task.pinned ? Object.values(model.pins).flat() : []);
  const key = p => p.map(c => Math.round(c * 1e6)).join();
  const nodeAt = new Map(X.map((p, i) => [key(p), i]));
  const load = xml => {
    const m = mujoco.MjModel.from_xml_string(xml);
    m.opt.timestep = task.dt_s;
    m.opt.integrator = mujoco.mjtIntegrator[`mjINT_${task.integrator.toUpperCase()}`].value;
    for (let c = 0; c < 3; ++c) m.opt.gravity[c] = task.gravity_m_s2[c];
    const d = new mujoco.MjData(m);
    mujoco.mj_forward(m, d);
    return [m, d];
  };
  // The moving bodies, each with the number of its node.
  const numbered = (m, d) => Array.from({length: m.nbody}, (_, b) => b).filter(b => m.body_dofnum[b] === 3)
    .map(b => [b, nodeAt.get(key([0, 1, 2].map(c => d.xpos[3 * b + c])))]);
  let m, d;
  if (task.mjcf) {
    [m, d] = load(readFileSync(task.mjcf, 'utf8'));
  } else {
    [m, d] = load(mjcf(task, model, []));
    if (held.size) {  // MuJoCo's numbers of the held nodes, from the flex that has a body for each
      const pins = numbered(m, d).flatMap(([, i], k) => held.has(i) ? [k] : []);
      d.delete(), m.delete();
      [m, d] = load(mjcf(task, model, pins));
    }
  }
  const bodies = numbered(m, d), moving = bodies.map(([, i]) => i), dof = bodies.map(([b]) => m.body_dofadr[b]);
  if (moving.length !== n - held.size || moving.some(i => i === undefined || held.has(i)))
    throw new Error(`${moving.length} bodies move for ${n} nodes, ${held.size} held`);
  const masses = Float64Array.from(model.nodes.mass_kg);  // held nodes keep the file's
  bodies.forEach(([b, i]) => { masses[i] = m.body_mass[b]; });
  const rest = Float64Array.from(X.flat());
  const read = (from, base) => {
    const out = base.slice();
    moving.forEach((i, k) => { for (let c = 0; c < 3; ++c) out[3 * i + c] += from[dof[k] + c]; });
    return out;
  };
  const write = (to, values) => moving.forEach((i, k) => { for (let c = 0; c < 3; ++c) to[dof[k] + c] = values[3 * i + c]; });
  const zero = new Float64Array(3 * n);
  return {
    name: `MuJoCo ${mujoco.mj_versionString?.() ?? ''}, npm @mujoco/mujoco ${packageVersion('@mujoco/mujoco')}`,
    masses,
    positions: () => read(d.qpos, rest),
    velocities: () => read(d.qvel, zero),
    setVelocities: v => write(d.qvel, v),
    forces: u => {
      write(d.qpos, u);
      mujoco.mj_forward(m, d);
      return read(d.qfrc_passive, zero);
    },
    step(dt, forces) {
      if (forces && !this.pushed) write(d.qfrc_applied, forces), this.pushed = true;
      mujoco.mj_step(m, d);
    },
  };
});
