'use strict';
// What positions.cpp does, by WebAssembly.   node positions.js FOLDER DIGITS
const fs = require('fs'), path = require('path');
const [folder, digits = '64'] = process.argv.slice(2);

require(path.resolve(folder, 'live.js'))({wasmBinary: fs.readFileSync(path.join(folder, 'live.wasm'))}).then(wasm => {
  const copied = (values, heap, bytes) => {
    const at = wasm._malloc(values.length * bytes);
    wasm[heap].set(values, at / bytes);
    return at;
  };
  const text = s => copied(Buffer.from(s + '\0'), 'HEAPU8', 1);
  const require0 = status => { if (status !== 0) throw new Error(wasm.UTF8ToString(wasm._live_message())); };
  const corners = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
  const points = Array.from({length: 24}, (_, i) => Math.floor(i / 3) >> i % 3 & 1 ? 0.1 : 0);
  const facets = corners.flatMap(c => [0, 1, 2, 0, 2, 3].map(i => c[i])), parts = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 2];
  require0(wasm._live_body(copied(points, 'HEAPF32', 4), 8, copied(facets, 'HEAPU16', 2), copied(parts, 'HEAPU8', 1), 12, 512));
  for (const name of ['msm_18', 'hybmss', 'hybmss_avg', 'emsm'].map(text)) {
    require0(wasm._live_model(0, name, 0.3, 1e4, 1000, +digits));
    wasm._live_load(2, 0, 5);
    wasm._live_grab(7);
    wasm._live_pull_to(0.11, 0.105, 0.115);
    const step = wasm._live_number(0, 0) / 2;
    let steps = wasm._live_advance(0, 49 * step, 3);
    require0(wasm._live_model(0, name, 0.45, 2e4, 1000, +digits));
    while (steps < 100) steps += wasm._live_advance(0, step / 4, 3);
    const at = wasm._live_node_positions(0) / 8;
    process.stdout.write([...wasm.HEAPF64.subarray(at, at + 3 * wasm._live_nodes())].join('\n') + '\n');
  }
}).catch(error => {   // not the error as it is: Node would print the module
  process.stderr.write(String(error.message).slice(0, 400) + '\n');
  process.exit(1);
});
