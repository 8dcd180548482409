'use strict';
// Figures on the page, and the same figures on white paper as PNG.

const charts = [];   // functions that draw again, for a change of colours

function redraw() {
  for (const draw of charts) draw();
}

function notice(text) {
  return el('p', {class: 'notice'}, text);
}

/// A canvas with its chart.  draw(drawing) replaces what it shows; a drawing is
/// {name: of a file, caption, notes: [sentence], paperNotes: others where it stands alone, make: () => configuration of a chart}.
function figure() {
  const canvas = el('canvas', {role: 'img'});
  const note = el('p', {class: 'note'});
  let chart = null, shown = null;
  const node = el('div', {class: 'figure'}, el('div', {class: 'canvas'}, canvas),
                  el('div', {class: 'below'}, note, pngButton(() => chartPaper(shown), () => shown.name)));
  function draw(drawing) {
    if (chart) chart.destroy();
    shown = drawing;
    chart = new Chart(canvas, drawing.make());
    canvas.setAttribute('aria-label', drawing.caption + '; the numbers are in the case pages');
    note.replaceChildren(...drawing.notes.map(text => el('span', {}, text)));
  }
  return {node, draw};
}

// ---- paper

const paperScale = 2;        // pixels of a PNG for each of the page
const paperWidth = 1120;
const paperFont = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';

/// Calls `work` with the colours of paper, whatever the reader's theme.
function onPaper(work) {
  const before = document.documentElement.dataset.theme;
  document.documentElement.dataset.theme = 'light';
  try {
    return work();
  } finally {
    if (before === undefined) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = before;
  }
}

function newCanvas(width, height) {
  const canvas = el('canvas', {width: Math.round(width * paperScale), height: Math.round(height * paperScale)});
  const ctx = canvas.getContext('2d', {willReadFrequently: true});   // kept in memory, where its pixels are wanted
  ctx.scale(paperScale, paperScale);
  ctx.fillStyle = '#fff';
  ctx.fillRect(0, 0, width, height);
  ctx.fillStyle = '#1d2430';
  ctx.textBaseline = 'alphabetic';
  return {canvas, ctx};
}

/// Text broken into lines of at most so many pixels.
function wrapped(ctx, text, width) {
  const lines = [''];
  for (const word of text.split(' ')) {
    const longer = lines[lines.length - 1] + (lines[lines.length - 1] ? ' ' : '') + word;
    if (ctx.measureText(longer).width <= width || lines[lines.length - 1] === '') lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/// A picture of the given size on white, its caption above and its notes below.
function paper(picture, width, height, caption, notes) {
  const margin = 18, ruler = newCanvas(1, 1).ctx, below = `13px ${paperFont}`, above = `600 16px ${paperFont}`;
  ruler.font = above;
  const head = wrapped(ruler, caption, width);
  ruler.font = below;
  const foot = notes.flatMap(text => wrapped(ruler, text, width));
  const {canvas, ctx} = newCanvas(width + 2 * margin, height + 2 * margin + 22 * head.length + 18 * foot.length + 14);
  ctx.font = above;
  head.forEach((line, i) => ctx.fillText(line, margin, margin + 14 + 22 * i));
  const top = margin + 22 * head.length + 4;
  ctx.drawImage(picture, margin, top, width, height);
  if (!hasInk(ctx, margin, top, width, height)) throw new Error('nothing was drawn');
  ctx.font = below;
  ctx.fillStyle = '#4a5362';
  foot.forEach((line, i) => ctx.fillText(line, margin, top + height + 22 + 18 * i));
  return canvas;
}

/// The drawing with every curve shown.
const allShown = drawing => ({...drawing, notes: drawing.notes.filter(note => !note.includes('struck out')), make() {
  const configuration = drawing.make();
  for (const dataset of configuration.data.datasets) dataset.hidden = false;
  return configuration;
}});

/// The drawing without the curves that are hidden at first.
const firstShown = drawing => ({...drawing, notes: drawing.notes.filter(note => !note.includes('struck out')), make() {
  const configuration = drawing.make();
  configuration.data.datasets = configuration.data.datasets.filter(dataset => !dataset.hidden);
  return configuration;
}});

/// Sheets one above the other.
function stacked(sheets) {
  const size = sheet => [sheet.width / paperScale, sheet.height / paperScale];
  const {canvas, ctx} = newCanvas(Math.max(...sheets.map(sheet => size(sheet)[0])), sheets.reduce((sum, sheet) => sum + size(sheet)[1], 0));
  let top = 0;
  for (const sheet of sheets) {
    ctx.drawImage(sheet, 0, top, ...size(sheet));
    top += size(sheet)[1];
  }
  return canvas;
}

function chartPaper({caption, notes, paperNotes = notes, make}, height = 480) {
  return onPaper(() => {
    const canvas = el('canvas', {width: paperWidth, height});
    const configuration = make();
    Object.assign(configuration.options, {responsive: false, animation: false, devicePixelRatio: paperScale});
    const chart = new Chart(canvas, configuration);
    const sheet = paper(canvas, paperWidth, height, caption, paperNotes);
    chart.destroy();
    return sheet;
  });
}

// ---- PNG

const fileName = name => name.replace(/[^\w.+-]/g, '_') + '.png';

function pngButton(sheet, name) {
  return el('button', {type: 'button', class: 'png', title: 'Save this figure as PNG, on white', onclick: () =>
    sheet().toBlob(blob => {
      const link = el('a', {href: URL.createObjectURL(blob), download: fileName(name())});
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }, 'image/png')}, 'PNG');
}

/// Whether anything but white is in a box of a sheet.
function hasInk(ctx, left, top, width, height) {
  const box = [left, top, width, height].map(x => Math.round(x * paperScale));
  const pixels = new Uint32Array(ctx.getImageData(...box).data.buffer);
  return pixels.some(pixel => pixel !== 0xffffffff);
}

/// Instead of the page: the drawings of a case, or those with `only` in their name, as <pre data-name>, base64 of a PNG.
/// Failures are reported in <p class="png-failed">.  (springproof pictures)
function writePictures(result, sections, only = '') {
  const drawings = sections.flatMap(section => section.drawings ? section.drawings(result) : []).filter(({name}) => name.includes(only));
  const items = drawings.map(drawing => {
    try {
      const sheet = drawing.sheet ? drawing.sheet() : chartPaper(drawing);
      return el('pre', {class: 'png', 'data-name': fileName(drawing.name)}, sheet.toDataURL('image/png').split(',')[1]);
    } catch (error) {
      return el('p', {class: 'png-failed'}, `${drawing.name}: ${error.message}`);
    }
  });
  document.head.replaceChildren();
  document.body.replaceChildren(...items, el('p', {class: 'png-done'}, String(items.length)));
}
