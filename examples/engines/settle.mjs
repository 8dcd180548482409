// What the programs of this folder that run in node have in common: steps until rest, then the CSV file that
// [[external]] of a case reads (docs/engines.md).
//
//   node ENGINE.mjs BODY OUT.csv
import {readFileSync, writeFileSync} from 'node:fs';
import process from 'node:process';

/// The exported body, as text.
export const text = readFileSync(process.argv[2], 'utf8');

export const gravity = 9.81, frame = 1 / 60;  // along -z [m/s^2], [s]

/// Lets a body come to rest under its weight and writes where its nodes are.  It falls undamped until it is fastest, a
/// quarter of its slowest period, and then, for twenty times as long, damped critically for that period.
/// `engine` has positions(): of the nodes, x y z x y z ... [m]; step(): a frame; slow(share): multiplies velocities.
export function settle({positions, step, slow}) {
  const rest = positions();
  let x = rest, speed = 0, fastest = 0, quarter = Infinity;
  for (let frames = 1; frames < 21 * quarter; ++frames) {
    step();
    const before = x;
    x = positions();
    speed = Math.hypot(...x.map((p, k) => p - before[k]));
    if (!Number.isFinite(speed) || frames > 1000 && quarter === Infinity) throw new Error('the body does not come to rest');
    if (speed < fastest) quarter = Math.min(quarter, frames);
    fastest = Math.max(fastest, speed);
    slow(Math.exp(-Math.PI / quarter));  // 2 omega dt, where omega = pi / 2 of a quarter
  }
  if (speed > 5e-3 * fastest) throw new Error('the body does not come to rest');
  const lines = Array.from({length: x.length / 3}, (_, i) => [...rest.slice(3 * i, 3 * i + 3), ...x.slice(3 * i, 3 * i + 3)].join());
  writeFileSync(process.argv[3], `x,y,z,X,Y,Z\n${lines.join('\n')}\n`);
  process.exit(0);  // WASM keeps threads
}
