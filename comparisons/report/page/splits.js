'use strict';
// Where the error of a model comes from: its springs, the resolution, the geometry of the voxels.

const splitParts = [
  {key: 'model_error', name: 'model', color: '#d55e00', marker: 'triangle',
   meaning: 'model: the springs against finite elements (eight-node bricks) on the same voxels'},
  {key: 'discretisation_error', name: 'discretisation', color: '#0072b2', marker: 'rect',
   meaning: 'discretisation: those finite elements against the limit of refined elements on the same voxels'},
  {key: 'geometry_error', name: 'geometry', color: '#009e73', marker: 'rectRot',
   meaning: 'geometry: that limit against the limit on the body’s true surface'},
];

const allModels = 'all models';
const splitSum = measure => isDistance(measure) ? 'Each is a distance: the three do not add up to the total.' : 'The three add up to the total.';
/// On the page the parts are explained once, above.
const splitNotes = measure => ({notes: [splitSum(measure)],
  paperNotes: [splitParts.map(part => part.meaning).join('; ') + '. ' + splitSum(measure)]});

/// Entries of a measure at the finest cells of each model.
function finestSplits(result, measure) {
  const entries = result.splits.filter(s => s.measure === measure);
  const finest = model => Math.min(...entries.filter(s => s.model === model).map(s => s.voxel_edge_m));
  return entries.filter(s => s.voxel_edge_m === finest(s.model));
}

const splitUnit = (measure, entries) => displayUnit(measure, entries[0].unit, entries.flatMap(s => [s.total, ...splitParts.map(p => s[p.key])]));

/// Draws the uncertainty of each total as a bar through its dot.
const whiskers = {
  id: 'whiskers',
  afterDatasetsDraw(chart) {
    const {ctx, scales} = chart;
    chart.data.datasets.forEach((dataset, i) => dataset.whiskers && chart.getDatasetMeta(i).data.forEach((point, j) => {
      const half = dataset.whiskers[j], y = dataset.data[j].y;
      if (!isNumber(half) || !isNumber(y) || chart.getDatasetMeta(i).hidden) return;
      const [low, high] = [y - half, y + half].map(value => scales.y.getPixelForValue(value));
      ctx.save();
      ctx.strokeStyle = dataset.borderColor;
      ctx.lineWidth = 1.5;
      ctx.beginPath();
      ctx.moveTo(point.x, low);
      ctx.lineTo(point.x, high);
      for (const end of [low, high]) { ctx.moveTo(point.x - 4, end); ctx.lineTo(point.x + 4, end); }
      ctx.stroke();
      ctx.restore();
    }));
  },
};

/// Signed bars of the parts, the total as a dot with its uncertainty; entries in the order of their labels.
function splitBars(measure, entries, labels, axis) {
  const {ink, grid} = colors(), {factor, unit} = splitUnit(measure, entries), stacked = !isDistance(measure);
  const points = key => entries.map((s, i) => ({x: labels[i], y: isNumber(s[key]) ? factor * s[key] : null, entry: s}));
  const bars = splitParts.map(part => ({type: 'bar', label: part.name, data: points(part.key), backgroundColor: part.color, order: 2,
                                        stack: stacked ? 'parts' : part.key, maxBarThickness: 46, pointStyle: 'rect'}));
  const total = {type: 'line', label: 'total ± uncertainty', data: points('total'), showLine: false, borderColor: ink, backgroundColor: ink,
                 pointBackgroundColor: ink, pointRadius: 5, pointStyle: 'circle', order: 1, whiskers: entries.map(s => isNumber(s.uncertainty) ? factor * s.uncertainty : null)};
  const options = baseOptions();
  options.plugins.tooltip = {callbacks: {label: ({dataset, raw}) => `${dataset.label}: ${number(raw.y, 3)} ${unit}`}};
  options.scales = {
    x: {type: 'category', labels, stacked, offset: true, title: {display: true, text: axis, color: ink}, grid: {display: false}, ticks: {color: ink}},
    y: {stacked, title: {display: true, text: withUnit(measureText(measure), unit), color: ink},
        grid: {color: context => context.tick && context.tick.value === 0 ? ink : grid}, ticks: {color: ink, callback: value => number(value, 3)}},
  };
  return {type: 'bar', data: {datasets: [total, ...bars]}, options, plugins: [whiskers]};
}

function splitOverNu(result, measure, model) {
  const entries = finestSplits(result, measure).filter(s => s.model === model).sort((a, b) => a.poisson_ratio - b.poisson_ratio);
  return entries.length === 0 ? null : {
    name: `${result.key}-split-${measure}-${model}`, ...splitNotes(measure),
    caption: `${result.name}: parts of the error of ${model}, ${measureText(measure)}, ${cellsWords(entries[0].cells)}`,
    make: () => splitBars(measure, entries, entries.map(s => nuText(s.poisson_ratio)), settingWords([result])),
  };
}

function splitOverModels(result, measure, nu) {
  const at = finestSplits(result, measure).filter(s => s.poisson_ratio === nu);
  const entries = models.flatMap(model => at.filter(s => s.model === model));
  return entries.length === 0 ? null : {
    name: `${result.key}-split-${measure}-nu${nuDigits(nu)}`, ...splitNotes(measure),
    caption: `${result.name}: parts of the error, ${measureText(measure)}, ${settingText(result, nu)}, finest cells`,
    make: () => splitBars(measure, entries, entries.map(s => s.model), 'model'),
  };
}

// ---- against the voxel edge

function splitEdgeChart(measure, entries) {
  const {ink, grid} = colors(), {factor, unit} = splitUnit(measure, entries);
  const edges = distinct(entries.map(s => s.voxel_edge_m)), edge = lengthUnit(Math.max(...edges));
  const lines = [...splitParts, {key: 'total', name: 'total', color: ink, marker: 'circle'}].map(({key, name, color, marker}) => {
    const data = entries.filter(s => isNumber(s[key]) && s[key] !== 0).map(s => ({x: edge.factor * s.voxel_edge_m, y: Math.abs(factor * s[key]), negative: s[key] < 0, entry: s}));
    const order = data.length > 1 ? slope(data) : null;
    return {label: order === null ? name : `${name}: order ${minus(order.toFixed(2))}`, data, borderColor: color, backgroundColor: color, pointBorderColor: color,
            pointStyle: marker, borderWidth: key === 'total' ? 2.5 : 2, pointRadius: 5, pointBorderWidth: 2, tension: 0, borderDash: key === 'total' ? [6, 4] : [],
            pointBackgroundColor: context => context.raw && context.raw.negative ? colors().paper : color};
  });
  const options = baseOptions();
  options.plugins.tooltip = {callbacks: {title: items => items.length ? cellsWords(items[0].raw.entry.cells) : '',
    label: ({dataset, raw}) => `${dataset.label}: ${raw.negative ? '−' : ''}${number(raw.y, 3)} ${unit}`}};
  options.scales = {
    x: {type: 'logarithmic', min: edge.factor * Math.min(...edges) / 1.2, max: edge.factor * Math.max(...edges) * 1.2, grid: {color: grid},
        title: {display: true, text: `voxel edge [${edge.unit}]`, color: ink},
        afterBuildTicks: axis => { axis.ticks = edges.map(value => ({value: edge.factor * value})).sort((a, b) => a.value - b.value); },
        ticks: {color: ink, autoSkip: false, maxRotation: 0, callback: value => number(value, 3)}},
    y: logAxis(withUnit(`size of the parts, ${measureText(measure)}`, unit), decades(lines.flatMap(line => line.data.map(p => p.y)), [])),
  };
  return {type: 'line', data: {datasets: lines}, options};
}

/// Null with a single resolution.
function splitOverEdge(result, measure, model, nu) {
  const entries = result.splits.filter(s => s.measure === measure && s.model === model && s.poisson_ratio === nu)
    .sort((a, b) => a.voxel_edge_m - b.voxel_edge_m);
  return distinct(entries.map(s => s.voxel_edge_m)).length < 2 ? null : {
    name: `${result.key}-split-edge-${measure}-${model}-nu${nuDigits(nu)}`,
    caption: `${result.name}: parts of the error of ${model} against the voxel edge, ${measureText(measure)}, ${settingText(result, nu)}`,
    ...splitNotes(measure), notes: ['Sizes without sign; hollow: negative. The order is the slope of a least-squares line.'],
    make: () => splitEdgeChart(measure, entries),
  };
}

// ---- table and section

function splitTable(result, measure) {
  const entries = result.splits.filter(s => s.measure === measure);
  const write = column(measure, entries[0].unit, entries.flatMap(s => [s.total, ...splitParts.map(p => s[p.key])]));
  const sorted = models.flatMap(model => entries.filter(s => s.model === model)
    .sort((a, b) => a.poisson_ratio - b.poisson_ratio || b.voxel_edge_m - a.voxel_edge_m));
  const byFacets = entries.some(s => s.facets > 0);  // of smooth bodies
  return table('splits', ['model', 'ν', 'cells', right('voxel edge'), ...splitParts.map(part => right(part.name)), right('total'), right('uncertainty'),
    ...(byFacets ? [right('of it facets')] : [])],
    sorted.map(s => tr(modelName(s.model), nuText(s.poisson_ratio), cellsText(s.cells), el('td', {class: 'number'}, lengthText(s.voxel_edge_m)),
      splitParts.map(part => el('td', {class: 'number'}, write.text(s[part.key]))), el('td', {class: 'number'}, el('b', {}, write.text(s.total))),
      el('td', {class: 'number'}, isNumber(s.uncertainty) ? '± ' + write.short(s.uncertainty) : '–'),
      byFacets ? [el('td', {class: 'number'}, s.facets > 0 ? '± ' + write.short(s.facets) : '–')] : [])));
}

const measuresOfSplits = result => distinct(result.splits.map(s => s.measure));
const modelsOfSplits = result => models.filter(model => result.splits.some(s => s.model === model));
const nusOfSplits = result => distinct(result.splits.map(s => s.poisson_ratio)).sort((a, b) => a - b);

function splitDrawings(result) {
  return measuresOfSplits(result).flatMap(measure => [
    ...modelsOfSplits(result).map(model => splitOverNu(result, measure, model)),
    ...nusOfSplits(result).map(nu => splitOverModels(result, measure, nu)),
    ...modelsOfSplits(result).flatMap(model => nusOfSplits(result).map(nu => splitOverEdge(result, measure, model, nu)))]).filter(Boolean);
}

function splitsSection(section) {
  const having = cases.filter(result => result.splits.length > 0);
  if (having.length === 0) return leaveOut(section);
  const bars = figure(), edges = figure(), numbers = el('div');
  const caseChoice = select('Case', having.map(c => [c.id, c.name]), update);
  const measureChoice = select('Measure', [], draw), modelChoice = select('Model', [], draw), nuChoice = select('ν', [], draw);
  const result = () => having.find(c => c.id === caseChoice.value);

  function update() {
    replaceOptions(measureChoice, measuresOfSplits(result()).map(m => [m, measureText(m)]));
    replaceOptions(modelChoice, [[allModels, allModels + ' at this ν'], ...modelsOfSplits(result()).map(m => [m, m])]);
    replaceOptions(nuChoice, nusOfSplits(result()).map(nu => [String(nu), nuText(nu)]));
    draw();
  }
  function draw() {
    const measure = measureChoice.value, model = modelChoice.value, nu = Number(nuChoice.value), all = model === allModels;
    const upper = all ? splitOverModels(result(), measure, nu) : splitOverNu(result(), measure, model);
    const lower = all ? null : splitOverEdge(result(), measure, model, nu);
    for (const [plot, drawing] of [[bars, upper], [edges, lower]]) {
      plot.node.hidden = !drawing;
      if (drawing) plot.draw(drawing);
    }
    numbers.replaceChildren(splitTable(result(), measure));
  }
  section.append(
    el('p', {class: 'lead'}, 'A model’s error in three parts.'),
    el('ul', {class: 'parts'}, splitParts.map(({name, color, meaning}) => el('li', {}, el('i', {class: 'swatch', style: {background: color}}),
       el('b', {}, name), meaning.slice(name.length) + '.'))),
    el('div', {class: 'choices'}, caseChoice.node, measureChoice.node, modelChoice.node, nuChoice.node),
    bars.node, edges.node, el('details', {class: 'fold'}, el('summary', {}, 'The numbers'), numbers));
  update();
  charts.push(draw);
  return {show(id) { if (having.some(c => c.id === id)) { caseChoice.value = id; update(); } },
          has: id => having.some(c => c.id === id), drawings: splitDrawings};
}
