'use strict';
// Deformed shapes side by side: one panel per model, the undeformed body first, one camera and one scale.

/// 1, 2 or 5 times a power of ten, at most x and at least 1.
function roundAmplification(x) {
  if (!(x > 1)) return 1;
  const decade = 10 ** Math.floor(Math.log10(x));
  return decade * (x / decade >= 5 ? 5 : x / decade >= 2 ? 2 : 1);
}

const surfaceNames = {smooth: 'the true surface', cells: 'the cells'};
const inUnit = (x, {factor, unit}) => `${number(x * factor, 4)} ${unit}`;
const lengthText = x => inUnit(x, lengthUnit(Math.abs(x)));
const valueText = (colouring, x) => colouring.signed ? `${signed(x, number(100 * x, 3))} %` : inUnit(x, colouringUnit(colouring, Math.abs(x)));

/// Pictures of one row of panels, FEM first.
function picturesAt(result, {nu, cells, surface}) {
  const pictures = picturesOf(result).pictures.filter(p => String(p.poisson_ratio) === nu && cellsText(p.cells) === cells &&
    (p.surface || 'cells') === surface);
  return ['fem', ...models].flatMap(name => pictures.filter(p => p.model === name));
}

/// Choices that pictures offer: every nu, its cells, their surfaces (the smooth one first).
function choicesOf(result) {
  const {pictures} = picturesOf(result);
  const nus = distinct(pictures.map(p => p.poisson_ratio)).sort((a, b) => a - b);
  const at = nu => pictures.filter(p => String(p.poisson_ratio) === String(nu));
  return {nus, cells: nu => distinct(at(nu).map(p => p.cells)).sort(bySize),
          surfaces: (nu, cells) => Object.keys(surfaceNames).filter(s => at(nu).some(p =>
            (p.surface || 'cells') === s && cellsText(p.cells) === cells))};
}

/// Panels of pictures, the first one the body at rest.
function makePanels(file, pictures, ghost) {
  const panel = (picture, shape, rest) => {
    const surface = deformedSurface(shape), own = [...surface.objects, ...(ghost && !rest ? [ghostOf(shape)] : [])];
    return {picture, shape, surface, rest, own, ...litScene(own), label: el('div', {class: 'panel-label'})};
  };
  const made = pictures.map(picture => panel(picture, decode(file, picture), false));
  return made.length === 0 ? [] : [panel(null, made[0].shape, true), ...made];
}

function dispose(panels) {
  for (const {own} of panels) for (const object of own) { object.geometry.dispose(); object.material.dispose(); }
}

/// Positions and colours; returns the value at the end of the colour bar.
function paintPanels(panels, colouring, amplification) {
  const size = colouring.signed ? largestSize : largest;
  const top = Math.max(0, ...panels.map(({shape}) => size(colouring.values(shape))));
  for (const {surface, rest} of panels) surface.paint(rest ? 0 : amplification, rest ? null : colouring, top);
  return top;
}

/// Points the viewer at all bodies as drawn, and at rest, and at other points (xyz triples).
function aimAtPanels(viewer, panels, amplification, others = []) {
  const clouds = [others, panels[0].shape.rest, ...panels.map(({shape}) => shape.rest.map((x, i) => x + amplification * shape.displacement[i]))];
  const box = boundsOf(clouds[1]);
  for (const points of clouds.slice(1)) box.union(boundsOf(points));
  viewer.aim(box, clouds);
}

/// Drawn displacements of about a seventh of the body where strains are small; large ones as they are.
function fittingAmplification(result, panels) {
  const size = boundsOf(panels[0].shape.rest).getSize(new THREE.Vector3());
  const moved = Math.max(...panels.map(({shape}) => largest(shape.size)));
  return result.linear && moved > 0 ? roundAmplification(0.15 * Math.max(size.x, size.y, size.z) / moved) : 1;
}

/// Title and second line of a panel's label; `node` is the surface node pointed at, or null.
function panelWords({picture, shape, rest}, colouring, node = null) {
  if (rest) return {title: 'undeformed', text: 'the body at rest'};
  const values = colouring.values(shape), title = picture.model === 'fem' ? 'FEM reference' : picture.model;
  if (values.length === 0) return {title, text: picture.model === 'fem' ? 'the reference itself' : 'no value'};
  if (node !== null && node < values.length) return {title, text: `here ${valueText(colouring, values[node])}`};
  if (!colouring.signed) {
    const top = largest(values), at = values.indexOf(top), where = shape.rest.slice(3 * at, 3 * at + 3);
    return {title, text: `largest ${valueText(colouring, top)}` + (colouring.unitOf ? ` at (${[...where].map(x => number(x, 3)).join(', ')}) m` : '')};
  }
  const low = values.reduce((a, b) => b < a ? b : a, Infinity), high = values.reduce((a, b) => b > a ? b : a, -Infinity);
  return {title, text: `${valueText(colouring, low)} to ${valueText(colouring, high)}`};
}

/// What panels show, in words.
const panelsText = (panels, colouring) => panels.map(panel => {
  const {title, text} = panelWords(panel, colouring);
  return `${title}: ${text}.`;
}).join(' ');

function shapesCaption(result, {nu, cells, surface}) {
  return `${result.name}: deformed shapes, ${settingText(result, Number(nu))}, ${/tets/.test(cells) ? cells : cells + ' cells'}` +
    (surface === 'smooth' ? ', the true surface carried along' : '');
}

function shapesNotes(colouring, amplification, ghost) {
  const drawn = amplification === 1 ? 'Displacements are drawn to scale.'
    : `Displacements are drawn ${number(amplification, 3)} times as large as they are.`;
  return [`${drawn} All bodies: one scale, one camera.` + (ghost ? ' Grey: the body at rest.' : '')];
}

/// Shows the frames of panels, twenty a second, again and again; models without a motion stay as they are.
/// Returns what stops it.
function playFrames(viewer, framed, amplification, clock) {
  let number = 0;
  const timer = setInterval(() => {
    const moving = framed(), {time} = moving[0].picture.frames, i = number++ % time.length;
    for (const {surface, shape} of moving) surface.place(amplification(), shape.frames[Math.min(i, shape.frames.length - 1)]);
    clock.textContent = ` t = ${time[i].toPrecision(3)} s`;
    viewer.request();
  }, 50);
  return () => clearInterval(timer);
}

// ---- paper

/// Panels with their labels, and the colour bar, on one sheet.
function shapesSheet(viewer, panels, colouring, top, caption, notes, aspect) {
  const columns = panels.length <= 4 ? panels.length : Math.min(5, Math.ceil(Math.sqrt(1.4 * panels.length)));
  const rows = Math.ceil(panels.length / columns), label = 42;
  const width = Math.max(300, Math.min(420, Math.floor(paperWidth / columns))), height = Math.round(width / aspect);
  const total = {width: columns * width, height: rows * (height + label) + 66};
  const {canvas, ctx} = newCanvas(total.width, total.height);
  ctx.drawImage(viewer.snapshot(panels, {columns, width, height, above: label}), 0, 0, columns * width, rows * (height + label));
  panels.forEach((panel, i) => {
    const left = i % columns * width, y = Math.floor(i / columns) * (height + label), words = panelWords(panel, colouring);
    if (!hasInk(ctx, left, y + label, width, height)) throw new Error(`nothing was drawn for ${words.title}`);
    ctx.fillStyle = '#1d2430';
    ctx.font = `600 14px ${paperFont}`;
    ctx.fillText(words.title, left + 8, y + 16);
    ctx.fillStyle = '#4a5362';
    ctx.font = `13px ${paperFont}`;
    ctx.fillText(words.text, left + 8, y + 34);
  });
  const bar = Math.min(560, total.width - 40);
  drawColorBar(ctx, (total.width - bar) / 2, total.height - 54, bar, colouring, top);
  return paper(canvas, total.width, total.height, caption, notes);
}

function* everyView(result) {
  const choices = choicesOf(result);
  for (const nu of choices.nus)
    for (const cells of choices.cells(nu).map(cellsText))
      for (const surface of choices.surfaces(nu, cells)) yield {nu: String(nu), cells, surface};
}

/// Every view in every colouring that has values, seen from the front right.
function shapesDrawings(result) {
  const viewer = new Viewer(), file = picturesOf(result), several = distinct(file.pictures.map(p => cellsText(p.cells))).length > 1;
  const drawings = [];
  for (const view of everyView(result)) {
    let panels = null;   // made with the first colouring, dropped after the last
    const make = () => panels = panels || makePanels(file, picturesAt(result, view), true);
    const named = Object.entries(colourings).filter(([, c]) => picturesAt(result, view).some(p => c.values(decode(file, p)).length > 0));
    named.forEach(([key, colouring], i) => drawings.push({
      name: [result.key, 'shapes', key, ...(view.surface === 'cells' ? [] : [view.surface]), ...(several ? [view.cells.replace(/×/g, 'x')] : []),
             'nu' + nuDigits(Number(view.nu))].join('-'),
      sheet() {
        const amplification = fittingAmplification(result, make()), top = paintPanels(panels, colouring, amplification);
        viewer.forgetDirection();
        aimAtPanels(viewer, panels, amplification);
        const sheet = shapesSheet(viewer, panels, colouring, top, shapesCaption(result, view), shapesNotes(colouring, amplification, true), 1.25);
        if (i === named.length - 1) {
          dispose(panels);
          panels = null;
        }
        return sheet;
      }}));
  }
  return drawings;
}

// ---- the section

function shapesSection(section) {
  const withPictures = allCases.filter(c => picturesOf(c).pictures.length > 0);
  if (withPictures.length === 0) return leaveOut(section);
  const viewer = new Viewer(), bar = colorBar(), caption = el('p', {class: 'caption'});
  const caseChoice = select('Case', withPictures.map(c => [c.id, c.name]), update);
  const nuChoice = select('ν', [], updateCells), cellsChoice = select('Cells', [], updateSurfaces);
  const surfaceChoice = select('Surface', [], updateModels);
  const colorChoice = select('Colour', Object.entries(colourings).map(([key, {text, symbol}]) => [key, `${text} ${symbol}`]), paint);
  const ghostBox = el('input', {type: 'checkbox', checked: true, onchange: build});
  const slider = el('input', {type: 'range', min: 0, max: 4, step: 0.01, oninput: () => paint(), onchange: () => aimAtAll()});
  const playButton = el('button', {type: 'button', class: 'play', onclick: () => playing ? stop() : play()}, 'Play the motion');
  const clock = el('output', {});
  let playing = null;
  const factor = el('output', {}), modelBoxes = el('div', {class: 'boxes'}), left = new Set();   // models taken out
  let panels = [], hovered = null, top = 0;

  const result = () => withPictures.find(c => c.id === caseChoice.value);
  const view = () => ({nu: nuChoice.value, cells: cellsChoice.value, surface: surfaceChoice.value});
  const colouring = () => colourings[colorChoice.value];
  const amplification = () => Number((10 ** Number(slider.value)).toPrecision(3));

  function update() {
    const {nus} = choicesOf(result()), fresh = nuChoice.value === '';
    replaceOptions(nuChoice, nus.map(nu => [String(nu), settingOption(result(), nu)]));
    if (fresh) nuChoice.value = String(nus.includes(0.4) ? 0.4 : nus[nus.length >> 1]);
    viewer.newCase = true;
    updateCells();
  }
  function updateCells() {
    replaceOptions(cellsChoice, choicesOf(result()).cells(nuChoice.value).map(c => [cellsText(c), cellsText(c)]));
    updateSurfaces();
  }
  function updateSurfaces() {
    const surfaces = choicesOf(result()).surfaces(nuChoice.value, cellsChoice.value);
    if (viewer.newCase) surfaceChoice.box.replaceChildren();   // the smooth one first
    replaceOptions(surfaceChoice, surfaces.map(s => [s, surfaceNames[s]]));
    updateModels();
  }
  function updateModels() {
    const names = picturesAt(result(), view()).map(p => p.model);
    modelBoxes.replaceChildren(...names.map(name => el('label', {}, el('input', {type: 'checkbox', checked: !left.has(name), onchange: event => {
      event.target.checked ? left.delete(name) : left.add(name);
      build();
    }}), name === 'fem' ? el('span', {class: 'model'}, swatch('fem'), 'FEM reference') : modelName(name))));
    build();
  }
  const framed = () => panels.filter(panel => !panel.rest && panel.shape.frames);
  function play() {
    if (framed().length === 0) return;
    playButton.textContent = 'Stop';
    playing = playFrames(viewer, framed, amplification, clock);
  }
  function stop() {
    playing();
    playing = null;
    playButton.textContent = 'Play the motion';
    clock.textContent = '';
    paint();
  }
  function build() {
    if (playing) stop();
    dispose(panels);
    const pictures = picturesAt(result(), view());
    const chosen = pictures.filter(p => !left.has(p.model));
    panels = makePanels(picturesOf(result()), chosen.length > 0 ? chosen : pictures.slice(0, 1), ghostBox.checked);
    if (viewer.newCase && panels.length > 0) slider.value = Math.log10(fittingAmplification(result(), panels));
    viewer.show(panels);
    paint();
    if (viewer.newCase && panels.length > 0) aimAtAll();
    viewer.newCase = false;
    playButton.parentNode.hidden = framed().length === 0;
  }
  function aimAtAll() {
    aimAtPanels(viewer, panels, amplification());
  }
  function paint() {
    top = paintPanels(panels, colouring(), amplification());
    factor.textContent = '×' + number(amplification(), 3);
    caption.textContent = [shapesCaption(result(), view()) + '.', ...shapesNotes(colouring(), amplification(), ghostBox.checked)].join(' ');
    labels();
    bar.show(colouring(), top);
    viewer.request();
  }
  function labels() {
    for (const panel of panels) {
      const {title, text} = panelWords(panel, colouring(), hovered);
      const name = panel.rest ? title : el('span', {class: 'model'}, swatch(panel.picture.model), title);
      panel.label.replaceChildren(name, el('small', {}, text));
    }
    viewer.describe(`${shapesCaption(result(), view())}: ${panelsText(panels, colouring())}`);
  }
  viewer.onhover = node => {
    if (node === hovered) return;
    hovered = node;
    labels();
  };
  viewer.node.addEventListener('dblclick', () => {
    viewer.forgetDirection();
    aimAtAll();
  });
  const png = pngButton(() => shapesSheet(viewer, panels, colouring(), top, shapesCaption(result(), view()),
    shapesNotes(colouring(), amplification(), ghostBox.checked), viewer.camera.aspect),
    () => `${result().key}-shapes-${colorChoice.value}-nu${nuDigits(Number(nuChoice.value))}`);
  section.append(
    el('p', {class: 'lead'}, 'Drag to turn all bodies together, click and use the wheel to zoom, point at a spot to read its value in every panel; ' +
       'a double click brings the first view back.'),
    el('div', {class: 'choices'}, caseChoice.node, nuChoice.node, cellsChoice.node, surfaceChoice.node, colorChoice.node,
       el('label', {class: 'choice amplification'}, el('span', {}, 'Displacements drawn ', factor), slider),
       el('label', {class: 'ghost'}, ghostBox, 'body at rest'), el('span', {}, playButton, clock)),
    modelBoxes, viewer.node, bar.node, el('div', {class: 'below'}, caption, png));
  update();
  charts.push(() => viewer.render());
  return {
    show(id) { if (withPictures.some(c => c.id === id)) { caseChoice.value = id; update(); } },
    has: id => withPictures.some(c => c.id === id),
    drawings: shapesDrawings,
  };
}
