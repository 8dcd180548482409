'use strict';
// Colour maps: viridis (Smith & van der Walt 2015) for sizes, blue to red through grey (Moreland 2009) for signed values.

const stopsOf = text => text.split(' ').map(hex => [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16) / 255));

const viridisStops = stopsOf('440154 481567 482677 453781 404788 39568c 33638d 2d708e 287d8e 238a8d 1f968b 20a387 29af7f ' +
  '3cbb75 55c667 73d055 95d840 b8de29 dce319 fde725');
const coolWarmStops = stopsOf('3b4cc0 5a78e4 7b9ff9 9ebeff c0d4f5 dddddd f2cbb7 f7ac8e ee8468 d65244 b40426');

/// Red, green, blue in 0..1 of a value in 0..1.
function colorAt(stops, value) {
  const t = Math.min(1, Math.max(0, value)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(t));
  return stops[i].map((low, c) => low + (t - i) * (stops[i + 1][c] - low));
}

const cssOf = color => `rgb(${color.map(c => Math.round(255 * c)).join(',')})`;
const viridisCss = value => cssOf(colorAt(viridisStops, value));

/// What a body can be coloured by: values(shape) per node, or null; signed values lie about zero.
const colourings = {
  displacement: {text: 'displacement', symbol: '|u|', stops: viridisStops, values: shape => shape.size},
  difference: {text: 'difference to FEM', symbol: '|u − u_fem|', stops: viridisStops, values: shape => shape.difference},
  von_mises: {text: 'von Mises stress', symbol: 'σ', unitOf: stressUnit, stops: viridisStops, values: shape => shape.von_mises},
  volume_change: {text: 'volume change', symbol: 'V′/V − 1', stops: coolWarmStops, signed: true, values: shape => shape.volume_change},
};

/// The unit that a colouring's values are shown in.
const colouringUnit = (colouring, top) => colouring.signed ? {factor: 100, unit: '%'} : (colouring.unitOf || lengthUnit)(top);
const colouringTitle = (colouring, top) => `${colouring.text} ${colouring.symbol} [${colouringUnit(colouring, top).unit}]`;

/// Numbers along the colour bar.
function colouringTicks(colouring, top) {
  const {factor} = colouringUnit(colouring, top);
  return [0, 0.25, 0.5, 0.75, 1].map(t => number((colouring.signed ? 2 * t - 1 : t) * top * factor, 3));
}

const colourOf = (colouring, value, top) => colorAt(colouring.stops, top > 0 ? (colouring.signed ? 0.5 + 0.5 * value / top : value / top)
  : colouring.signed ? 0.5 : 0);

/// The colour bar on the page.
function colorBar() {
  const ticks = el('div', {class: 'ticks'}), title = el('div', {class: 'bar-title'}), bar = el('div', {class: 'bar'});
  const node = el('div', {class: 'color-bar'}, title, bar, ticks);
  return {node, show(colouring, top) {
    const stops = Array.from({length: 21}, (_, i) => cssOf(colorAt(colouring.stops, i / 20)));
    bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    title.textContent = colouringTitle(colouring, top);
    ticks.replaceChildren(...colouringTicks(colouring, top).map(text => el('span', {}, text)));
  }};
}

/// The colour bar on paper, in a box of the given width.
function drawColorBar(ctx, left, top, width, colouring, largestValue) {
  const gradient = ctx.createLinearGradient(left, 0, left + width, 0);
  for (let i = 0; i <= 20; ++i) gradient.addColorStop(i / 20, cssOf(colorAt(colouring.stops, i / 20)));
  ctx.font = `13px ${paperFont}`;
  ctx.fillStyle = '#1d2430';
  ctx.textAlign = 'center';
  ctx.fillText(colouringTitle(colouring, largestValue), left + width / 2, top + 12);
  ctx.fillStyle = gradient;
  ctx.fillRect(left, top + 20, width, 14);
  ctx.fillStyle = '#1d2430';
  colouringTicks(colouring, largestValue).forEach((text, i) => {
    ctx.textAlign = i === 0 ? 'left' : i === 4 ? 'right' : 'center';
    ctx.fillText(text, left + width * i / 4, top + 50);
  });
  ctx.textAlign = 'left';
}
