'use strict';
// The live page: bodies to choose, three panels, the pull by pointer or keys, and the numbers.

const pulls = readJson('pulls-data');
const names = ['msm_18', 'hybmss', 'hybmss_avg'];
const modelWords = {msm_18: 'springs alone', msm_14: 'springs alone, 14', hybmss: 'springs + volume', hybmss_cf: 'springs alone, 26',
                    emsm: 'springs + dispersion', hybmss_avg: 'averaged springs'};
const state = {body: null, fem: null, nu: 0.45, E: 1e4, density: 1000, damping: 4, cells: 2000, models: [...names],
               grip: null, loadTime: 0, top: 0.05, moved: 0, measured: {}};
const frameBudget = 11;        // ms of springs per frame: the rest is for drawing
const rampTime = 0.5;          // s of simulated time over which a stored pull grows
const stress = E => E >= 1e6 ? `${number(E / 1e6, 3)} MPa` : E >= 1e3 ? `${number(E / 1e3, 3)} kPa` : `${number(E, 3)} Pa`;
const percentText = (x, digits) => {
  const text = (100 * x).toFixed(digits);
  return (Number(text) === 0 ? text.replace('-', '') : (x > 0 ? '+' : '') + minus(text)) + ' %';
};

let simulation, viewer, panels = [], view = null;

// ---- controls

function slider(label, {min, max, step, value, list, wide}, text, onchange) {
  const output = el('output', {}, text(value));
  const input = el('input', {type: 'range', min, max, step, value, list, oninput: () => {
    output.textContent = text(+input.value);
    onchange(+input.value);
  }});
  const node = el('label', {class: 'slider' + (wide ? ' nu' : '')}, el('span', {}, label, output), input);
  return {node, set(v) { input.value = v; output.textContent = text(v); }};
}

const bodyChoice = select('body', [...pulls.bodies.map(b => [b.name, b.title]), ['stl', 'your own STL …']], name =>
  name === 'stl' ? fileInput.click() : showBody(pulls.bodies.find(b => b.name === name)));
const fileInput = el('input', {type: 'file', accept: '.stl', hidden: true, onchange: () => fileInput.files[0] && readStl(fileInput.files[0])});
const nuSlider = slider('Poisson’s ratio ν', {min: -0.5, max: 0.499, step: 0.001, value: state.nu, list: 'stored', wide: true},
                        v => minus(v.toFixed(3)), v => { state.nu = v; state.stale = true; findFem(); });
const eSlider = slider('Young’s modulus E', {min: 3, max: 6, step: 0.05, value: 4}, v => stress(10 ** v), v => { state.E = 10 ** v; state.stale = true; });
const densitySlider = slider('density', {min: 200, max: 4000, step: 50, value: 1000}, v => `${v} kg/m³`, v => { state.density = v; state.stale = true; });
const dampingSlider = slider('damping', {min: 0, max: 30, step: 0.5, value: state.damping}, v => `${v} /s`, v => { state.damping = v; });
const cellsSlider = slider('cubes, about', {min: 300, max: 6000, step: 100, value: state.cells}, v => String(v), v => { state.cells = v; state.rebuild = true; });
const compareButton = el('button', {class: 'main', onclick: () => compareWithFem()}, 'Compare with finite elements');
const pauseButton = el('button', {onclick: () => pause(!state.paused)}, 'Pause');
const resetButton = el('button', {onclick: () => reset()}, 'Reset');

const bar = colorBar();
const hint = document.getElementById('hint'), said = document.getElementById('said'), speed = document.getElementById('speed');

// ---- bodies

/// Arrays of a stored body.
function stored(body) {
  if (!body.points) {
    body.points = shortsOf(body.surface.points);
    body.facets = new Uint16Array(bytesOf(body.surface.facets));
    body.parts = new Uint8Array(bytesOf(body.surface.parts));
  }
  return body;
}

function showBody(body) {
  state.body = body;
  state.E = body.youngs_modulus;
  eSlider.set(Math.log10(state.E));
  build(() => simulation.setBody(stored(body), state.cells));
  setStored();
}

async function readStl(file) {
  const bytes = new Uint8Array(await file.arrayBuffer()), before = state.body;
  try {
    state.body = {name: 'stl', title: file.name, bytes, fem: []};
    build(() => simulation.setStl(bytes, state.cells));
    say(`${file.name}: ${simulation.facets.length / 3} facets in ${simulation.cells} whole cubes`);
    bodyChoice.value = 'stl';
  } catch (error) {
    state.body = before;
    bodyChoice.value = before.name;
    hint.textContent = `${file.name} cannot be used: ${error.message}`;
    say(hint.textContent);
    if (before.bytes) build(() => simulation.setStl(before.bytes, state.cells), false);
    else build(() => simulation.setBody(stored(before), state.cells), false);
  }
  setStored();
}

function build(make, clearHint = true) {
  const notes = make();
  state.fem = state.grip = null;
  simulation.costs = [0, 0, 0];
  setModels();
  if (clearHint) hint.textContent = [`Pull with the pointer: take hold of any place of a body; drag beside it to turn the view. ${state.body.bytes
    ? 'Held where it stands; scaled to a height of 25 cm.' : ''}`, notes].join(' ').trim();
  makePanels();
}

function setModels() {
  for (const p of [0, 1, 2]) simulation.setModel(p, state.models[p], state);
  if (state.fem) applyLoad();
  state.stale = false;
}

function reset() {
  letGo();
  state.fem = null;
  simulation.load([0, 0, 0]);
  simulation.goToRest();
  findFem();
}

// ---- finite elements

function setStored() {
  const {fem} = state.body;
  const list = document.getElementById('stored');
  list.replaceChildren(...fem.map(f => el('option', {value: f.nu})));
  compareButton.hidden = fem.length === 0;
  findFem();
}

/// The answer of finite elements at this nu: the stored one, or the cubic through the four ratios nearest to it.
function femAt(nu) {
  const {fem} = state.body;
  for (const f of fem) f.u = f.u || shortsOf(f.displacement);
  const stored = fem.find(f => Math.abs(f.nu - nu) < 5e-4);
  if (stored) return {...stored, between: false};
  const above = fem.findIndex(f => f.nu > nu), from = Math.max(0, Math.min(fem.length - 4, above - 2)), near = fem.slice(from, from + 4);
  const weights = near.map((f, i) => near.reduce((w, g, j) => i === j ? w : w * (nu - g.nu) / (f.nu - g.nu), 1));
  const mix = value => near.reduce((sum, f, i) => sum + weights[i] * value(f), 0);
  return {nu, between: true, uncertainty: Math.max(...near.map(f => f.uncertainty)), volume_change: mix(f => f.volume_change),
          u: near[0].u.map((_, k) => mix(f => f.u[k]))};
}

/// While a stored pull acts, its answer at this nu.
function findFem() {
  if (state.fem) Object.assign(state.fem, {answer: femAt(state.nu), told: false});
  placeGhosts();
  if (state.fem) tellFem();
}

function compareWithFem() {
  reset();
  setModels();
  state.fem = {answer: null};
  state.loadTime = 0;
  findFem();
  say(`${state.body.pull.text}, at ν = ${nuText(state.nu)}`);
  tellFem();
}

function tellFem() {
  const {answer} = state.fem, {fem, interpolation} = state.body;
  hint.textContent = `${state.body.pull.text}. Grey ghost: finite elements at ν = ${nuText(answer.nu)}, certain to ${percent(100 * answer.uncertainty)}` +
    (answer.between ? `, between those stored at ${fem.map(f => nuText(f.nu)).join(', ')} (to ${percent(100 * interpolation)}).` : '.');
}

/// Displacements do not depend on E: the force is in proportion to it.
function applyLoad() {
  const share = Math.min(1, state.loadTime / rampTime), factor = share * state.E / state.body.youngs_modulus;
  simulation.load(state.body.pull.force.map(f => factor * f));
}

/// Root mean square distance from finite elements over the surface, by that of their displacement.
function differenceOf(panel) {
  const {u} = state.fem.answer, x = simulation.positions(panel), {rest} = simulation;
  let off = 0, size = 0;
  for (let i = 0; i < u.length; ++i) {
    off += (x[i] - rest[i] - u[i]) ** 2;
    size += u[i] ** 2;
  }
  return Math.sqrt(off / size);
}

const atRest = panel => simulation.number(panel, 'unbalanced') < 2e-3 * Math.hypot(...state.body.pull.force) * state.E / state.body.youngs_modulus;

// ---- panels

function makePanels() {
  for (const {own} of panels) for (const object of own) { object.geometry.dispose(); object.material.dispose(); }
  const {triangles, source} = splitAtSharpEdges(simulation.rest, simulation.facets);
  const rest = taken(simulation.rest, source, 3), index = new THREE.BufferAttribute(triangles, 1);
  const edges = new THREE.BufferAttribute(edgesOf(quadsOfTriangles(triangles)), 1);
  const shape = {rest, displacement: new Float32Array(rest.length), surface: {smooth: true, source, triangles: index, edges: null}};
  const box = boundsOf(rest), size = box.getSize(new THREE.Vector3());
  panels = state.models.map((name, number) => {
    const surface = deformedSurface(shape), ghost = ghostSurface(rest, edges), rope = ropeOf(), floor = floorUnder(box);
    surface.body.material = new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors,
      side: state.body.bytes ? THREE.DoubleSide : THREE.FrontSide});   // dropped surfaces may be inside out
    ghost.visible = false;
    const own = [floor, ...surface.objects, ghost, rope];
    const volume = el('span', {class: 'volume'}), fem = el('small'), chip = el('span', {class: 'chip none off', hidden: true});
    const choice = el('select', {'aria-label': `model of body ${number + 1}`, onchange: () => { state.models[number] = choice.value; changeModel(number); }},
      Object.keys(modelWords).map(m => el('option', {value: m, selected: m === name}, m)));
    const words = el('small', {}, modelWords[name]);
    const label = el('div', {class: 'panel-label'}, swatch(name), choice, words, volume, fem, chip);
    return {number, shape, surface, ghost, rope, own, label, volume, fem, chip, words, ...litScene(own)};
  });
  panels.forEach(paint);
  viewer.show(panels);
  viewer.forgetDirection();
  view = [box.expandByScalar(0.12 * size.length()), [rest, ...state.body.fem.slice(0, 1).map(f => {
    const u = shortsOf(f.displacement);
    return simulation.rest.map((x, i) => x + u[i]);
  })]];
  viewer.aim(...view);
  placeGhosts();
}

function changeModel(number) {
  simulation.setModel(number, state.models[number], state);
  if (state.fem) applyLoad();
  panels[number].words.textContent = modelWords[state.models[number]];
  panels[number].label.querySelector('.swatch').style.background = modelStyle(state.models[number]).color;
}

/// Triangles as quadrilaterals whose last corner is twice there.
const quadsOfTriangles = triangles => Uint32Array.from({length: triangles.length / 3 * 4}, (_, i) => triangles[3 * (i >> 2) + Math.min(i & 3, 2)]);

function ghostSurface(rest, edges) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(rest.slice(), 3));
  geometry.setIndex(edges);
  const ghost = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: 0x8a8f98, transparent: true, opacity: 0.35, depthWrite: false}));
  ghost.frustumCulled = false;
  return ghost;
}

function placeGhosts() {
  const answer = state.fem && state.fem.answer;
  for (const {ghost, shape} of panels) {
    ghost.visible = Boolean(answer);
    if (!answer) continue;
    const u = taken(answer.u, shape.surface.source, 3), at = ghost.geometry.attributes.position;
    for (let i = 0; i < u.length; ++i) at.array[i] = shape.rest[i] + u[i];
    at.needsUpdate = true;
  }
}

/// The spring from the held place to the pointer.
function ropeOf() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6), 3));
  const rope = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: 0xe69f00, depthTest: false}));
  rope.frustumCulled = false;
  rope.renderOrder = 2;
  rope.visible = false;
  return rope;
}

/// A soft shadow where the body stands.
function floorUnder(box) {
  const canvas = el('canvas', {width: 128, height: 128}), ctx = canvas.getContext('2d');
  const shade = ctx.createRadialGradient(64, 64, 8, 64, 64, 64);
  shade.addColorStop(0, 'rgba(90, 100, 120, 0.42)');
  shade.addColorStop(1, 'rgba(90, 100, 120, 0)');
  ctx.fillStyle = shade;
  ctx.fillRect(0, 0, 128, 128);
  const size = box.getSize(new THREE.Vector3()), centre = box.getCenter(new THREE.Vector3());
  const floor = new THREE.Mesh(new THREE.PlaneBufferGeometry(1.9 * size.x, 1.9 * size.y),
    new THREE.MeshBasicMaterial({map: new THREE.CanvasTexture(canvas), transparent: true, depthWrite: false}));
  floor.position.set(centre.x, centre.y, box.min.z - 1e-3 * size.z);
  floor.renderOrder = -1;
  return floor;
}

const lut = Array.from({length: 257}, (_, i) => colorAt(coolWarmStops, i / 256));

function paint({number, shape, surface, rope}) {
  const x = simulation.positions(number), {source} = shape.surface, at = surface.position.array;
  for (let i = 0; i < source.length; ++i)
    for (let c = 0; c < 3; ++c) at[3 * i + c] = x[3 * source[i] + c];
  const J = simulation.dilatation(number), colour = surface.body.geometry.attributes.color, scale = 128 / state.top;
  let most = 0;
  for (let i = 0; i < source.length; ++i) {
    const value = J[source[i]];
    most = Math.max(most, Math.abs(value));
    const rgb = lut[Math.max(0, Math.min(256, Math.round(128 + scale * value)))];
    colour.array.set(rgb, 3 * i);
  }
  surface.position.needsUpdate = colour.needsUpdate = true;
  surface.body.geometry.computeVertexNormals();
  rope.visible = state.grip !== null;
  if (rope.visible) {
    const ends = rope.geometry.attributes.position, n = state.grip.point;
    ends.array.set([x[3 * n], x[3 * n + 1], x[3 * n + 2], ...state.grip.target.toArray()]);
    ends.needsUpdate = true;
  }
  return most;
}

// ---- the pull

/// Whether WebGL is computed by the processor.
function drawsInSoftware() {
  const gl = el('canvas').getContext('webgl'), info = gl && gl.getExtension('WEBGL_debug_renderer_info');
  const software = Boolean(info) && /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
  if (gl) gl.getExtension('WEBGL_lose_context')?.loseContext();
  return software;
}

/// Draws the panels straight into its own canvas, which is the page's only one.
class LiveViewer extends Viewer {
  constructor() {
    super();
    this.software = drawsInSoftware();
    this.sharpness = 1;   // of the canvas, in pixels of the screen along each direction
    try {
      sharedRenderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: !this.software});
    } catch (error) {
      sharedRenderer = null;
    }
  }

  draw(canvas, size, panels, boxes, pixelRatio, background) {
    const gl = sharedRenderer, ratio = pixelRatio * this.sharpness;
    const [wide, high] = size.map(x => Math.round(x * ratio)), [width, height] = boxes[0].slice(2).map(x => Math.round(x * ratio));
    if (gl.getContext().isContextLost()) return;
    this.light(panels, width / height);
    if (canvas.width !== wide || canvas.height !== high) gl.setSize(wide, high, false);
    gl.setClearColor(background);
    gl.setScissorTest(false);
    gl.clear();
    gl.setScissorTest(true);
    panels.forEach((panel, i) => {
      const box = [Math.round(boxes[i][0] * ratio), high - Math.round(boxes[i][1] * ratio) - height, width, height];
      gl.setViewport(...box);
      gl.setScissor(...box);
      gl.render(panel.scene, this.camera);
    });
  }

  /// The place under the pointer: {point: of the surface, at, panel}; or null.
  hit(event) {
    for (const panel of this.panels) {
      const box = this.viewOf(panel), x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
      if (Math.abs(x) > 1 || Math.abs(y) > 1) continue;
      const ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2(x, y), this.camera);
      panel.surface.body.geometry.computeBoundingSphere();
      const found = ray.intersectObject(panel.surface.body)[0];
      if (!found) return {panel, point: null};
      const distance = i => new THREE.Vector3().fromBufferAttribute(panel.surface.position, i).distanceTo(found.point);
      const nearest = [found.face.a, found.face.b, found.face.c].reduce((best, i) => distance(i) < distance(best) ? i : best);
      return {panel, point: panel.shape.surface.source[nearest], at: found.point};
    }
    return null;
  }

  /// Where the pointer's ray meets the plane through a point that faces the camera.
  onPlane(event, panel, through) {
    const box = this.viewOf(panel), x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(x, y), this.camera);
    const normal = this.camera.getWorldDirection(new THREE.Vector3());
    return ray.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through), new THREE.Vector3());
  }
}

function takeHold(point, at, panel) {
  if (state.fem) reset();
  state.grip = {point, target: at.clone(), start: at.clone(), panel};
  simulation.grab(point);
  simulation.pullTo(state.grip.target.toArray());
}

function pullTo(target) {
  state.grip.target.copy(target);
  simulation.pullTo(target.toArray());
}

function letGo() {
  if (state.grip) simulation.grab(-1);
  state.grip = null;
  viewer.node.classList.remove('pulling');
}

function listen(node) {
  window.addEventListener('resize', () => { viewer.sharpness = 1; viewer.aim(...view); });   // the bodies fit panels of any shape
  node.addEventListener('pointerdown', event => {
    const found = event.button === 0 ? viewer.hit(event) : null;
    viewer.controls.enabled = !(found && found.point !== null);
    if (viewer.controls.enabled) return;
    node.focus({preventScroll: true});
    node.setPointerCapture(event.pointerId);
    node.classList.add('pulling');
    takeHold(found.point, found.at, found.panel);
  }, true);
  node.addEventListener('pointermove', event => {
    if (state.grip && state.grip.panel) {
      const at = viewer.onPlane(event, state.grip.panel, state.grip.start);
      if (at) pullTo(at);
    } else if (event.buttons === 0) {
      const found = viewer.hit(event);
      node.classList.toggle('over', Boolean(found && found.point !== null));
    }
  });
  for (const kind of ['pointerup', 'pointercancel'])
    node.addEventListener(kind, () => { if (state.grip && state.grip.panel) letGo(); viewer.controls.enabled = true; });
  node.addEventListener('keydown', event => {
    const direction = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (event.key === 'Escape') letGo();
    else if (event.key === 'Home') reset();
    else if (direction) pullByKeys(direction);
    else return;
    event.preventDefault();
  });
  for (const kind of ['dragover', 'dragleave', 'drop'])
    document.addEventListener(kind, event => {
      event.preventDefault();
      viewer.node.classList.toggle('dropping', kind === 'dragover');
      if (kind === 'drop' && event.dataTransfer.files[0]) readStl(event.dataTransfer.files[0]);
    });
}

/// Arrow keys take the pulled facets' middle, or the highest point, along the picture's axes.
function pullByKeys([right, up]) {
  const size = boundsOf(simulation.rest).getSize(new THREE.Vector3()).length();
  if (!state.grip) {
    const point = keyPoint(), x = simulation.positions(0);
    takeHold(point, new THREE.Vector3(x[3 * point], x[3 * point + 1], x[3 * point + 2]), null);
  }
  const axes = [0, 1].map(c => new THREE.Vector3().setFromMatrixColumn(viewer.camera.matrixWorld, c));
  pullTo(state.grip.target.clone().addScaledVector(axes[0], 0.05 * size * right).addScaledVector(axes[1], 0.05 * size * up));
  say('pulled by keys');
}

function keyPoint() {
  const {parts, facets} = state.body, pulled = parts ? parts.indexOf(2) : -1;
  if (pulled >= 0) return facets[3 * pulled];
  let highest = 0;
  for (let n = 0; n < simulation.points; ++n) if (simulation.rest[3 * n + 2] > simulation.rest[3 * highest + 2]) highest = n;
  return highest;
}

// ---- time

let last = null, sinceText = 1e9;

function pause(paused) {
  state.paused = paused;
  pauseButton.textContent = paused ? 'Go on' : 'Pause';
  last = null;
}

const runningMean = (old, value) => old === undefined ? value : 0.9 * old + 0.1 * value;

function frame(now) {
  requestAnimationFrame(frame);
  if (state.paused) return;
  const begin = performance.now(), interval = last === null ? 1000 / 60 : now - last, wanted = Math.min(0.05, interval / 1000);
  last = now;
  if (state.rebuild) {
    state.rebuild = false;
    const {body} = state;
    build(() => body.bytes ? simulation.setStl(body.bytes, state.cells) : simulation.setBody(stored(body), state.cells));
  }
  if (state.stale) setModels();
  step(wanted);
  viewer.render();
  const m = state.measured;
  m.frame = runningMean(m.frame, interval);
  m.script = runningMean(m.script, performance.now() - begin);
  sharpen(interval);
}

/// Draws fewer pixels where drawing, not this script, makes frames late: three quarters along each direction, and again,
/// down to a half.
function sharpen(interval) {
  const m = state.measured;
  if (interval > 300) m.frame = undefined, m.frames = 0;   // the page was hidden
  m.frames = (m.frames || 0) + 1;
  if (m.frames < 30 || m.frame < 22 || m.script > m.frame / 2 || viewer.sharpness <= 0.5) return;
  viewer.sharpness = Math.max(0.5, 0.75 * viewer.sharpness);
  m.frames = 0;
}

function step(wanted) {
  let {damping} = state;
  if (state.fem) {
    if (state.loadTime < rampTime) applyLoad();
    damping = Math.max(damping, 1.2 * Math.max(...[0, 1, 2].map(p => simulation.number(p, 'frequency'))));
  }
  const done = simulation.advance(wanted, frameBudget, damping);
  state.loadTime += done.duration;
  const most = Math.max(...panels.map(paint));
  state.top = Math.max(0.02, most, 0.97 * state.top);
  const m = state.measured;
  m.ms = runningMean(m.ms, done.ms);
  m.factor = runningMean(m.factor, done.duration / wanted);
  m.steps = done.steps;
  sinceText += wanted;
  if (sinceText > 0.12) { sinceText = 0; write(); }
}

function write() {
  const m = state.measured;
  for (const {number: p, volume, fem, chip} of panels) {
    volume.textContent = percentText(simulation.number(p, 'volumeChange'), 2);
    const answer = state.fem && state.fem.answer;
    fem.replaceChildren('volume change', ...(answer ? [el('br'), 'FEM ', el('b', {}, percentText(answer.volume_change, 2))] : []));
    chip.hidden = !answer;
    if (!answer) continue;
    const off = differenceOf(p), settled = state.loadTime > rampTime && atRest(p);
    chip.textContent = settled ? `${percent(100 * off)} off` : `${percent(100 * off)} …`;
    chip.className = 'chip off ' + (!settled ? 'none' : off < 0.05 ? 'pass' : off < 0.15 ? 'coarse' : 'fail');
    chip.title = settled ? 'at rest: difference of the displacement from finite elements' : 'not at rest yet';
    panels[p].settled = settled;
    panels[p].off = off;
  }
  if (state.fem && state.fem.answer && !state.fem.told && panels.every(p => p.settled)) {
    state.fem.told = true;
    say('At rest. Off by ' + panels.map(p => `${state.models[p.number]} ${percent(100 * p.off)}`).join(', '));
  }
  bar.show(colourings.volume_change, state.top);
  const slow = m.factor < 0.97, rescues = [0, 1, 2].reduce((sum, p) => sum + simulation.number(p, 'rescues'), 0);
  const facts = [['frames per second', m.frame ? number(1000 / m.frame, 2) : ''], ['springs, of a frame', `${number(m.ms, 2)} ms`],
    ['surfaces and orders to draw', m.script ? `${number(Math.max(0, m.script - m.ms), 2)} ms` : ''],
    ...(viewer.sharpness < 1 ? [['resolution, for speed', `× ${number(viewer.sharpness, 2)}`]] : []),
    ['steps in this frame', m.steps.join(' + ')], ['cubes, nodes', `${number(simulation.cells)}, ${number(simulation.nodes)}`],
    [slow ? 'slow motion' : 'real time', el('span', {class: slow ? 'amber' : ''}, `× ${number(m.factor, 2)}`)],
    ['states taken back', String(rescues)]];
  speed.replaceChildren(...facts.map(([what, value]) => el('div', {}, el('dt', {}, what), el('dd', {}, value))));
}

function say(text) { said.textContent = text; }

// ---- start

springproofLive({wasmBinary: new Uint8Array(bytesOf(document.getElementById('library').textContent))}).then(wasm => {
  simulation = new Simulation(wasm);
  viewer = new LiveViewer();
  viewer.onhover = () => {};
  viewer.node.tabIndex = 0;
  viewer.node.setAttribute('role', 'application');
  viewer.node.setAttribute('aria-label', 'Three soft bodies side by side: springs alone, springs with volume correction, averaged springs. ' +
    'Arrow keys pull them, Escape lets go, Home resets. Their changes of volume are written above each.');
  document.getElementById('stage').append(viewer.node);
  document.getElementById('bar').append(bar.node);
  document.getElementById('choices').append(bodyChoice.node, fileInput, nuSlider.node, el('datalist', {id: 'stored'}),
    el('div', {class: 'buttons'}, compareButton, resetButton, pauseButton),
    el('details', {class: 'more'}, el('summary', {}, 'stiffness, density, damping, number of cubes'),
      el('div', {class: 'choices'}, eSlider.node, densitySlider.node, dampingSlider.node, cellsSlider.node)));
  bodyChoice.value = 'rabbit';
  showBody(pulls.bodies.find(b => b.name === 'rabbit') || pulls.bodies[0]);
  viewer.visible = true;
  viewer.ready();
  listen(viewer.node);
  last = null;
  requestAnimationFrame(frame);
}).catch(error => { hint.textContent = `This browser cannot run the page: ${error.message || error}`; });
