// What the adapters of the engines that run in node have in common: a task in, motions and forces out.
//
//   node ENGINE.mjs TASK.json          SPRINGPROOF_ENGINES: the folder whose node_modules holds the packages
//
// TASK.json and the answer, printed as JSON, are described in docs/measured/engines_measured.md.
import {readFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';
import process from 'node:process';

/// A file of a package in the cache folder.
export const packageFile = (name, file) =>
  pathToFileURL(`${process.env.SPRINGPROOF_ENGINES ?? '.'}/node_modules/${name}/${file}`).href;
export const packageVersion = name =>
  JSON.parse(readFileSync(new URL(packageFile(name, 'package.json')))).version;

/// Array of n x 3 as one Float64Array; nothing stays nothing.
export const flat = rows => rows && Float64Array.from(rows.flat());
const rows = a => Array.from({length: a.length / 3}, (_, i) => [a[3 * i], a[3 * i + 1], a[3 * i + 2]]);

/// t [s], kinetic energy [J], mean position of the watched nodes [m], angular momentum about the rest centre [N m s].
function sample(time, engine, task, centre) {
  const x = engine.positions(), v = engine.velocities(), m = engine.masses;
  let kinetic = 0;
  const tip = [0, 0, 0], spin = [0, 0, 0];
  for (let i = 0; i < m.length; ++i) {
    const at = 3 * i, r = [0, 1, 2].map(c => x[at + c] - centre[c]), w = [0, 1, 2].map(c => v[at + c]);
    kinetic += 0.5 * m[i] * (w[0] ** 2 + w[1] ** 2 + w[2] ** 2);
    for (let c = 0; c < 3; ++c) spin[c] += m[i] * (r[(c + 1) % 3] * w[(c + 2) % 3] - r[(c + 2) % 3] * w[(c + 1) % 3]);
  }
  task.watch.forEach((n, k) => { for (let c = 0; c < 3; ++c) tip[c] += task.watch_weights[k] * x[3 * n + c]; });
  return [time, kinetic, ...tip, ...spin];
}

/// Steps with velocities scaled by exp(-damping dt) after each but the last `free_steps`; the time is the engine's alone.
function move(engine, task) {
  const forces = flat(task.forces_N), samples = [], decay = Math.exp(-task.damping_1_s * task.dt_s);
  const n = engine.masses.length, x = engine.positions(), centre = [0, 1, 2].map(c => {
    let sum = 0;
    for (let i = 0; i < n; ++i) sum += x[3 * i + c] / n;
    return sum;
  });
  if (task.velocities_m_s) engine.setVelocities(flat(task.velocities_m_s));
  samples.push(sample(0, engine, task, centre));
  let microseconds = 0;
  for (let step = 1; step <= task.steps; ++step) {
    const before = process.cpuUsage();
    engine.step(task.dt_s, forces);
    const used = process.cpuUsage(before);
    microseconds += used.user + used.system;
    if (decay < 1 && step <= task.steps - task.free_steps) engine.setVelocities(engine.velocities().map(v => v * decay));
    if (step % task.sample_every === 0 || step === task.steps) samples.push(sample(step * task.dt_s, engine, task, centre));
  }
  return {samples, seconds: microseconds * 1e-6, steps: task.steps, positions_m: rows(engine.positions())};
}

/// Reads the task, has the engine built by `make(task, model)`, and prints the answer.
export async function main(make) {
  const task = JSON.parse(readFileSync(process.argv[2]));
  const engine = await make(task, JSON.parse(readFileSync(task.model)));
  const answer = {engine: engine.name};
  if (task.fields_m) {
    const centred = u => {  // (f(u) - f(-u)) / 2: without the terms of second order
      const plus = engine.forces(u), minus = engine.forces(u.map(c => -c));
      return plus.map((f, i) => (f - minus[i]) / 2);
    };
    answer.forces_N = engine.forces ? task.fields_m.map(u => rows(centred(flat(u)))) : null;
  }
  if (task.steps) Object.assign(answer, move(engine, task));
  process.stdout.write(JSON.stringify(answer) + '\n', () => process.exit(0));  // WASM keeps threads
}
