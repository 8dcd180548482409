// The springs of a body exported with --to jolt, by semi-implicit Euler: a program of one's own in place of an engine.
import {frame, gravity, settle, text} from './settle.mjs';

const body = JSON.parse(text), {nodes: ends, rest_length_m: length, stiffness_N_m: stiffness} = body.edges;
const mass = body.nodes.mass_kg, pinned = new Set(Object.values(body.pins).flat());
const x = body.nodes.position_m.flat(), v = x.map(() => 0);
const substeps = Math.ceil(frame / (0.5 * body.safe_time_step_s)), dt = frame / substeps;

function substep() {
  const f = mass.flatMap(m => [0, 0, -m * gravity]);
  ends.forEach(([i, j], s) => {
    const d = [0, 1, 2].map(c => x[3 * j + c] - x[3 * i + c]), now = Math.hypot(...d);
    const pull = stiffness[s] * (1 - length[s] / now);
    for (let c = 0; c < 3; ++c) f[3 * i + c] += pull * d[c], f[3 * j + c] -= pull * d[c];
  });
  for (let k = 0; k < x.length; ++k) {
    const node = Math.floor(k / 3);
    if (!pinned.has(node)) x[k] += dt * (v[k] += dt * f[k] / mass[node]);
  }
}

settle({
  positions: () => [...x],
  step: () => { for (let i = 0; i < substeps; ++i) substep(); },
  slow: share => v.forEach((_, k) => { v[k] *= share; }),
});
