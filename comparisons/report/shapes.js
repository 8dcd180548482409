'use strict';
// Deformed shapes side by side: one WebGL canvas behind a row of panels, one camera for all of them.

// ---- colours (viridis, Smith & van der Walt 2015)

const viridisStops = ('440154 481567 482677 453781 404788 39568c 33638d 2d708e 287d8e 238a8d 1f968b 20a387 29af7f ' +
  '3cbb75 55c667 73d055 95d840 b8de29 dce319 fde725').split(' ')
  .map(hex => [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16) / 255));

/// Red, green, blue in 0..1 of a value in 0..1.
function viridis(value) {
  const t = Math.min(1, Math.max(0, value)) * (viridisStops.length - 1);
  const i = Math.min(viridisStops.length - 2, Math.floor(t));
  return viridisStops[i].map((low, c) => low + (t - i) * (viridisStops[i + 1][c] - low));
}

function viridisCss(value) {
  return `rgb(${viridis(value).map(c => Math.round(255 * c)).join(',')})`;
}

// ---- pictures

function bytesOf(base64) {
  const text = atob(base64);
  return Uint8Array.from(text, c => c.charCodeAt(0)).buffer;   // typed arrays are little-endian wherever browsers run
}

const floatsOf = base64 => new Float32Array(bytesOf(base64));
/// 16-bit multiples of a scale; -32768 stands for no number.
const shortsOf = ({scale, base64}) => Float32Array.from(new Int16Array(bytesOf(base64)), n => n === -32768 ? NaN : scale * n);
const quadsOf = ({type, base64}) => type === 'uint16' ? new Uint16Array(bytesOf(base64)) : new Uint32Array(bytesOf(base64));

let pictureFiles = null;

/// The pictures of a case: {meshes, pictures}, parsed on first use.
function picturesOf(result) {
  pictureFiles = pictureFiles || readJson('pictures-data') || [];
  const {name, folder} = result.experiment;
  return pictureFiles.find(entry => entry.case === name && (entry.folder || '') === (folder || '')) ||
    {meshes: [], pictures: []};
}

const decoded = new Map();

/// Rest positions, displacement, difference and facets of a picture as typed arrays.
function decode(file, picture) {
  if (decoded.has(picture)) return decoded.get(picture);
  const mesh = file.meshes[picture.mesh];
  mesh.decoded = mesh.decoded || {rest: floatsOf(mesh.rest), quads: quadsOf(mesh.quads)};
  const shape = {...mesh.decoded, displacement: shortsOf(picture.displacement).map(u => Number.isFinite(u) ? u : 0),
                 difference: shortsOf(picture.difference)};
  shape.size = norms(shape.displacement);
  decoded.set(picture, shape);
  return shape;
}

function norms(vectors) {
  return Float32Array.from({length: vectors.length / 3}, (_, i) =>
    Math.hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]));
}

const largest = values => values.reduce((a, b) => b > a ? b : a, 0);   // NaN is skipped

function boundsOf(positions) {
  const box = new THREE.Box3();
  box.setFromArray(positions);
  return box;
}

// ---- three.js objects

function triangles(quads) {
  const index = [];
  for (let i = 0; i < quads.length; i += 4) {
    const [a, b, c, d] = quads.slice(i, i + 4);
    index.push(a, b, c);
    if (d !== c) index.push(a, c, d);
  }
  return index;
}

/// Facet edges, each once.
function edgesOf(quads) {
  const seen = new Set(), index = [];
  for (let i = 0; i < quads.length; i += 4)
    for (let j = 0; j < 4; ++j) {
      const a = quads[i + j], b = quads[i + (j + 1) % 4];
      const key = a < b ? a * 4294967296 + b : b * 4294967296 + a;
      if (a === b || seen.has(key)) continue;
      seen.add(key);
      index.push(a, b);
    }
  return index;
}

/// The sharp edges of the undeformed body.
function outline(shape, color) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(shape.rest, 3));
  geometry.setIndex(triangles(shape.quads));
  return new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 40),
                                new THREE.LineBasicMaterial({color, transparent: true, opacity: 0.8}));
}

/// The deformed surface; paint() sets positions and colours.
function deformedSurface(shape) {
  const position = new THREE.BufferAttribute(new Float32Array(shape.rest.length), 3);
  const color = new THREE.BufferAttribute(new Float32Array(shape.rest.length), 3);
  const surface = new THREE.BufferGeometry(), lines = new THREE.BufferGeometry();
  for (const geometry of [surface, lines]) geometry.setAttribute('position', position);
  surface.setAttribute('color', color);
  surface.setIndex(triangles(shape.quads));
  lines.setIndex(edgesOf(shape.quads));
  const body = new THREE.Mesh(surface, new THREE.MeshPhongMaterial({
    vertexColors: THREE.VertexColors, flatShading: true, shininess: 0, specular: 0, side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
  const grid = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.22}));
  body.frustumCulled = grid.frustumCulled = false;
  return {body, position, objects: [body, grid], paint(amplification, values, top) {
    for (let i = 0; i < position.array.length; ++i)
      position.array[i] = shape.rest[i] + amplification * shape.displacement[i];
    for (let i = 0; i < shape.rest.length / 3; ++i)
      color.array.set(values && isNumber(values[i]) ? viridis(top > 0 ? values[i] / top : 0) : [0.72, 0.72, 0.72], 3 * i);
    position.needsUpdate = color.needsUpdate = true;
    surface.computeBoundingSphere();   // the pointer's ray looks there first
  }};
}

function litScene(objects) {
  const scene = new THREE.Scene(), lamp = new THREE.DirectionalLight(0xffffff, 0.4);
  scene.add(new THREE.AmbientLight(0xffffff, 0.66), lamp, ...objects);
  return {scene, lamp};
}

// ---- the viewer: canvas, camera, panels

class Viewer {
  constructor() {
    this.canvas = el('canvas', {'aria-hidden': 'true'});
    this.node = el('div', {class: 'viewer', role: 'img',
                           'aria-label': 'Deformed shapes; drag to turn all of them together'}, this.canvas);
    this.panels = [];
    this.stale = true;
    this.visible = false;
    new IntersectionObserver(entries => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.request();
    }, {rootMargin: '100px'}).observe(this.node);
    new ResizeObserver(() => this.request()).observe(this.node);
  }

  /// The context is made when the viewer is first seen.
  start() {
    if (this.renderer) return;
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.node);
    this.controls.enableKeys = false;
    this.controls.enableZoom = false;   // until clicked: the wheel belongs to the page
    this.controls.addEventListener('change', () => this.request());
    this.node.addEventListener('pointerdown', () => { this.controls.enableZoom = true; });
    this.node.addEventListener('pointerleave', () => { this.controls.enableZoom = false; this.onhover(null); });
    this.node.addEventListener('pointermove', event => { if (event.buttons === 0) this.onhover(this.nodeAt(event)); });
  }

  /// Where a panel's body is drawn: below the label.
  viewOf({node}) {
    const {left, top, width, height} = node.getBoundingClientRect();
    return {left, top: top + 46, width, height: height - 46};
  }

  /// Number of the surface node nearest to the pointer, or null.
  nodeAt({clientX, clientY}) {
    for (const panel of this.panels) {
      const {surface} = panel, box = this.viewOf(panel);
      const x = 2 * (clientX - box.left) / box.width - 1, y = 1 - 2 * (clientY - box.top) / box.height;
      if (Math.abs(x) > 1 || Math.abs(y) > 1) continue;
      const ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2(x, y), this.camera);
      const hit = ray.intersectObject(surface.body)[0];
      if (!hit) return null;
      const {a, b, c} = hit.face;
      const distance = i => new THREE.Vector3().fromBufferAttribute(surface.position, i).distanceTo(hit.point);
      return [a, b, c].reduce((best, i) => distance(i) < distance(best) ? i : best);
    }
    return null;
  }

  /// panels: [{label: Node, scene, lamp, surface}]
  show(panels) {
    for (const panel of this.panels) panel.node.remove();
    this.panels = panels.map(panel => ({...panel, node: el('div', {class: 'panel'}, panel.label)}));
    this.node.append(...this.panels.map(panel => panel.node));
    this.request();
  }

  forgetDirection() {
    this.aimed = false;
  }

  /// Looks at a box from the front right; keeps the direction if there is one already.
  aim(box) {
    this.pending = box;
    this.request();
  }

  applyAim() {
    if (!this.pending) return;
    const centre = this.pending.getCenter(new THREE.Vector3());
    const direction = this.aimed ? this.camera.position.clone().sub(this.controls.target).normalize()
      : new THREE.Vector3(0.62, -1, 0.5).normalize();
    const distance = 1.06 * this.fittingDistance(this.pending, centre, direction);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 10;
    this.aimed = true;
    this.pending = null;
    this.controls.update();
  }

  /// Distance from `centre`, seen from `direction`, at which every corner of the box is inside the panel.
  fittingDistance(box, centre, direction) {
    const right = this.camera.up.clone().cross(direction).normalize();
    const up = direction.clone().cross(right);
    const high = Math.tan(Math.PI * this.camera.fov / 360), wide = high * this.camera.aspect;
    const {min, max} = box;
    const corners = [min.x, max.x].flatMap(x => [min.y, max.y].flatMap(y => [min.z, max.z].map(z =>
      new THREE.Vector3(x, y, z).sub(centre))));
    return Math.max(1e-9, ...corners.map(c => c.dot(direction) +
      Math.max(Math.abs(c.dot(right)) / wide, Math.abs(c.dot(up)) / high)));
  }

  request() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.visible) this.render();
    });
  }

  render() {
    if (this.panels.length === 0) return;
    try {
      this.start();
    } catch (error) {
      this.node.replaceChildren(notice('The shapes need WebGL, which this browser does not offer.'));
      this.panels = [];
      return;
    }
    const frame = this.node.getBoundingClientRect();
    if (frame.width === 0) return;
    const first = this.viewOf(this.panels[0]);
    this.camera.aspect = first.width / first.height;
    this.camera.updateProjectionMatrix();
    this.applyAim();
    this.renderer.setSize(frame.width, frame.height, false);
    this.renderer.setClearColor(cssColor('--paper'));   // opaque: printers paint transparency black
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    const lamp = this.camera.position.clone().sub(this.controls.target).normalize();   // moves with the eye
    lamp.add(new THREE.Vector3(0, 0, 0.6));
    for (const panel of this.panels) {
      const box = this.viewOf(panel);
      const view = [box.left - frame.left, frame.bottom - box.top - box.height, box.width, box.height];
      panel.lamp.position.copy(lamp);
      this.renderer.setViewport(...view);
      this.renderer.setScissor(...view);
      this.renderer.render(panel.scene, this.camera);
    }
  }
}

// ---- the section

/// 1, 2 or 5 times a power of ten, at most x and at least 1.
function roundAmplification(x) {
  if (!(x > 1)) return 1;
  const decade = 10 ** Math.floor(Math.log10(x));
  return decade * (x / decade >= 5 ? 5 : x / decade >= 2 ? 2 : 1);
}

function colorBar() {
  const stops = Array.from({length: 21}, (_, i) => viridisCss(i / 20)).join(', ');
  const ticks = el('div', {class: 'ticks'}), title = el('div', {class: 'bar-title'});
  const node = el('div', {class: 'color-bar'}, title,
                  el('div', {class: 'bar', style: {background: `linear-gradient(to right, ${stops})`}}), ticks);
  return {node, show(text, top) {
    const {factor, unit} = lengthUnit(top);
    title.textContent = `${text} [${unit}]`;
    ticks.replaceChildren(...[0, 0.25, 0.5, 0.75, 1].map(t => el('span', {}, number(t * top * factor, 3))));
  }};
}

function shapesSection(section) {
  const withPictures = allCases.filter(c => picturesOf(c).pictures.length > 0);
  if (withPictures.length === 0) return section.append(notice('No pictures were written in this run.'));
  const viewer = new Viewer(), bar = colorBar();
  const caseChoice = select('Case', withPictures.map(c => [c.id, c.name]), update);
  const nuChoice = select('ν', [], updateCells), cellsChoice = select('Cells', [], updateModels);
  const colorChoice = select('Colour', [['displacement', 'displacement |u|'],
                                        ['difference', 'difference to FEM |u − u_fem|']], paint);
  const slider = el('input', {type: 'range', min: 0, max: 4, step: 0.01, oninput: () => paint(),
                              onchange: () => aimAtAll()});
  const factor = el('output', {});
  const modelBoxes = el('div', {class: 'boxes'});
  let shown = [], wanted = null, hovered = null;

  const result = () => withPictures.find(c => c.id === caseChoice.value);
  const ofNu = () => picturesOf(result()).pictures.filter(p => String(p.poisson_ratio) === nuChoice.value);
  const candidates = () => ofNu().filter(p => cellsText(p.cells) === cellsChoice.value);

  function update() {
    const nus = distinct(picturesOf(result()).pictures.map(p => p.poisson_ratio)).sort((a, b) => a - b);
    const fresh = nuChoice.value === '';
    replaceOptions(nuChoice, nus.map(nu => [String(nu), nuText(nu)]));
    if (fresh) nuChoice.value = String(nus.includes(0.4) ? 0.4 : nus[nus.length >> 1]);
    viewer.newCase = true;
    updateCells();
  }
  function updateCells() {
    replaceOptions(cellsChoice, distinct(ofNu().map(p => p.cells)).sort(bySize).map(c => [cellsText(c), cellsText(c)]));
    updateModels();
  }
  /// FEM first; the boxes hold the choice of at most three models beside it.
  function updateModels() {
    const names = models.filter(model => candidates().some(p => p.model === model));
    const kept = wanted && names.filter(name => wanted.includes(name));
    const chosen = kept && kept.length > 0 ? kept : names.slice(0, 3);
    modelBoxes.replaceChildren(...names.map(name => el('label', {}, el('input', {
      type: 'checkbox', value: name, checked: chosen.includes(name), onchange: chooseModels}), modelName(name))));
    limitBoxes();
    build();
  }
  function chooseModels() {
    wanted = [...modelBoxes.querySelectorAll('input:checked')].map(box => box.value);
    limitBoxes();
    build();
  }
  function limitBoxes() {
    const boxes = [...modelBoxes.querySelectorAll('input')];
    const full = boxes.filter(box => box.checked).length >= 3;
    for (const box of boxes) box.disabled = full && !box.checked;
  }

  function build() {
    const names = ['fem', ...[...modelBoxes.querySelectorAll('input:checked')].map(box => box.value)];
    const file = picturesOf(result());
    for (const entry of shown) for (const object of entry.disposable) { object.geometry.dispose(); object.material.dispose(); }
    shown = names.flatMap(name => candidates().filter(p => p.model === name)).map(picture => {
      const shape = decode(file, picture);
      const surface = deformedSurface(shape), rest = outline(shape, 0x888888);
      return {picture, shape, surface, disposable: [...surface.objects, rest],
              ...litScene([...surface.objects, rest]), label: el('div', {class: 'panel-label'})};
    });
    chooseAmplification();
    viewer.show(shown);
    paint();
    if (viewer.newCase && shown.length > 0) aimAtAll();
    viewer.newCase = false;
  }
  function chooseAmplification() {
    if (!viewer.newCase || shown.length === 0) return;
    const size = boundsOf(shown[0].shape.rest).getSize(new THREE.Vector3());
    const moved = Math.max(...shown.map(s => largest(s.shape.size)));
    const target = 0.15 * Math.max(size.x, size.y, size.z);
    slider.value = Math.log10(result().linear && moved > 0 ? roundAmplification(target / moved) : 1);
  }
  function aimAtAll() {
    const box = boundsOf(shown[0].shape.rest), a = amplification();
    for (const {shape} of shown)
      box.union(boundsOf(shape.rest.map((x, i) => x + a * shape.displacement[i])));
    viewer.aim(box);
  }

  const amplification = () => Number((10 ** Number(slider.value)).toPrecision(3));

  const coloursDifference = () => colorChoice.value === 'difference';
  const valuesShown = () => shown.map(({shape}) => !coloursDifference() ? shape.size
    : shape.difference.length > 0 ? shape.difference : null);

  function paint() {
    const values = valuesShown();
    const top = Math.max(0, ...values.filter(Boolean).map(largest));
    factor.textContent = '×' + number(amplification(), 3);
    shown.forEach((entry, i) => entry.surface.paint(amplification(), values[i], top));
    labels();
    bar.show(coloursDifference() ? 'difference to FEM, |u − u_fem|' : 'displacement, |u|', top);
    viewer.request();
  }
  function label({picture, label: node}, values) {
    const name = picture.model === 'fem' ? el('span', {class: 'model'}, swatch('fem'), 'FEM reference') : modelName(picture.model);
    const at = hovered !== null && values && hovered < values.length;
    node.replaceChildren(name, el('small', {}, !values ? 'the reference itself'
      : at ? `here ${lengthText(values[hovered])}` : `largest ${lengthText(largest(values))}`));
  }
  const lengthText = x => { const {factor: f, unit} = lengthUnit(x); return `${number(x * f, 4)} ${unit}`; };
  viewer.onhover = node => {
    if (node === hovered) return;
    hovered = node;
    labels();
  };
  function labels() {
    const values = valuesShown();
    shown.forEach((entry, i) => label(entry, values[i]));
  }

  viewer.node.addEventListener('dblclick', () => {
    viewer.forgetDirection();
    aimAtAll();
  });
  section.append(
    el('p', {class: 'lead'}, 'Drag to turn all bodies together, click and use the wheel to zoom, point at a spot to read its value in every panel; ' +
       'a double click brings the first view back. Grey lines: the body at rest.'),
    el('div', {class: 'choices'}, caseChoice.node, nuChoice.node, cellsChoice.node, colorChoice.node,
       el('label', {class: 'choice amplification'}, el('span', {}, 'Displacements drawn ', factor), slider)),
    modelBoxes, viewer.node, bar.node);
  update();
  charts.push(() => viewer.render());
  return {
    show(id) { if (withPictures.some(c => c.id === id)) { caseChoice.value = id; update(); } },
    has: id => withPictures.some(c => c.id === id),
  };
}
