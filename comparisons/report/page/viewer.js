'use strict';
// One WebGL canvas behind a grid of panels, one camera for all of them.

class Viewer {
  constructor() {
    this.canvas = el('canvas', {'aria-hidden': 'true'});
    this.node = el('div', {class: 'viewer', role: 'img', tabindex: 0,
                           'aria-label': 'Deformed shapes; drag or use the arrow keys to turn all of them together'}, this.canvas);
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
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.node);
    this.controls.enableKeys = false;
    this.controls.enableZoom = false;   // until clicked, the wheel scrolls the page
    this.controls.addEventListener('change', () => this.request());
    this.node.addEventListener('pointerdown', () => { this.controls.enableZoom = true; });
    this.node.addEventListener('keydown', event => this.turnByKey(event));
    this.node.addEventListener('pointerleave', () => { this.controls.enableZoom = false; this.onhover(null); });
    this.node.addEventListener('pointermove', event => { if (event.buttons === 0) this.onhover(this.nodeAt(event)); });
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
    const views = this.panels.map(panel => {
      const {left, top, width, height} = this.viewOf(panel);
      return {panel, box: [left - frame.left, frame.bottom - top - height, width, height]};
    });
    this.draw(views, frame.width, frame.height, Math.min(2, window.devicePixelRatio || 1), cssColor('--paper'));
  }

  /// The same panels in rows of so many on white, each of the given size with room above: the canvas, good until the next
  /// drawing.
  snapshot(panels, {columns, width, height, above}) {
    const rows = Math.ceil(panels.length / columns);
    const views = panels.map((panel, i) =>
      ({panel, box: [i % columns * width, (rows - 1 - Math.floor(i / columns)) * (above + height), width, height]}));
    if (!this.ready()) throw new Error('WebGL is not there');
    this.draw(views, columns * width, rows * (above + height), paperScale, '#ffffff');
    this.request();
    return this.canvas;
  }

  /// Whether there is WebGL.
  ready() {
    try {
      this.start();
      return true;
    } catch (error) {
      this.node.replaceChildren(notice('The shapes need WebGL, which this browser does not offer.'));
      this.panels = [];
      return false;
    }
  }

  /// views: [{panel, box: left, bottom, width, height}], all with one camera.
  draw(views, width, height, ratio, background) {
    const [, , first, second] = views[0].box;
    this.camera.aspect = first / second;
    this.camera.updateProjectionMatrix();
    this.applyAim();
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.renderer.setClearColor(background);   // opaque: printers paint transparency black
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    const lamp = this.camera.position.clone().sub(this.controls.target).normalize();   // moves with the camera
    lamp.add(new THREE.Vector3(0, 0, 0.6));
    for (const {panel, box} of views) {
      panel.lamp.position.copy(lamp);
      this.renderer.setViewport(...box);
      this.renderer.setScissor(...box);
      this.renderer.render(panel.scene, this.camera);
    }
  }
}
