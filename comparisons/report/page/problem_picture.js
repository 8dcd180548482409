'use strict';
// A case at a glance: the body at rest with its supports and loads, finite elements, and the closest model.

const supportColour = 0x5b6b82, loadColour = 0xd55e00, moveColour = 0x7a3fb0;

/// Corners, outward normal and middle of each facet of a body {quads, rest} whose corners are all on a patch.
function patchFacets({quads, rest}, nodes) {
  const on = new Set(nodes), pieces = [];
  const corner = n => new THREE.Vector3().fromArray(rest, 3 * n);
  for (let i = 0; i < quads.length; i += 4) {
    const facet = [...new Set(quads.slice(i, i + 4))];
    if (facet.length < 3 || !facet.every(n => on.has(n))) continue;
    const points = facet.map(corner), last = points[points.length - 1];
    const normal = points[1].clone().sub(points[0]).cross(last.clone().sub(points[0]));
    pieces.push({nodes: facet, normal: normal.normalize(),
                 middle: points.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(points.length)});
  }
  return pieces;
}

/// Up to so many of the pieces, spread over the patch: each the farthest from those before it.
function spreadOut(pieces, most) {
  const chosen = pieces.slice(0, 1), distance = pieces.map(() => Infinity);
  while (chosen.length > 0 && chosen.length < Math.min(most, pieces.length)) {
    const last = chosen[chosen.length - 1].middle;
    pieces.forEach((piece, i) => { distance[i] = Math.min(distance[i], piece.middle.distanceToSquared(last)); });
    chosen.push(pieces[distance.indexOf(Math.max(...distance))]);
  }
  return chosen;
}

function linesOf(points, color) {
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color}));
}

/// A patch as a coloured skin just outside of the body.
function skinOf(pieces, {rest}, size, color) {
  const positions = [];
  const point = (n, normal) => new THREE.Vector3().fromArray(rest, 3 * n).addScaledVector(normal, 0.002 * size);
  for (const {nodes, normal} of pieces)
    for (let i = 1; i + 1 < nodes.length; ++i)
      for (const n of [nodes[0], nodes[i], nodes[i + 1]]) positions.push(...point(n, normal).toArray());
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(positions), 3));
  geometry.computeVertexNormals();
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({color, side: THREE.DoubleSide}));
}

/// The sign of a support: short parallel strokes that leave the body.
function hatching(pieces, size) {
  const points = [], aside = new THREE.Vector3(0.5, 0.35, 0.25);
  for (const {middle, normal} of spreadOut(pieces, 160)) {
    const direction = normal.clone().add(aside.clone().addScaledVector(normal, -aside.dot(normal))).normalize();
    points.push(middle, middle.clone().addScaledVector(direction, 0.07 * size));
  }
  return linesOf(points, supportColour);
}

/// An arrow of a shaft and a cone that ends at a place (`arrives`) or starts there.
function arrow(at, direction, length, color, arrives) {
  const unit = direction.clone().normalize(), from = arrives ? at.clone().addScaledVector(unit, -length) : at;
  const head = Math.min(0.45 * length, 0.32 * length + 1e-12);
  const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), unit);
  const material = new THREE.MeshLambertMaterial({color});
  return [[new THREE.CylinderGeometry(0.04 * length, 0.04 * length, length - head, 10), (length - head) / 2],
          [new THREE.ConeGeometry(0.13 * length, head, 16), length - head / 2]].map(([geometry, along]) => {
    const part = new THREE.Mesh(geometry, material);
    part.quaternion.copy(turn);
    part.position.copy(from).addScaledVector(unit, along);
    return part;
  });
}

/// A place just outside of a box, from its middle along a direction.
function below(box, direction) {
  const unit = direction.clone().normalize(), half = box.getSize(new THREE.Vector3()).divideScalar(2);
  const reach = Math.min(...['x', 'y', 'z'].map(axis => half[axis] / Math.max(Math.abs(unit[axis]), 1e-9)));
  return box.getCenter(new THREE.Vector3()).addScaledVector(unit, 1.15 * reach);
}

/// Objects that show one load or support.
function markObjects(mark, body, box) {
  const size = box.getSize(new THREE.Vector3()), length = Math.max(size.x, size.y, size.z);
  const vector = new THREE.Vector3(...mark.vector);
  const pieces = mark.on ? patchFacets(body, body.patches[mark.on] || []) : [];
  /// Outside of the body, whichever way they point.
  const arrows = (most, scale, color, directionOf) => spreadOut(pieces, most).flatMap(piece =>
    arrow(piece.middle, directionOf(piece), scale * length, color, directionOf(piece).dot(piece.normal) < 0));
  switch (mark.kind) {
    case 'held': return pieces.length === 0 ? [] : [skinOf(pieces, body, length, supportColour), hatching(pieces, length)];
    case 'moved': return pieces.length === 0 ? [] : [skinOf(pieces, body, length, moveColour),
      ...vector.length() > 0 ? arrows(3, 0.2, moveColour, () => vector) : []];
    case 'turned': return pieces.length === 0 ? [] : [skinOf(pieces, body, length, moveColour),
      ...arrows(8, 0.12, moveColour, ({middle: at}) => vector.clone().cross(at.clone().sub(new THREE.Vector3(...mark.at))))];
    case 'force': return pieces.length === 0 ? [] : [skinOf(pieces, body, length, loadColour), ...arrows(4, 0.2, loadColour, () => vector)];
    case 'pressure': return pieces.length === 0 ? [] : [skinOf(pieces, body, length, loadColour),
      ...arrows(14, 0.12, loadColour, ({normal}) => normal.clone().multiplyScalar(-Math.sign(mark.vector[0]) || -1))];
    case 'gravity': return vector.length() > 0 ? arrow(below(box, vector), vector, 0.2 * length, loadColour, false) : [];
    case 'point': return vector.length() > 0 ? arrow(new THREE.Vector3(...mark.at), vector, 0.2 * length, loadColour, true) : [];
    default: return [];
  }
}

/// The model that the answer names, where it has a picture, else the first by its displacement error at this nu and these
/// cells.
function closestAt(result, pictures, nu, cells) {
  const named = closestModels.find(model => pictures.some(p => p.model === model));
  if (named) return named;
  const rows = result.rows.filter(row => row.measure === 'displacement_error' && row.poisson_ratio === nu && !isFem(row.model) &&
    cellsText(row.cells) === cells && isNumber(row.error));
  return rows.length === 0 ? null : rows.reduce((a, b) => Math.abs(b.error) < Math.abs(a.error) ? b : a).model;
}

/// Pictures of a case at the Poisson's ratio nearest to 0.4, of the true surface where there is one: finite elements, the
/// closest model.
function pairOf(result) {
  const {nus, cells, surfaces} = choicesOf(result);
  const nu = nus.reduce((a, b) => Math.abs(b - 0.4) < Math.abs(a - 0.4) ? b : a), at = cellsText(cells(nu)[0]);
  const all = picturesAt(result, {nu: String(nu), cells: at, surface: surfaces(nu, at)[0]});
  const best = closestAt(result, all, nu, at) || all.map(p => p.model).find(model => model !== 'fem');
  return {nu, cells: at, pictures: all.filter(p => p.model === 'fem' || p.model === best)};
}

/// The edges of a panel's triangles, which move with its surface: of the true surface the reference's finest mesh.
function meshOf({shape, surface}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', surface.position);
  geometry.setIndex(new THREE.BufferAttribute(edgesOf(shape.surface.triangles.array, 3), 1));
  const net = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: 0x222222, transparent: true, opacity: 0.55}));
  net.frustumCulled = net.visible = false;
  return net;
}

const markWords = {held: ['held', supportColour], moved: ['moved', moveColour], turned: ['turned', moveColour], force: ['force', loadColour],
                   pressure: ['pressure', loadColour], gravity: ['weight', loadColour], point: ['force', loadColour]};
const cssNumber = color => '#' + color.toString(16).padStart(6, '0');

/// Corners of the box of an object, as xyz triples.
function cornersOf(object) {
  object.updateMatrixWorld();
  const {min, max} = new THREE.Box3().setFromObject(object);
  return [...min.toArray(), ...max.toArray()];
}

/// What the case is and what came of it, in one row of bodies: {node, redraw}; null without pictures.
function problemPicture(result) {
  const file = picturesOf(result);
  if (file.pictures.length === 0) return null;
  const {nu, cells, pictures} = pairOf(result), viewer = new Viewer(), bar = colorBar(), colouring = colourings.difference;
  const panels = makePanels(file, pictures, true), amplification = fittingAmplification(result, panels), marks = file.marks || [];
  const top = paintPanels(panels, colouring, amplification), mesh = file.meshes[pictures[0].mesh], box = boundsOf(panels[0].shape.rest);
  const body = {quads: quadsOf(mesh.quads), rest: floatsOf(mesh.rest), patches: mesh.patches};
  const drawn = marks.flatMap(mark => markObjects(mark, body, box));
  if (drawn.length > 0) panels[0].scene.add(...drawn);
  panels[0].own.push(...drawn);
  panels[0].label.append(el('span', {class: 'model'}, 'The problem'), el('small', {}, distinct(marks.map(mark => mark.kind).filter(kind => markWords[kind])).map(kind =>
    el('span', {class: 'mark'}, el('i', {class: 'swatch', style: {background: cssNumber(markWords[kind][1])}}), markWords[kind][0]))));
  for (const panel of panels.slice(1)) {
    const {title, text} = panelWords(panel, colouring);
    panel.label.append(el('span', {class: 'model'}, panel.picture.model === 'fem' ? '' : swatch(panel.picture.model), title), el('small', {}, text));
  }
  viewer.describe(`${result.name}: ${(result.experiment.loads || []).join('; ')}. ${panelsText(panels.slice(1), colouring)}`);
  viewer.show(panels);
  aimAtPanels(viewer, panels, amplification, drawn.flatMap(cornersOf));
  bar.show(colouring, top);
  const colouringChoice = select('Colour', ['difference', 'von_mises'].filter(key => panels.some(panel => panel.picture && colourings[key].values(panel.shape).length > 0))
    .map(key => [key, `${colourings[key].text} ${colourings[key].symbol}`]), paint);
  const meshBox = el('input', {type: 'checkbox', onchange: paint}), meshed = pictures[0].model === 'fem' && pictures[0].surface === 'smooth';
  const net = meshed ? meshOf(panels[1]) : null;
  if (net) panels[1].scene.add(net), panels[1].own.push(net);
  function paint() {
    const chosen = colourings[colouringChoice.value] || colouring, high = paintPanels(panels, chosen, amplification);
    if (net) net.visible = meshBox.checked;
    for (const panel of panels.slice(1)) panel.label.querySelector('small').textContent = panelWords(panel, chosen).text;
    bar.show(chosen, high);
    viewer.request();
  }
  paint();
  const node = el('div', {class: 'glance'}, el('div', {class: 'choices'}, colouringChoice.node,
      net ? el('label', {class: 'ghost'}, meshBox, 'mesh of the reference') : null), viewer.node, pictures.length > 1 && top > 0 ? bar.node : null,
    el('p', {class: 'note'}, `${settingText(result, nu)}, ${/tets/.test(cells) ? cells : cells + ' cells'}` +
      (amplification === 1 ? ', displacements to scale' : `, displacements drawn ${number(amplification, 3)} times as large`) + '. Drag or use the arrow keys to turn.'));
  return {node, redraw: () => viewer.render()};
}
