'use strict';
// Error against cost: every model and finite element of the cases whose runs were timed for it (cost = true).

const costCases = cases.filter(result => result.experiment.cost);

/// Cost measures of a run: of(run) > 0.
const costs = {
  time: {text: 'set-up and solve', axis: 'CPU time of set-up and solve [s]', of: run => run.set_up_seconds + run.seconds},
  solve: {text: 'solve alone', axis: 'CPU time of the solve [s]', of: run => run.seconds},
  unknowns: {text: 'unknowns', axis: 'unknowns', of: run => run.unknowns},
  memory: {text: 'memory', axis: 'memory [MiB]', of: run => run.memory_MiB},
};

// ---- points, lines and fronts

/// What is drawn, one row of panels each: displacements, beside them the reactions where a support is moved, and volume changes where
/// they are measured.
const costRows = costCases.flatMap(result => ['displacement_error', 'reaction_error', 'volume_change']
  .filter(measure => result.rows.some(row => row.measure === measure && isNumber(row.error))).map(measure => ({result, measure})));

/// The runs of one case at one Poisson's ratio [{model, x, y (at least the uncertainty), error, below, row, run}].
function costPoints({result, measure}, nu, cost) {
  return result.rows.filter(row => row.measure === measure && row.poisson_ratio === nu && isNumber(row.error)).map(row => {
    const run = findRun(result, row), error = Math.abs(row.error), uncertainty = row.reference_uncertainty ?? 0;
    return {model: row.model, x: run ? cost.of(run) : 0, y: Math.max(error, uncertainty), error, below: error <= uncertainty, row, run};
  }).filter(point => point.x > 0 && point.y > 0);
}

const costLine = (points, model) => points.filter(point => point.model === model).sort((a, b) => cellCount(a.row.cells) - cellCount(b.row.cells));

/// The Pareto front: points that no other beats in both, in order of cost.
function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
    if (front.length === 0 || point.y < front[front.length - 1].y) front.push(point);
  return front;
}

/// Cost on a model's line from which on the error is at most this: {x, unknowns}, null where the line ends above.
function costToReach(line, level) {
  const first = line.findIndex((_, i) => line.slice(i).every(point => point.y <= level));
  if (first < 0) return null;
  const b = line[first], a = line[first - 1];
  const reached = line.slice(first).map(point => ({x: point.x, unknowns: point.run.unknowns}));
  if (a) {
    const t = Math.log(a.y / level) / Math.log(a.y / b.y), between = (from, to) => from * (to / from) ** t;
    reached.push({x: between(a.x, b.x), unknowns: between(a.run.unknowns, b.run.unknowns)});
  }
  return reached.reduce((best, entry) => entry.x < best.x ? entry : best);
}

// ---- drawing

const panelHeight = 236, panelGap = 14, costMargins = {left: 62, right: 8, top: 28, bottom: 46, legend: 58};
const panelTitle = ({result, measure, nu}) => `${result.name}, ${shortNames[measure]}, ${settingText(result, nu)}`;
const costModels = () => models.filter(model =>
  costRows.some(row => costNus().some(nu => costPoints(row, nu, costs.unknowns).some(point => point.model === model))));
const costNus = () => distinct(costCases.flatMap(c => c.nus)).sort((a, b) => a - b);

/// One box per case and Poisson's ratio, with the axes that all share in x, and each row in y.
function costPanels(cost, width) {
  const nus = costNus(), {left, right, top, legend} = costMargins;
  const rows = costRows.map(row => nus.map(nu => costPoints(row, nu, cost)));
  const x = decadeRange(rows.flat(2).map(point => point.x));
  const panelWidth = (width - left - right - panelGap * (nus.length - 1)) / nus.length;
  return costRows.flatMap((row, i) => {
    const y = decadeRange(rows[i].flat().map(point => 100 * point.y));
    return nus.map((nu, j) => ({...row, nu, points: rows[i][j], x, y, first: j === 0, last: i === costRows.length - 1,
      box: {left: left + j * (panelWidth + panelGap), top: legend + i * (panelHeight + panelGap + top) + top, width: panelWidth, height: panelHeight}}));
  });
}

/// A little more than the values, not whole decades: space is scarce in a small figure.
function decadeRange(values) {
  const low = Math.min(...values), high = Math.max(...values);
  return {min: low / 1.4, max: high * 1.4};
}

const costHeight = () => costMargins.legend + costRows.length * (panelHeight + panelGap + costMargins.top) - panelGap + costMargins.bottom;

const along = ({min, max}, value) => Math.log(value / min) / Math.log(max / min);
const placeOf = ({box, x, y}, point) => [box.left + box.width * along(x, point.x), box.top + box.height * (1 - along(y, 100 * point.y))];

function ticksIn({min, max}) {
  const ticks = [];
  for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); ++e)
    for (const digit of [1, 2, 3, 4, 5, 6, 7, 8, 9]) {
      const value = digit * 10 ** e;
      if (value >= min && value <= max) ticks.push({value, major: digit === 1, named: digit === 1 || (max / min < 60 && digit === 3)});
    }
  return ticks;
}

const tickText = value => value >= 1e4 ? '10' + superscript(Math.round(Math.log10(value))) : String(Number(value.toPrecision(1)));

function drawAxes(ctx, panel, cost) {
  const {box, x, y, first, last} = panel, {ink, soft, grid} = colors();
  ctx.lineWidth = 1;
  ctx.font = `12px ${paperFont}`;
  for (const {value, major, named} of ticksIn(x)) {
    const at = Math.round(box.left + box.width * along(x, value)) + 0.5;
    ctx.strokeStyle = grid;
    if (major) strokePath(ctx, [[at, box.top], [at, box.top + box.height]]);
    ctx.strokeStyle = soft;
    strokePath(ctx, [[at, box.top + box.height], [at, box.top + box.height - (major ? 6 : 3)]]);
    ctx.fillStyle = ink;
    ctx.textAlign = 'center';
    if (last && named) ctx.fillText(tickText(value), at, box.top + box.height + 16);
  }
  for (const {value, major, named} of ticksIn(y)) {
    const at = Math.round(box.top + box.height * (1 - along(y, value))) + 0.5;
    ctx.strokeStyle = grid;
    if (major) strokePath(ctx, [[box.left, at], [box.left + box.width, at]]);
    ctx.strokeStyle = soft;
    strokePath(ctx, [[box.left, at], [box.left + (major ? 6 : 3), at]]);
    ctx.fillStyle = ink;
    ctx.textAlign = 'right';
    if (first && named) ctx.fillText(tickText(value) + ' %', box.left - 6, at + 4);
  }
  ctx.strokeStyle = soft;
  ctx.strokeRect(Math.round(box.left) + 0.5, Math.round(box.top) + 0.5, Math.round(box.width), Math.round(box.height));
  ctx.fillStyle = ink;
  ctx.textAlign = 'left';
  ctx.font = `600 13px ${paperFont}`;
  ctx.fillText(panelTitle(panel), box.left, box.top - 8);
  ctx.font = `13px ${paperFont}`;
  ctx.textAlign = 'center';
  if (last) ctx.fillText(cost.axis, box.left + box.width / 2, box.top + box.height + 36);
}

function strokePath(ctx, points) {
  ctx.beginPath();
  points.forEach(([x, y], i) => i === 0 ? ctx.moveTo(x, y) : ctx.lineTo(x, y));
  ctx.stroke();
}

/// Shades errors below the uncertainty of the reference.
function drawDoubt(ctx, panel) {
  const doubt = Math.max(0, ...panel.points.map(point => point.row.reference_uncertainty ?? 0));
  const {box, y} = panel;
  if (!(100 * doubt > y.min)) return;
  const top = box.top + box.height * (1 - along(y, Math.min(100 * doubt, y.max)));
  ctx.fillStyle = colors().band;
  ctx.fillRect(box.left, top, box.width, box.top + box.height - top);
}

/// Draws the front as a staircase.
function drawFront(ctx, panel) {
  const front = paretoFront(panel.points.filter(point => claims(panel.result, point.model, panel.nu))).map(point => placeOf(panel, point)), {box} = panel;
  const stair = front.flatMap(([x, y], i) => i === 0 ? [[x, box.top], [x, y]] : [[x, front[i - 1][1]], [x, y]]);
  if (stair.length === 0) return;
  stair.push([box.left + box.width, stair[stair.length - 1][1]]);
  ctx.lineJoin = 'round';
  strokeFront(ctx, stair);
}

function strokeFront(ctx, points) {
  ctx.strokeStyle = '#f2b632';
  ctx.globalAlpha = 0.55;
  ctx.lineWidth = 6;
  strokePath(ctx, points);
  ctx.globalAlpha = 1;
}

function strokeModel(ctx, model, points) {
  ctx.strokeStyle = modelStyle(model).color;
  ctx.lineWidth = 1.5;
  ctx.setLineDash(isFem(model) ? [5, 3] : []);
  strokePath(ctx, points);
  ctx.setLineDash([]);
}

function drawCostLine(ctx, panel, model) {
  const line = costLine(panel.points, model), {color, marker} = modelStyle(model), {paper, soft} = colors();
  strokeModel(ctx, model, line.map(point => placeOf(panel, point)));
  for (const point of line) {
    ctx.strokeStyle = point.below ? soft : color;
    ctx.fillStyle = point.below ? paper : color;
    drawMarker(ctx, marker, ...placeOf(panel, point));
  }
}

function drawMarker(ctx, marker, x, y) {
  ctx.lineWidth = 1.5;
  Chart.helpers.drawPoint(ctx, {pointStyle: marker, radius: marker.startsWith('rect') ? 4.5 : 4, borderWidth: 1.5}, x, y);
}

function drawCostLegend(ctx, width) {
  const {ink} = colors();
  ctx.font = `13px ${paperFont}`;
  ctx.textAlign = 'left';
  let x = costMargins.left, y = 16;
  const next = (text, symbol) => {
    const wide = 40 + ctx.measureText(text).width;
    if (x + wide > width) { x = costMargins.left; y += 22; }
    symbol(x, y);
    ctx.fillStyle = ink;
    ctx.fillText(text, x + 28, y + 4.5);
    x += wide + 14;
  };
  for (const model of costModels())
    next(model, (x, y) => {
      const {color, marker} = modelStyle(model);
      strokeModel(ctx, model, [[x, y], [x + 22, y]]);
      ctx.fillStyle = color;
      drawMarker(ctx, marker, x + 11, y);
    });
  next('the front', (x, y) => strokeFront(ctx, [[x, y], [x + 22, y]]));
}

function drawCost(ctx, width, cost) {
  const panels = costPanels(cost, width);
  drawCostLegend(ctx, width);
  for (const panel of panels) {
    drawAxes(ctx, panel, cost);
    drawDoubt(ctx, panel);
    ctx.save();
    ctx.beginPath();
    ctx.rect(panel.box.left, panel.box.top, panel.box.width, panel.box.height);
    ctx.clip();
    drawFront(ctx, panel);
    for (const model of [...costModels()].reverse()) drawCostLine(ctx, panel, model);
    ctx.restore();
  }
  return panels;
}

const costNotes = ['Error against the extrapolated finite element reference, each line one method refined: of the displacement, and of the force or torque ' +
  'on supports that are moved. Yellow: the front, what no other ' +
  'run beats in both, of models at the Poisson’s ratios that they claim. Grey: the uncertainty of the reference; points in it are hollow and stand at its edge.'];

function costDrawing(kind) {
  const cost = costs[kind];
  return {
    name: `error-against-${kind}`,
    caption: `Error against ${kind === 'time' || kind === 'solve' ? 'time' : kind}`,
    sheet: () => onPaper(() => {
      const {canvas, ctx} = newCanvas(paperWidth, costHeight());
      drawCost(ctx, paperWidth, cost);
      return paper(canvas, paperWidth, costHeight(), `Error against ${cost.axis}`, costNotes);
    }),
  };
}

/// A canvas on the page with what it was drawn from, for the pointer.
function costFigure(kinds) {
  const canvas = el('canvas', {role: 'img', style: {width: '100%', display: 'block'}});
  const choice = select('Against', kinds.map(kind => [kind, costs[kind].text]), draw);
  let panels = [];
  function draw() {
    const width = Math.max(720, canvas.clientWidth || 1180), height = costHeight(), scale = Math.max(2, window.devicePixelRatio || 1);
    Object.assign(canvas, {width: width * scale, height: height * scale});
    canvas.style.aspectRatio = `${width} / ${height}`;
    const ctx = canvas.getContext('2d');
    ctx.scale(scale, scale);
    panels = drawCost(ctx, width, costs[choice.value]);
    canvas.setAttribute('aria-label', `Error against ${costs[choice.value].axis}; the numbers are in the case pages`);
  }
  canvas.addEventListener('mousemove', event => {
    const scale = canvas.clientWidth / (canvas.width / Math.max(2, window.devicePixelRatio || 1));
    canvas.title = costTip(panels, event.offsetX / scale, event.offsetY / scale);
  });
  const node = el('div', {class: 'figure', style: {marginTop: '18px'}}, el('div', {class: 'choices'}, choice.node), canvas,
    el('div', {class: 'below'}, el('p', {class: 'note'}, costNotes), pngButton(() => costDrawing(choice.value).sheet(), () => costDrawing(choice.value).name)));
  return {node, draw};
}

function costTip(panels, x, y) {
  let best = {distance: 12, text: ''};
  for (const panel of panels)
    for (const point of panel.points) {
      const [px, py] = placeOf(panel, point), distance = Math.hypot(px - x, py - y), {run} = point;
      if (distance < best.distance) best = {distance, text: `${point.model}, ${cellsWords(point.row.cells)}: ${percent(100 * point.error)}\n` +
        `set-up ${seconds(run.set_up_seconds)}, solve ${seconds(run.seconds)}, ${number(run.unknowns, 6)} unknowns, ${number(run.memory_MiB, 3)} MiB`};
    }
  return best.text;
}

// ---- what an accuracy costs

const costLevels = [0.1, 0.03, 0.01, 0.003];

const shortTime = t => t < 0.1 ? number(1e3 * t, 2) + ' ms' : seconds(t);

/// The cheapest models that reach a level, cheapest first [{model, x, unknowns}].  At other Poisson's ratios than the
/// one it is valid for, a model has a small error by accident only.
function cheapest(result, nu, points, level) {
  return costModels().filter(model => claims(result, model, nu)).map(model => ({model, ...costToReach(costLine(points, model), level)}))
    .filter(entry => entry.x > 0).sort((a, b) => a.x - b.x);
}

function levelCell({result, measure}, nu, level) {
  const points = costPoints({result, measure}, nu, costs.time);
  if (points.every(point => (point.row.reference_uncertainty ?? 0) > level)) return el('td', {}, el('small', {}, 'reference too coarse'));
  const [best, ...others] = cheapest(result, nu, points, level);
  if (!best) return el('td', {}, '–');
  const text = entry => `${shortTime(entry.x)}, ${number(Number(entry.unknowns.toPrecision(2)))} unknowns`;
  const rival = others.find(entry => isFem(entry.model) !== isFem(best.model));
  return el('td', {}, modelName(best.model), el('small', {}, text(best)),
            el('small', {}, rival ? [swatch(rival.model), `${rival.model}: ${text(rival)}`] : isFem(best.model) ? 'no springs do' : 'no finite elements do'));
}

function costTable() {
  const rows = costRows.flatMap(row => row.result.nus.map((nu, i) => el('tr', {class: i === 0 ? 'group' : ''},
    el('td', {}, i === 0 ? [el('a', {href: '#' + row.result.id}, el('b', {}, row.result.name)), el('small', {}, shortNames[row.measure])] : ''),
    el('td', {}, nuText(nu)), costLevels.map(level => levelCell(row, nu, level)))));
  return [el('h3', {}, 'What an accuracy costs'),
    el('p', {class: 'note'}, 'The cheapest method, by CPU time of set-up and solve, that has no more than this error, read off between its ' +
       'runs; below it the cheapest of the other kind, springs or finite elements. Models count at the Poisson’s ratios that they claim.'),
    table('cost', ['case', 'ν', ...costLevels.map(level => `${number(100 * level, 2)} %`)], rows)];
}

function costSection(section) {
  if (costCases.length === 0) return leaveOut(section);
  const time = costFigure(['time', 'solve']), size = costFigure(['unknowns', 'memory']);
  section.append(
    el('p', {class: 'lead'}, 'Every model and element at several resolutions. Time runs from the mesh in memory to the displacement, alike for both; ' +
       'everything stops at a relative residual of 10⁻⁸.'),
    time.node, ...costTable(), size.node);
  const draw = () => { time.draw(); size.draw(); };
  draw();
  charts.push(draw);
  window.addEventListener('resize', draw);
  return {show() {}, has: id => costCases.some(c => c.id === id),
          drawings: result => result === costCases[0] ? Object.keys(costs).map(costDrawing) : []};
}
