'use strict';
// A canvas behind a grid of panels, one camera for all of them.

/// The page's only WebGL context, of which browsers allow few: every viewer draws with it, a panel at a time, and copies
/// the picture.  Undefined: none was needed yet; null: there is no WebGL.
let sharedRenderer;

function webGL() {
  if (sharedRenderer !== undefined) return sharedRenderer;
  try {
    sharedRenderer = new THREE.WebGLRenderer({antialias: true});
    sharedRenderer.domElement.addEventListener('webglcontextrestored', redraw);
  } catch (error) {
    sharedRenderer = null;
  }
  return sharedRenderer;
}

class Viewer {
  constructor() {
    this.canvas = el('canvas', {role: 'img', 'aria-label': 'Deformed bodies'});
    this.node = el('div', {class: 'viewer', role: 'group', tabindex: 0,
                           'aria-label': 'Drag or use the arrow keys to turn all bodies together, + and − to zoom'}, this.canvas);
    this.panels = [];
    this.visible = false;
    this.camera = new THREE.PerspectiveCamera(28, 1.25, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.listen();
    new IntersectionObserver(entries => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.request();
    }, {rootMargin: '100px'}).observe(this.node);
    new ResizeObserver(() => this.request()).observe(this.node);
  }

  listen() {
    this.controls = new THREE.OrbitControls(this.camera, this.node);
    this.controls.enableKeys = false;
    this.controls.enableZoom = false;   // until clicked, the wheel scrolls the page
    this.controls.addEventListener('change', () => this.request());
    this.node.addEventListener('pointerdown', () => { this.controls.enableZoom = true; });
    this.node.addEventListener('keydown', event => this.turnByKey(event));
    this.node.addEventListener('pointerleave', () => { this.controls.enableZoom = false; this.onhover(null); });
    this.node.addEventListener('pointermove', event => { if (event.buttons === 0) this.onhover(this.nodeAt(event)); });
  }

  /// Called with the surface node that is pointed at, or null.
  onhover() {}

  /// What the canvas shows, in words.
  describe(text) {
    this.canvas.setAttribute('aria-label', text);
  }

  /// Arrow keys turn the bodies by 10 degrees, + and - bring them nearer.
  turnByKey(event) {
    const step = Math.PI / 18, [across, up, nearer] = {ArrowLeft: [-step, 0, 1], ArrowRight: [step, 0, 1], ArrowUp: [0, step, 1],
      ArrowDown: [0, -step, 1], '+': [0, 0, 0.9], '-': [0, 0, 1 / 0.9]}[event.key] || [];
    if (nearer === undefined) return;
    event.preventDefault();
    const arm = this.camera.position.clone().sub(this.controls.target), radius = nearer * arm.length();
    const longitude = Math.atan2(arm.y, arm.x) + across;
    const latitude = Math.max(-1.5, Math.min(1.5, Math.asin(arm.z / arm.length()) + up));
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(Math.cos(latitude) * Math.cos(longitude),
      Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)).multiplyScalar(radius));
    this.controls.update();
    this.request();
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
    this.node.classList.toggle('few', panels.length <= 4);
    this.node.append(...this.panels.map(panel => panel.node));
    this.request();
  }

  forgetDirection() {
    this.aimed = false;
  }

  /// Looks at points (arrays of xyz) in a box from the front right; keeps the direction if there is one already.
  aim(box, clouds) {
    this.pending = {box, clouds};
    this.request();
  }

  applyAim() {
    if (!this.pending) return;
    const centre = this.pending.box.getCenter(new THREE.Vector3());
    const direction = this.aimed ? this.camera.position.clone().sub(this.controls.target).normalize()
      : new THREE.Vector3(0.62, -1, 0.5).normalize();
    const distance = 1.06 * this.fittingDistance(this.pending.clouds, centre, direction);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 10;
    this.aimed = true;
    this.pending = null;
    this.controls.update();
  }

  /// Distance from `centre`, seen from `direction`, at which every point is inside the panel.
  fittingDistance(clouds, centre, direction) {
    const right = this.camera.up.clone().cross(direction).normalize();
    const up = direction.clone().cross(right);
    const high = Math.tan(Math.PI * this.camera.fov / 360), wide = high * this.camera.aspect;
    let distance = 1e-9;
    const c = new THREE.Vector3();
    for (const points of clouds)
      for (let i = 0; i < points.length; i += 3) {
        c.fromArray(points, i).sub(centre);
        distance = Math.max(distance, c.dot(direction) + Math.max(Math.abs(c.dot(right)) / wide, Math.abs(c.dot(up)) / high));
      }
    return distance;
  }

  request() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.visible) this.render();
    });
  }

  /// Draws the panels on the page.
  render() {
    if (this.panels.length === 0 || !this.ready()) return;
    const frame = this.node.getBoundingClientRect();
    if (frame.width === 0) return;
    const boxes = this.panels.map(panel => {
      const {left, top, width, height} = this.viewOf(panel);
      return [left - frame.left, top - frame.top, width, height];
    });
    this.draw(this.canvas, [frame.width, frame.height], this.panels, boxes, Math.min(2, window.devicePixelRatio || 1), cssColor('--paper'));
  }

  /// The same panels in rows of so many on white, each of the given size with room above.
  snapshot(panels, {columns, width, height, above}) {
    const boxes = panels.map((panel, i) => [i % columns * width, Math.floor(i / columns) * (above + height) + above, width, height]);
    const canvas = el('canvas'), rows = Math.ceil(panels.length / columns);
    if (!this.ready()) throw new Error('WebGL is not there');
    this.draw(canvas, [columns * width, rows * (above + height)], panels, boxes, paperScale, '#ffffff');
    return canvas;
  }

  /// Whether there is WebGL.
  ready() {
    if (webGL()) return true;
    this.node.replaceChildren(notice('The shapes need WebGL, which this browser does not offer.'));
    this.panels = [];
    return false;
  }

  /// Camera and lamps for panels of this width by height.
  light(panels, aspect) {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    this.applyAim();
    const lamp = this.camera.position.clone().sub(this.controls.target).normalize();   // moves with the camera
    lamp.add(new THREE.Vector3(0, 0, 0.6));
    for (const panel of panels) panel.lamp.position.copy(lamp);
  }

  /// Draws panels into boxes (left, top, width, height), all of one size, of a canvas of the given size in pixels of the page.
  draw(canvas, size, panels, boxes, ratio, background) {
    const gl = webGL(), [, , width, height] = boxes[0].map(x => Math.round(x * ratio));
    if (gl.getContext().isContextLost()) return;   // the picture before stays
    this.light(panels, width / height);
    resize(canvas, ...size.map(x => Math.round(x * ratio)));
    if (gl.domElement.width !== width || gl.domElement.height !== height) gl.setSize(width, height, false);
    gl.setClearColor(background);   // opaque: printers paint transparency black
    const ctx = canvas.getContext('2d');
    ctx.fillStyle = background;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    panels.forEach((panel, i) => {
      gl.render(panel.scene, this.camera);
      ctx.drawImage(gl.domElement, Math.round(boxes[i][0] * ratio), Math.round(boxes[i][1] * ratio));
    });
  }
}

function resize(canvas, width, height) {
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
}
