// Our own springs as an engine: semi-implicit Euler on the edges of the exported file, double precision.  What it
// returns is known, so it proves the ruler.
import {main} from './adapter.mjs';

await main((task, model) => {
  const X = Float64Array.from(model.nodes.position_m.flat()), masses = Float64Array.from(model.nodes.mass_kg);
  const held = new Uint8Array(masses.length);
  if (task.pinned) for (const nodes of Object.values(model.pins)) for (const n of nodes) held[n] = 1;
  const {nodes: ends, rest_length_m: length, stiffness_N_m: stiffness} = model.edges;
  let x = X.slice(), v = new Float64Array(X.length);
  const forcesAt = at => {
    const f = new Float64Array(at.length);
    for (let s = 0; s < ends.length; ++s) {
      const i = 3 * ends[s][0], j = 3 * ends[s][1];
      const d = [at[j] - at[i], at[j + 1] - at[i + 1], at[j + 2] - at[i + 2]], now = Math.hypot(...d);
      const pull = stiffness[s] * (now - length[s]) / now;
      for (let c = 0; c < 3; ++c) f[i + c] += pull * d[c], f[j + c] -= pull * d[c];
    }
    return f;
  };
  return {
    name: 'springs of the file, semi-implicit Euler',
    masses,
    positions: () => x,
    velocities: () => v,
    setVelocities: w => { v = w.map((c, k) => held[Math.floor(k / 3)] ? 0 : c); },
    forces: u => forcesAt(X.map((c, k) => c + u[k])),
    step(dt, forces) {
      for (let h = dt / task.iterations, i = 0; i < task.iterations; ++i) {
        const f = forcesAt(x);
        for (let k = 0; k < x.length; ++k) {
          if (held[Math.floor(k / 3)]) continue;
          const mass = masses[Math.floor(k / 3)];
          v[k] += h * ((f[k] + (forces ? forces[k] : 0)) / mass + task.gravity_m_s2[k % 3]);
          x[k] += h * v[k];
        }
      }
    },
  };
});
