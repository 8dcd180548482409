'use strict';
// The deformed surfaces: decoded from the page, and as objects of three.js.

function bytesOf(base64) {
  const text = atob(base64);
  return Uint8Array.from(text, c => c.charCodeAt(0)).buffer;   // typed arrays are little-endian wherever browsers run
}

const floatsOf = base64 => new Float32Array(bytesOf(base64));
/// 16-bit multiples of a scale; -32768 stands for no number.
const shortsOf = ({scale, base64}) => Float32Array.from(new Int16Array(bytesOf(base64)), n => n === -32768 ? NaN : scale * n);
const octetsOf = ({scale, base64}) => Float32Array.from(new Int8Array(bytesOf(base64)), n => n === -128 ? NaN : scale * n);
const quadsOf = ({type, base64}) => type === 'uint16' ? new Uint16Array(bytesOf(base64)) : new Uint32Array(bytesOf(base64));

let pictureFiles = null;

/// The pictures of a case: {meshes, pictures}, parsed on first use.
function picturesOf(result) {
  pictureFiles = pictureFiles || readJson('pictures-data') || [];
  const {name, folder} = result.experiment;
  return pictureFiles.find(entry => entry.case === name && (entry.folder || '') === (folder || '')) ||
    {meshes: [], pictures: []};
}

// ---- surfaces

function trianglesOf(quads) {
  const index = [];
  for (let i = 0; i < quads.length; i += 4) {
    const [a, b, c, d] = [quads[i], quads[i + 1], quads[i + 2], quads[i + 3]];
    index.push(a, b, c);
    if (d !== c) index.push(a, c, d);
  }
  return new Uint32Array(index);
}

/// Facet edges, each once.
function edgesOf(facets, corners = 4) {
  const seen = new Set(), index = [];
  for (let i = 0; i < facets.length; i += corners)
    for (let j = 0; j < corners; ++j) {
      const a = facets[i + j], b = facets[i + (j + 1) % corners];
      const key = a < b ? a * 4294967296 + b : b * 4294967296 + a;
      if (a === b || seen.has(key)) continue;
      seen.add(key);
      index.push(a, b);
    }
  return new Uint32Array(index);
}

const sharpCosine = Math.cos(40 * Math.PI / 180);

/// Unit normals of the triangles at rest.
function normalsOf(rest, triangles) {
  const [a, b, c] = [0, 1, 2].map(() => new THREE.Vector3());
  return Array.from({length: triangles.length / 3}, (_, t) => {
    [a, b, c].forEach((corner, i) => corner.fromArray(rest, 3 * triangles[3 * t + i]));
    return b.sub(a).cross(c.sub(a)).normalize().clone();
  });
}

/// Nodes at sharp edges once per side, so that shading can be smooth elsewhere: {triangles, source: node of each copy}.
function splitAtSharpEdges(rest, triangles) {
  const normals = normalsOf(rest, triangles), copies = new Map(), source = [], index = new Uint32Array(triangles.length);
  triangles.forEach((node, corner) => {
    const normal = normals[Math.floor(corner / 3)];
    const sides = copies.get(node) || copies.set(node, []).get(node);
    let side = sides.find(s => s.normal.dot(normal) > sharpCosine);
    if (!side) {
      sides.push(side = {normal, number: source.length});
      source.push(node);
    }
    index[corner] = side.number;
  });
  return {triangles: index, source};
}

/// xyz triples (or single values) of the source nodes.
function taken(values, source, width) {
  if (values.length === 0) return values;
  const out = new Float32Array(width * source.length);
  source.forEach((node, i) => { for (let c = 0; c < width; ++c) out[width * i + c] = values[width * node + c]; });
  return out;
}

/// What all pictures of one surface share.
function surfaceOf(mesh, smooth) {
  if (mesh.surface) return mesh.surface;
  const rest = floatsOf(mesh.rest), quads = quadsOf(mesh.quads), flat = trianglesOf(quads);
  const {triangles, source} = smooth ? splitAtSharpEdges(rest, flat) : {triangles: flat, source: null};
  mesh.surface = {smooth, source, triangles: new THREE.BufferAttribute(triangles, 1), restOf: values => source ? taken(values, source, 3) : values,
                  edges: smooth ? null : new THREE.BufferAttribute(edgesOf(quads), 1), sharp: sharpEdges(rest, flat)};
  mesh.surface.rest = mesh.surface.restOf(rest);
  return mesh.surface;
}

/// The sharp edges of the undeformed body as a geometry of lines.
function sharpEdges(rest, triangles) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(rest, 3));
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  return new THREE.EdgesGeometry(geometry, 40);
}

function norms(vectors) {
  return Float32Array.from({length: vectors.length / 3}, (_, i) =>
    Math.hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]));
}

/// Displacements of a motion, one array per frame; null: the picture is of one state.
function framesOf({frames}, surface) {
  if (!frames) return null;
  const all = shortsOf(frames.displacement), length = all.length / frames.time.length;
  return frames.time.map((_, i) => surface.restOf(all.slice(i * length, (i + 1) * length)));
}

const decoded = new Map();

/// {surface, rest, displacement, size, difference, volume_change, von_mises}: values per node of the surface as it is drawn.
function decode(file, picture) {
  if (decoded.has(picture)) return decoded.get(picture);
  const surface = surfaceOf(file.meshes[picture.mesh], picture.surface === 'smooth');
  const scalars = packed => !packed ? [] : surface.source ? taken(octetsOf(packed), surface.source, 1) : octetsOf(packed);
  const displacement = surface.restOf(shortsOf(picture.displacement).map(u => Number.isFinite(u) ? u : 0));
  const shape = {surface, rest: surface.rest, displacement, size: norms(displacement), frames: framesOf(picture, surface),
                 difference: scalars(picture.difference), volume_change: scalars(picture.volume_change), von_mises: scalars(picture.von_mises)};
  decoded.set(picture, shape);
  return shape;
}

const largest = values => values.reduce((a, b) => b > a ? b : a, 0);   // NaN is skipped
const largestSize = values => values.reduce((a, b) => Math.abs(b) > a ? Math.abs(b) : a, 0);

function boundsOf(positions) {
  const box = new THREE.Box3();
  box.setFromArray(positions);
  return box;
}

// ---- three.js objects

const mostGhostLines = 2000;

/// The body at rest: its sharp edges, or where these are too many (steps of voxels), or on a round body few, its
/// pale silhouette behind.
function ghostOf(shape) {
  const {smooth, sharp, triangles} = shape.surface, lines = sharp.attributes.position.count / 2;
  if (!smooth && lines > 0 && lines <= mostGhostLines)
    return new THREE.LineSegments(sharp, new THREE.LineBasicMaterial({color: 0x888888, transparent: true, opacity: 0.8}));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(shape.rest, 3));
  geometry.setIndex(triangles);
  const veil = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({side: THREE.DoubleSide, depthWrite: false}));
  veil.renderOrder = -1;   // the body covers it
  veil.onBeforeRender = renderer => veil.material.color.copy(renderer.getClearColor()).lerp(new THREE.Color(0x8090a8), 0.3);
  return veil;
}

/// The deformed surface; paint() sets positions and colours.
function deformedSurface(shape) {
  const {smooth, triangles, edges} = shape.surface;
  const position = new THREE.BufferAttribute(new Float32Array(shape.rest.length), 3);
  const color = new THREE.BufferAttribute(new Float32Array(shape.rest.length), 3);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', position);
  geometry.setAttribute('color', color);
  geometry.setIndex(triangles);
  const body = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({
    vertexColors: THREE.VertexColors, flatShading: !smooth, shininess: 0, specular: 0, side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
  const objects = [body];
  if (edges) {
    const lines = new THREE.BufferGeometry();
    lines.setAttribute('position', position);
    lines.setIndex(edges);
    objects.push(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.22})));
  }
  for (const object of objects) object.frustumCulled = false;
  const place = (amplification, displacement) => {
    for (let i = 0; i < position.array.length; ++i) position.array[i] = shape.rest[i] + amplification * displacement[i];
    position.needsUpdate = true;
    if (smooth) geometry.computeVertexNormals();
  };
  return {body, position, objects, place, paint(amplification, colouring, top) {
    const values = colouring && colouring.values(shape);
    place(amplification, shape.displacement);
    for (let i = 0; i < shape.rest.length / 3; ++i)
      color.array.set(values && isNumber(values[i]) ? colourOf(colouring, values[i], top) : [0.72, 0.72, 0.72], 3 * i);
    color.needsUpdate = true;
    geometry.computeBoundingSphere();   // the pointer's ray looks there first
  }};
}

function litScene(objects) {
  const scene = new THREE.Scene(), lamp = new THREE.DirectionalLight(0xffffff, 0.4);
  scene.add(new THREE.AmbientLight(0xffffff, 0.66), lamp, ...objects);
  return {scene, lamp};
}
