'use strict';
// Error against Poisson's ratio, error against cell size (or time).

function colors() {
  return {ink: cssColor('--ink'), soft: cssColor('--soft'), grid: cssColor('--line'),
          paper: cssColor('--paper'), band: cssColor('--band')};
}

function lineDataset(model, label, data) {
  const {color, marker, dash} = modelStyle(model);
  return {model, label, data, borderColor: color, backgroundColor: color, pointBorderColor: color, pointStyle: marker,
          borderDash: dash, borderWidth: 2, pointRadius: 5, pointHoverRadius: 7, pointBorderWidth: 2, tension: 0,
          pointBackgroundColor: context => context.raw && context.raw.below ? colors().paper : color};
}

/// Axis limits on whole decades that hold all values; the band never pushes the curves into a corner.
function decades(values, extra) {
  const good = values.filter(x => x > 0);
  if (good.length === 0) return {min: 1e-3, max: 1};
  const low = Math.min(...good);
  const lowest = Math.max(low / 100, Math.min(low, ...extra.filter(x => x > 0)));
  const min = 10 ** Math.floor(Math.log10(lowest));
  const max = 10 ** Math.ceil(Math.log10(Math.max(...good, ...extra)));
  return {min, max: max > min ? max : 10 * min};
}

function decadeText(value) {
  const exponent = Math.log10(value);
  if (Math.abs(exponent - Math.round(exponent)) > 1e-9) return null;
  return value >= 1e-4 && value < 1e5 ? String(Number(value.toPrecision(1))) : '10' + superscript(Math.round(exponent));
}

function logAxis(title, {min, max}) {
  const {ink, grid} = colors();
  const few = max / min <= 100;
  const label = value => decadeText(value) ?? (few && [2, 5].includes(Number(value.toExponential(0)[0])) &&
    Math.abs(value / 10 ** Math.floor(Math.log10(value)) % 1) < 1e-9 ? String(Number(value.toPrecision(1))) : null);
  return {type: 'logarithmic', min, max, title: {display: true, text: title, color: ink},
          grid: {color: context => context.tick && decadeText(context.tick.value) ? grid : 'transparent'},
          ticks: {color: ink, autoSkip: false, callback: label}};
}

function baseOptions() {
  const {ink} = colors();
  return {responsive: true, maintainAspectRatio: false, animation: false,
          interaction: {mode: 'nearest', intersect: false},
          layout: {padding: {right: 14}},
          plugins: {legend: {position: window.innerWidth > 760 ? 'right' : 'bottom', labels: {color: ink, usePointStyle: true, boxHeight: 8, padding: 14}}}};
}

// ---- error against nu

const linearCases = 'all linear', largeCases = 'all large';

function caseChoices() {
  const choices = [];
  const linear = cases.filter(c => c.linear), large = cases.filter(c => !c.linear);
  if (linear.length > 1) choices.push([linearCases, `all ${linear.length} linear cases, the largest error`]);
  if (large.length > 1) choices.push([largeCases, `all ${large.length} large-deformation cases, the largest error`]);
  return choices.concat(cases.map(c => [c.id, c.linear ? c.name : `${c.name} (large deformation)`]));
}

function chosenCases(choice) {
  if (choice === linearCases) return ofOneAxis(cases.filter(c => c.linear));
  if (choice === largeCases) return ofOneAxis(cases.filter(c => !c.linear));
  return cases.filter(c => c.id === choice);
}

/// Measures that can be drawn for all chosen cases in one unit.
function measureChoices(chosen) {
  const measures = distinct(chosen.flatMap(c => c.measures));
  const same = measures.filter(measure => {
    const holders = chosen.filter(c => c.measures.includes(measure));
    return distinct(holders.map(c => c.scales.get(measure).unit)).length === 1 &&
      holders.some(c => c.rows.some(row => row.measure === measure && isNumber(row.error)));
  });
  const first = ['displacement_error', 'motion_error', 'volume_change'].filter(m => same.includes(m));
  const idle = same.filter(m => chosen.every(c => c.minor.has(m) || !c.measures.includes(m)));
  const rest = same.filter(m => !first.includes(m) && !idle.includes(m));
  return [...first, ...rest, ...idle.filter(m => !first.includes(m))].map(m => [m, measureText(m)]);
}

/// model -> nu -> {error, uncertainty, row, result}: the largest over the chosen cases.
function errorsByNu(chosen, measure, resolution) {
  const byModel = new Map(models.map(model => [model, new Map()]));
  for (const result of chosen) {
    for (const row of rowsAt(result, measure, resolution)) {
      const error = scaledError(result, row);
      if (error === null) continue;
      const points = byModel.get(row.model);
      const before = points.get(row.poisson_ratio);
      if (!before || error > before.error)
        points.set(row.poisson_ratio, {error, uncertainty: scaledUncertainty(result, row), row, result});
    }
  }
  return new Map([...byModel].filter(([, points]) => points.size > 0));
}

function uncertaintyByNu(chosen, measure, resolution) {
  const band = new Map();
  for (const result of chosen)
    for (const row of rowsAt(result, measure, resolution)) {
      const uncertainty = scaledUncertainty(result, row);
      if (uncertainty !== null) band.set(row.poisson_ratio, Math.max(uncertainty, band.get(row.poisson_ratio) ?? 0));
    }
  return band;
}

function bandDataset(points) {
  const {band, soft} = colors();
  return {label: 'uncertainty of the reference', data: points, fill: 'start', backgroundColor: band, borderColor: soft,
          borderWidth: 1, borderDash: [2, 3], pointRadius: 0, pointHitRadius: 0, pointStyle: 'rect', order: 10};
}

/// Number of spring models in some cases.
const springCount = chosen => distinct(chosen.flatMap(c => c.models)).filter(model => !isFem(model)).length;

function poissonTooltip(unit) {
  return {
    filter: item => item.raw && item.raw.row,
    callbacks: {
      title: items => items.length ? settingText(items[0].raw.result, items[0].raw.row.poisson_ratio) : '',
      label: item => `${item.dataset.label}: ${number(item.raw.y, 3)} ${unit}`,
      afterLabel: ({raw}) => [`${raw.result.name}, ${cellsWords(raw.row.cells)}`,
        raw.uncertainty === null ? 'reference without uncertainty'
          : `uncertainty of the reference: ${number(raw.uncertainty, 2)} ${unit}`],
    },
  };
}

function missingNotes(chosen, resolution) {
  const failed = chosen.flatMap(result => result.runs.filter(run => !run.ok &&
    (['finest', 'coarsest'].includes(resolution) || cellsText(run.cells) === resolution)).map(run => [result, run]));
  return failed.slice(0, 4).map(([result, run]) => `No result: ${run.model} at ${settingText(result, run.poisson_ratio)}, ` +
    `${result.name}, ${cellsWords(run.cells)} (${run.message || 'no reason given'}).`)
    .concat(failed.length > 4 ? [`${failed.length - 4} more runs without a result.`] : []);
}

/// Shades an axis from its lower end to `limit`.
const shadeBelow = limit => ({
  id: 'shadeBelow',
  beforeDatasetsDraw({ctx, chartArea: {left, right, top, bottom}, scales: {x}}) {
    if (!(limit > 0)) return;
    ctx.save();
    ctx.fillStyle = colors().band;
    ctx.fillRect(left, top, Math.min(right, Math.max(left, x.getPixelForValue(limit))) - left, bottom - top);
    ctx.restore();
  },
});

/// Of a single Poisson's ratio: a bar per model, the closest first.
function barsAtOneNu(byModel, band, measure, unit) {
  const {ink} = colors(), bars = [...byModel].map(([model, points]) => ({model, ...[...points.values()][0]})).filter(bar => bar.error > 0)
    .sort((a, b) => a.error - b.error);
  const options = baseOptions(), limit = [...band.values()][0];
  const axis = logAxis(`${measureText(measure)} [${unit}]`, decades(bars.map(bar => bar.error), limit > 0 ? [limit] : []));
  options.indexAxis = 'y';
  options.plugins.legend = {display: false};
  options.plugins.tooltip = {callbacks: {label: ({raw}) => `${number(raw.x, 3)} ${unit}`,
    afterLabel: ({raw}) => raw.uncertainty === null ? 'reference without uncertainty' : `uncertainty of the reference: ${number(raw.uncertainty, 2)} ${unit}`}};
  options.scales = {x: axis, y: {type: 'category', labels: bars.map(bar => bar.model), offset: true, grid: {display: false}, ticks: {color: ink, autoSkip: false}}};
  const style = bar => modelStyle(bar.model).color;
  return {type: 'bar', options, plugins: [shadeBelow(limit)], data: {labels: bars.map(bar => bar.model), datasets: [{
    data: bars.map(bar => ({x: bar.error, y: bar.model, ...bar})), base: axis.min, maxBarThickness: 26, borderWidth: 2, borderColor: bars.map(style),
    backgroundColor: bars.map(bar => bar.uncertainty !== null && bar.error <= bar.uncertainty ? 'transparent' : style(bar))}]}};
}

/// Writes the name of each line at its last point, pushed apart where they would overlap.
const lineEndLabels = {
  id: 'lineEndLabels',
  afterDatasetsDraw(chart) {
    const {ctx, chartArea} = chart;
    const ends = chart.data.datasets.flatMap((dataset, i) => {
      const meta = chart.getDatasetMeta(i), points = meta.data.filter((point, j) => isNumber((dataset.data[j] || {}).y));
      return dataset.model && chart.isDatasetVisible(i) && points.length > 0 ? [{text: dataset.model, color: dataset.borderColor, y: points[points.length - 1].y}] : [];
    }).sort((a, b) => a.y - b.y);
    const apart = 15;
    ends.forEach((end, i) => { if (i > 0) end.y = Math.max(end.y, ends[i - 1].y + apart); });
    const over = ends.length > 0 ? Math.max(0, ends[ends.length - 1].y - (chartArea.bottom - 4)) : 0;
    if (over > 0) ends.slice().reverse().forEach((end, i, all) => { end.y = i === 0 ? end.y - over : Math.min(end.y, all[i - 1].y - apart); });
    ctx.save();
    ctx.font = '600 12px system-ui, sans-serif';
    ctx.textBaseline = 'middle';
    for (const {text, color, y} of ends) {
      ctx.fillStyle = color;
      ctx.fillRect(chartArea.right + 8, y - 4, 8, 8);
      ctx.fillStyle = colors().ink;
      ctx.fillText(text, chartArea.right + 21, y);
    }
    ctx.restore();
  },
};

/// Room for the labels at the ends of lines, with the legend below to switch them.
function withLineEnds(options, datasets) {
  if (window.innerWidth <= 760) return [];
  const ruler = document.createElement('canvas').getContext('2d');
  ruler.font = '600 12px system-ui, sans-serif';
  options.layout.padding.right = 29 + Math.max(40, ...datasets.filter(d => d.model).map(d => ruler.measureText(d.model).width));
  options.plugins.legend.position = 'bottom';
  return [lineEndLabels];
}

function poissonChart(chosen, measure, resolution, even) {
  const byModel = errorsByNu(chosen, measure, resolution);
  const band = uncertaintyByNu(chosen, measure, resolution);
  const nus = distinct([...byModel.values()].flatMap(points => [...points.keys()])).sort((a, b) => a - b);
  const x = nu => even ? nuText(nu) : nu;
  const unit = (chosen.find(c => c.scales.has(measure)) || {scales: new Map()}).scales.get(measure)?.unit ?? '';
  if (nus.length === 1) return barsAtOneNu(byModel, band, measure, unit);
  const springModels = [...byModel.keys()].filter(model => !isFem(model));
  const datasets = [...byModel].map(([model, points]) => ({hidden: springModels.indexOf(model) >= mostLines, ...lineDataset(model, model, nus.map(nu => {
    const point = points.get(nu);
    if (!point) return {x: x(nu), y: null};
    return {x: x(nu), y: point.error, below: point.uncertainty !== null && point.error <= point.uncertainty, ...point};
  }))}));
  const values = [...byModel.values()].flatMap(points => [...points.values()].map(p => p.error));
  const limits = decades(values, [...band.values()]);
  const room = 0.03 * (nus[nus.length - 1] - nus[0]);
  if (band.size > 0) datasets.push(bandDataset(nus.map(nu => ({x: x(nu), y: band.get(nu) ?? null}))));
  const {ink, grid} = colors();
  const options = baseOptions();
  options.plugins.tooltip = poissonTooltip(unit);
  options.scales = {
    x: {type: even ? 'category' : 'linear', labels: even ? nus.map(nuText) : undefined, offset: even,
        min: even ? undefined : nus[0] - room, max: even ? undefined : nus[nus.length - 1] + room,
        title: {display: true, text: settingWords(chosen), color: ink}, grid: {color: grid},
        ticks: {color: ink, includeBounds: false}},
    y: logAxis(`${measureText(measure)} [${unit}]`, limits),
  };
  return {type: 'line', data: {datasets}, options, plugins: withLineEnds(options, datasets)};
}

/// "displacement error", "error of the volume change"
const errorWords = measure => measureText(measure).endsWith('error') ? measureText(measure) : 'error of the ' + measureText(measure);

const mostLines = 6;   // spring models drawn at first

function poissonDrawing(chosen, measure, resolution, even) {
  const one = chosen.length === 1;
  return {
    name: `${one ? chosen[0].key : 'all'}-error-${measure}`,
    caption: `${one ? chosen[0].name : `Largest of ${chosen.length} cases`}: ${errorWords(measure)} against ${settingWords(chosen).replace(' ν', '')}, ` +
      `${['finest', 'coarsest'].includes(resolution) ? resolution + ' cells' : resolution}`,
    notes: ['Below the shaded band a difference cannot be told from the uncertainty of the reference; such points are hollow.',
            ...(springCount(chosen) > mostLines ? ['Models struck out in the legend are hidden: click to show them.'] : []),
            ...missingNotes(chosen, resolution)],
    make: () => poissonChart(chosen, measure, resolution, even),
  };
}

/// Displacement above volume change, the largest errors over all linear cases, of the curves shown at first; none: [].
function overviewDrawings() {
  const chosen = chosenCases(linearCases), measures = ['displacement_error', 'volume_change'];
  const known = measureChoices(chosen).map(([measure]) => measure);
  if (chosen.length < 2 || !measures.every(measure => known.includes(measure))) return [];
  const sheet = () => stacked(measures.map(measure => chartPaper(firstShown(poissonDrawing(chosen, measure, 'finest', true)))));
  return [{name: 'error-against-poisson-ratio', sheet}];
}

function poissonSection(section) {
  const plot = figure(), volumePlot = figure();
  const empty = notice('No error of this case is known.');
  const caseChoice = select('Case', caseChoices(), update);
  const measureChoice = select('Measure', [], draw);
  const resolutionChoice = select('Resolution', [], draw);
  const axisChoice = select('ν axis', [['even', 'evenly spaced'], ['scale', 'to scale']], draw);

  function update() {
    const chosen = chosenCases(caseChoice.value);
    replaceOptions(measureChoice, measureChoices(chosen));
    const listed = chosen.length === 1 ? chosen[0].cells.map(cells => [cellsText(cells), cellsWords(cells)]) : [];
    replaceOptions(resolutionChoice, [['finest', 'finest'], ['coarsest', 'coarsest'], ...listed]);
    draw();
  }
  function draw() {
    const chosen = chosenCases(caseChoice.value);
    plot.node.hidden = !measureChoice.value;
    empty.hidden = !plot.node.hidden;
    if (!measureChoice.value) return;
    const drawing = measure => poissonDrawing(chosen, measure, resolutionChoice.value, axisChoice.value === 'even');
    plot.draw(drawing(measureChoice.value));
    // The two main errors are shown together.
    const together = measureChoice.value === 'displacement_error' && measureChoices(chosen).some(([m]) => m === 'volume_change');
    volumePlot.node.hidden = !together;
    if (together) volumePlot.draw({...drawing('volume_change'), notes: []});
  }
  section.append(el('p', {class: 'lead'}, 'How far each model is from the finite element reference.'),
                 el('div', {class: 'choices'}, caseChoice.node, measureChoice.node, resolutionChoice.node, axisChoice.node),
                 empty, plot.node, volumePlot.node);
  update();
  charts.push(draw);
  return {show(id) { caseChoice.value = id; update(); }, has: isCompared,
          drawings: result => [...result === cases[0] ? overviewDrawings() : [],
            ...measureChoices([result]).filter(([m]) => !result.minor.has(m)).map(([m]) => allShown(poissonDrawing([result], m, 'finest', true)))]};
}

// ---- convergence

/// Edge of a cube with the volume of a cell [m]; without a size, of a body of volume 1.
function cellSize(result, cells) {
  const size = (result.experiment.body || {}).size || [1, 1, 1];
  const volume = size.every(s => s > 0) ? cellCount(size) : 1;
  return Math.cbrt(volume / cellCount(cells));
}

/// Least-squares slope of log y over log x.
function slope(points) {
  const logs = points.filter(p => p.x > 0 && p.y > 0).map(p => [Math.log(p.x), Math.log(p.y)]);
  const meanX = logs.reduce((s, [x]) => s + x, 0) / logs.length;
  const meanY = logs.reduce((s, [, y]) => s + y, 0) / logs.length;
  const xx = logs.reduce((s, [x]) => s + (x - meanX) ** 2, 0);
  return xx > 0 ? logs.reduce((s, [x, y]) => s + (x - meanX) * (y - meanY), 0) / xx : null;
}

function convergencePoints(result, measure, model, nu, against) {
  return result.rows.filter(r => r.measure === measure && r.model === model && r.poisson_ratio === nu).map(row => {
    const run = findRun(result, row);
    const uncertainty = scaledUncertainty(result, row);
    const y = scaledError(result, row);
    const x = against === 'size' ? cellSize(result, row.cells) : run ? run.seconds : null;
    return {x, y, row, run, uncertainty, below: uncertainty !== null && y <= uncertainty};
  }).filter(p => p.x > 0 && p.y > 0).sort((a, b) => a.x - b.x);
}

/// Lines of one model at every nu, or of every model at one nu.
function convergenceLines(result, choice, measure, against) {
  const [kind, which] = [choice.slice(0, choice.indexOf(':')), choice.slice(choice.indexOf(':') + 1)];
  const lines = kind === 'nu' ? models.map(model => ({name: model, model, nu: Number(which)}))
    : result.nus.map((nu, i) => ({name: settingText(result, nu), model: which, nu, color: rampColor(i, result.nus.length)}));
  return lines.map(line => ({...line, points: convergencePoints(result, measure, line.model, line.nu, against)}));
}

const rampColor = (i, n) => viridisCss(n > 1 ? 0.12 + 0.73 * i / (n - 1) : 0.4);

function convergenceDataset(line, against) {
  const order = line.points.length > 1 && against === 'size' ? slope(line.points) : null;
  const label = order === null ? line.name : `${line.name}: order ${minus(order.toFixed(2))}`;
  const dataset = lineDataset(line.model, label, line.points);
  if (line.color) Object.assign(dataset, {borderColor: line.color, backgroundColor: line.color,
    pointBorderColor: line.color, borderDash: [], pointStyle: 'circle',
    pointBackgroundColor: context => context.raw && context.raw.below ? colors().paper : line.color});
  return dataset;
}

/// Dashed lines of slope 1 and 2 that end above the coarsest points.
function guideDatasets(lines) {
  const points = lines.flatMap(line => line.points);
  const xs = points.map(p => p.x);
  const low = Math.min(...xs), high = Math.max(...xs);
  if (!(high > low)) return [];
  const top = Math.max(...points.filter(p => p.x === high).map(p => p.y));
  return [1, 2].map(order => ({label: `order ${order}`, guide: true, borderColor: colors().soft, borderWidth: 1,
    borderDash: [3, 3], pointRadius: 0, pointHitRadius: 0, order: 9,
    data: [{x: low, y: 1.3 * top * (low / high) ** order}, {x: high, y: 1.3 * top}]}));
}

/// Writes the name of a guide line at its lower end.
const guideLabels = {
  id: 'guideLabels',
  afterDatasetsDraw(chart) {
    const {ctx, chartArea} = chart;
    chart.data.datasets.forEach((dataset, i) => {
      const point = dataset.guide && chart.getDatasetMeta(i).data[0];
      if (!point || point.y > chartArea.bottom - 6) return;
      ctx.save();
      ctx.fillStyle = dataset.borderColor;
      ctx.font = 'italic 12px system-ui, sans-serif';
      ctx.textAlign = 'right';
      ctx.fillText(dataset.label, point.x - 6, point.y + 4);
      ctx.restore();
    });
  },
};

function sizeAxis(result, lines) {
  const {ink, grid} = colors();
  const cells = distinct(lines.flatMap(line => line.points.map(p => p.row.cells)));
  const values = cells.map(c => ({value: cellSize(result, c), cells: c})).sort((a, b) => a.value - b.value);
  const first = values[0].value, last = values[values.length - 1].value;
  return {type: 'logarithmic', min: first / 1.35, max: last * 1.15, grid: {color: grid},
          title: {display: true, text: 'cell size h', color: ink},
          afterBuildTicks: axis => { axis.ticks = values.map(({value}) => ({value})); },
          ticks: {color: ink, autoSkip: false, maxRotation: 0, callback: value => {
            const entry = values.find(v => Math.abs(v.value / value - 1) < 1e-6);
            return entry ? [`${number(entry.value, 3)} m`, cellsText(entry.cells)] : null;
          }}};
}

function convergenceBand(lines, limits) {
  const uncertainties = lines.flatMap(line => line.points.map(p => p.uncertainty)).filter(isNumber);
  if (uncertainties.length === 0) return [];
  const y = Math.max(...uncertainties);
  return [bandDataset([{x: limits.min, y}, {x: limits.max, y}])];
}

function convergenceTooltip(result, unit) {
  return {
    filter: item => item.raw && item.raw.row,
    callbacks: {
      title: items => items.length ? `${items[0].raw.row.model}, ${settingText(result, items[0].raw.row.poisson_ratio)}` : '',
      label: ({raw}) => `${number(raw.y, 3)} ${unit} with ${cellsWords(raw.row.cells)}`,
      afterLabel: ({raw}) => raw.run ? `${seconds(raw.run.seconds)}, ${number(raw.run.unknowns, 6)} unknowns` : '',
    },
  };
}

function convergenceChart(result, choice, measure, against) {
  const lines = convergenceLines(result, choice, measure, against).filter(line => line.points.length > 0);
  if (lines.length === 0) return null;
  const points = lines.flatMap(line => line.points);
  const unit = result.scales.get(measure).unit;
  const datasets = lines.map(line => convergenceDataset(line, against));
  const guides = against === 'size' ? guideDatasets(lines) : [];
  const options = baseOptions();
  options.plugins.tooltip = convergenceTooltip(result, unit);
  options.plugins.legend.labels.filter = (item, data) => !data.datasets[item.datasetIndex].guide;
  const x = against === 'size' ? sizeAxis(result, lines)
    : logAxis('time [s]', decades(points.map(p => p.x), []));
  const band = convergenceBand(lines, x);
  const values = [...points.map(p => p.y), ...guides.flatMap(g => g.data.map(p => p.y))];
  options.scales = {x, y: logAxis(`${measureText(measure)} [${unit}]`, decades(values, band.map(b => b.data[0].y)))};
  return {type: 'line', data: {datasets: [...datasets, ...guides, ...band]}, options, plugins: [guideLabels]};
}

/// Null where there is nothing to draw.
function convergenceDrawing(result, choice, measure, against) {
  const make = () => convergenceChart(result, choice, measure, against);
  if (make() === null) return null;
  const [kind, which] = [choice.slice(0, choice.indexOf(':')), choice.slice(choice.indexOf(':') + 1)];
  const single = result.cells.length < 2 ? ['Only one resolution was run: no order can be observed.'] : [];
  return {
    name: `${result.key}-convergence-${measure}-${kind === 'nu' ? 'nu' + nuDigits(Number(which)) : which}`,
    caption: `${result.name}: ${errorWords(measure)} against ${against === 'size' ? 'cell size' : 'time'}, ` +
      (kind === 'nu' ? `${settingText(result, Number(which))}` : which),
    notes: [...single, 'The order is the slope of a least-squares line through all resolutions. ' +
      'Block cases have singular edges at clamped faces, where order 2 cannot be expected.'],
    make,
  };
}

/// Every measure at every nu, where there is more than one resolution.
function convergenceDrawings(result) {
  if (result.cells.length < 2) return [];
  const measures = measureChoices([result]).map(([measure]) => measure).filter(measure => !result.minor.has(measure));
  return measures.flatMap(measure => result.nus.map(nu => convergenceDrawing(result, 'nu:' + nu, measure, 'size'))).filter(Boolean);
}

function convergenceSection(section) {
  const plot = figure();
  const caseChoice = select('Case', cases.map(c => [c.id, c.name]), update);
  const measureChoice = select('Measure', [], draw);
  const lineChoice = select('Lines', [], draw);
  const axisChoice = select('Against', [['size', 'cell size'], ['time', 'time of the run']], draw);
  const empty = notice('');

  const chosen = () => cases.find(c => c.id === caseChoice.value);
  function update() {
    replaceOptions(measureChoice, measureChoices([chosen()]));
    replaceOptions(lineChoice, [...chosen().nus.map(nu => ['nu:' + nu, `all models at ${settingText(chosen(), nu)}`]),
                                ...chosen().models.map(model => ['model:' + model, `all ${chosen().listed.symbol} of ${model}`])]);
    draw();
  }
  function draw() {
    const result = chosen(), measure = measureChoice.value;
    const drawing = measure ? convergenceDrawing(result, lineChoice.value, measure, axisChoice.value) : null;
    plot.node.hidden = !drawing;
    empty.hidden = Boolean(drawing);
    empty.textContent = 'There is no error to draw for this choice.';
    if (drawing) plot.draw(drawing);
  }
  section.append(
    el('p', {class: 'lead'}, 'How fast the error falls as the cells get smaller, and what that costs.'),
    el('div', {class: 'choices'}, caseChoice.node, measureChoice.node, lineChoice.node, axisChoice.node),
    empty, plot.node);
  update();
  const middle = chosen().nus.includes(0.25) ? 'nu:0.25' : null;
  if (middle) { lineChoice.value = middle; draw(); }
  charts.push(draw);
  return {show(id) { caseChoice.value = id; update(); }, has: isCompared, drawings: convergenceDrawings};
}
