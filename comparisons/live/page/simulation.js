'use strict';
// The library compiled to WebAssembly: bodies, models and time; no pictures in here.

const numberOf = {timeStep: 0, volumeChange: 1, leastVolume: 2, kineticEnergy: 3, unbalanced: 4, frequency: 5, rescues: 6, pull: 7};

class Simulation {
  constructor(wasm) {
    this.wasm = wasm;
    this.costs = [0, 0, 0];   // ms per step, a running mean
    this.digits = 0;   // bits of the library's numbers: as many as each model needs
  }

  /// A copy of the values in the library's memory, to be freed.
  copied(values, heap, bytes) {
    const at = this.wasm._malloc(Math.max(1, values.length) * bytes);
    heap().set(values, at / bytes);
    return at;
  }

  withText(text, f) {
    const at = this.copied(new TextEncoder().encode(text + '\0'), () => this.wasm.HEAPU8, 1);
    try { return f(at); } finally { this.wasm._free(at); }
  }

  /// Throws the library's own words if something failed.
  checked(status) {
    const message = this.wasm.UTF8ToString(this.wasm._live_message());
    if (status !== 0) throw new Error(message);
    return message;
  }

  /// surface: {points, facets, parts}; returns notes.
  setBody({points, facets, parts}, cells) {
    const {wasm} = this;
    const at = [this.copied(points, () => wasm.HEAPF32, 4), this.copied(facets, () => wasm.HEAPU16, 2), this.copied(parts, () => wasm.HEAPU8, 1)];
    const notes = this.checked(wasm._live_body(at[0], points.length / 3, at[1], at[2], parts.length, cells));
    at.forEach(p => wasm._free(p));
    return this.bodyIsThere(notes);
  }

  setStl(bytes, cells) {
    const at = this.copied(bytes, () => this.wasm.HEAPU8, 1);
    try {
      return this.bodyIsThere(this.checked(this.wasm._live_stl(at, bytes.length, cells)));
    } finally {
      this.wasm._free(at);
    }
  }

  bodyIsThere(notes) {
    const {wasm} = this;
    this.points = wasm._live_points();
    this.cells = wasm._live_cells();
    this.nodes = wasm._live_nodes();
    const facets = wasm._live_facet_points() / 4, rest = wasm._live_rest_positions() / 4;
    this.facets = Uint32Array.from(wasm.HEAP32.subarray(facets, facets + 3 * wasm._live_facets()));
    this.rest = wasm.HEAPF32.slice(rest, rest + 3 * this.points);
    return notes;
  }

  setModel(panel, name, {nu, E, density}) {
    this.checked(this.withText(name, at => this.wasm._live_model(panel, at, nu, E, density, this.digits)));
  }

  number(panel, what) { return this.wasm._live_number(panel, numberOf[what]); }
  grab(point) { this.wasm._live_grab(point); }
  pullTo([x, y, z]) { this.wasm._live_pull_to(x, y, z); }
  load([x, y, z]) { this.wasm._live_load(x, y, z); }
  goToRest() { this.wasm._live_rest(); }

  /// Views into the library's memory, good until the next call.
  positions(panel) { const at = this.wasm._live_positions(panel) / 4; return this.wasm.HEAPF32.subarray(at, at + 3 * this.points); }
  dilatation(panel) { const at = this.wasm._live_dilatation(panel) / 4; return this.wasm.HEAPF32.subarray(at, at + this.points); }

  /// Moves all panels by the same time: `wanted` [s], or as much of it as `budget` [ms] allows.
  advance(wanted, budget, damping) {
    const panels = [0, 1, 2], needed = panels.map(p => this.costs[p] / this.number(p, 'timeStep'));
    const cost = needed.reduce((sum, c) => sum + c, 0) * wanted;
    const duration = cost > budget ? wanted * budget / cost : wanted;
    const steps = [], begin = performance.now();
    for (const p of panels) {
      const start = performance.now();
      steps.push(this.wasm._live_advance(p, duration, damping));
      const cost = (performance.now() - start) / steps[p];
      this.costs[p] = this.costs[p] === 0 ? cost : 0.9 * this.costs[p] + 0.1 * Math.min(cost, 4 * this.costs[p]);
    }
    return {duration, steps, ms: performance.now() - begin};
  }
}
