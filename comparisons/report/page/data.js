'use strict';
// The results, the words and numbers they are shown in, and the one function that makes elements.
// Text reaches the page as text nodes only, so nothing in a case file can act as markup.

function readJson(id) {
  return JSON.parse(document.getElementById(id).textContent);
}

const results = readJson('results-data');

// ---- elements

function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key === 'style') Object.assign(node.style, value);
    else node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.flat(Infinity).filter(child => child !== null && child !== undefined && child !== ''));
  return node;
}

function table(className, head, rows) {
  return el('div', {class: 'scroll'},
    el('table', {class: className},
      el('thead', {}, el('tr', {}, head.map(cell => cell instanceof Node ? cell : el('th', {}, cell)))),
      el('tbody', {}, rows)));
}

/// Takes a section out of the page and of its contents.
function leaveOut(section, hidden = true) {
  section.hidden = hidden;
  for (const link of document.querySelectorAll(`#contents a[href="#${section.id}"]`)) link.hidden = hidden;
}

function tr(...cells) {
  return el('tr', {}, cells.flat().map(cell => cell instanceof Node && /^T[DH]$/.test(cell.tagName) ? cell
    : el('td', {}, cell)));
}

function chip(kind, text) {
  return el('span', {class: 'chip ' + kind}, text);
}

/// A labelled <select>; options are [value, text] or {group, options}.
function select(label, options, onchange) {
  const option = ([value, text]) => el('option', {value}, text);
  const box = el('select', {onchange: () => onchange(box.value)}, options.map(entry =>
    entry.group ? el('optgroup', {label: entry.group}, entry.options.map(option)) : option(entry)));
  const node = el('label', {class: 'choice'}, el('span', {}, label), box);
  return {node, box, get value() { return box.value; }, set value(v) { box.value = v; }};
}

function replaceOptions(choice, options) {
  const before = choice.value;
  choice.box.replaceChildren(...options.map(([value, text]) => el('option', {value}, text)));
  if (options.some(([value]) => value === before)) choice.value = before;
  choice.node.hidden = options.length === 0;
}

// ---- numbers

const isNumber = x => typeof x === 'number' && Number.isFinite(x);

function superscript(n) {
  return String(n).replace(/./g, c => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] || '⁻');
}

const minus = text => text.replace(/-/g, '−');

/// A number with so many significant digits: 3 396, 0.0254, 1.2·10⁻⁷.
function number(x, digits = 4) {
  if (!isNumber(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size < 1e-3 || size >= 1e7) {
    const [mantissa, exponent] = x.toExponential(Math.max(0, digits - 2)).split('e');
    return minus(mantissa) + '·10' + superscript(Number(exponent));
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return grouped(x.toLocaleString('en', {maximumFractionDigits: decimals, useGrouping: size >= 1e4}));
}

/// Poisson's ratio with at most six significant digits.
const nuDigits = nu => String(Number(nu.toPrecision(6)));
const nuText = nu => isNumber(nu) ? minus(nuDigits(nu)) : '–';

const grouped = text => minus(text.replace(/,/g, '\u202f'));

function fixed(x, decimals) {
  return grouped(x.toLocaleString('en', {minimumFractionDigits: decimals, maximumFractionDigits: decimals,
                                         useGrouping: Math.abs(x) >= 1e4}));
}

/// Percent, two digits.
function percent(x) {
  if (!isNumber(x)) return '–';
  if (Math.abs(x) < 1e-3) return x === 0 ? '0 %' : '< 0.001 %';
  return minus(Math.abs(x) >= 99.5 ? x.toFixed(0) : x.toPrecision(2)) + ' %';
}

const signed = (x, text) => (x > 0 && !text.startsWith('<') ? '+' : '') + text;

const isDistance = measure => /^displacement_error(_max)?$|^stress_error\.|^(reaction|motion)_error$|_distance$|^line\.\w+\.(all|[xyz]{2})$/.test(measure);
const inPercent = (measure, unit) => unit === '1' && /^displacement|^(reaction|motion|stress)_error|^volume|^line/.test(measure) && !/[_.]order$/.test(measure);

/// The unit a set of values is shown in: percent, a fitting length unit, or the unit itself.
function displayUnit(measure, unit, values) {
  if (inPercent(measure, unit)) return {factor: 100, unit: '%'};
  const size = Math.max(0, ...values.filter(isNumber).map(Math.abs));
  if (unit === 'm') return lengthUnit(size);
  return {factor: 1, unit: unit === '1' ? '' : unit};
}

function quantity(x, measure, unit, digits = 4) {
  if (!isNumber(x)) return '–';
  const shown = displayUnit(measure, unit, [x]);
  return [number(shown.factor * x, digits), shown.unit].filter(Boolean).join(' ');
}

/// Writes the values of one table in one unit with one number of decimals (five digits of the largest).
function column(measure, unit, values) {
  const shown = displayUnit(measure, unit, values);
  const top = shown.factor * Math.max(0, ...values.filter(isNumber).map(Math.abs));
  const decimals = top > 0 ? 4 - Math.floor(Math.log10(top)) : 0;
  const plain = top === 0 || (decimals >= -3 && decimals <= 9);
  const text = x => !isNumber(x) ? '–' : x === 0 ? '0' : plain ? fixed(shown.factor * x, Math.max(0, decimals))
    : number(shown.factor * x, 5);
  return {unit: shown.unit, text, short: x => number(shown.factor * x, 2)};
}

function seconds(t) {
  if (!isNumber(t)) return '–';
  return t < 60 ? number(t, 2) + ' s' : `${Math.floor(t / 60)} min ${Math.round(t % 60)} s`;
}

/// The unit that suits a length, or a stress, of this size.
const fittingUnit = (size, units, si) => units.map(([factor, unit]) => ({factor, unit})).find(({factor}) => size * factor >= 1) || {factor: 1, unit: si};
const lengthUnit = size => fittingUnit(size, [[1, 'm'], [1e3, 'mm'], [1e6, 'µm'], [1e9, 'nm']], 'm');
const stressUnit = size => fittingUnit(size, [[1e-9, 'GPa'], [1e-6, 'MPa'], [1e-3, 'kPa']], 'Pa');

// ---- cells and measures

/// [812, 0, 0] stands for 812 tetrahedra, which form no grid.
const isTetrahedra = ([n, ...rest]) => n > 0 && rest.length === 2 && rest.every(m => m === 0);
const cellCount = cells => isTetrahedra(cells || []) ? cells[0] : (cells || []).reduce((product, n) => product * n, 1);
const cellsText = cells => isTetrahedra(cells || []) ? `${cells[0]} tets` : (cells || []).join('×');
const cellsWords = cells => cellsText(cells) + (isTetrahedra(cells || []) ? '' : ' cells');
const bySize = (a, b) => cellCount(a) - cellCount(b);

/// Titles and meanings of measures (problem/case_file/measures.cpp).
const measureTable = results.measures || {};
const lineMeanings = {
  'line.strain.all': 'mean |ε − Kelvin’s| over the middle of the line, divided by the mean |Kelvin’s|',
  'line.stress.all': 'mean |σ − Kelvin’s| over the middle of the line, divided by the mean |Kelvin’s|',
};
const measureMeaning = measure => measure.startsWith('torque.') ? 'about the centroid of the patch at rest' : lineMeanings[measure] || (measureTable[measure] || measureTable[measure.split('.')[0]] || {}).meaning;

function measureText(measure) {
  if ((measureTable[measure] || {}).title) return measureTable[measure].title;
  const [what, where, component] = measure.split('.');
  if (what === 'line') return component === 'order' ? `observed order of the ${where} deviation` :
    `${where} deviation${component === 'all' ? '' : ', ' + component}`;
  const words = measureTable[what]?.title || what.replace(/_/g, ' ');
  if (!where) return words;
  if (what === 'stress_error') return `${words}, ${where.replace('_', ' ')}`;
  return `${words} ${/force|torque|reaction|mean/.test(what) ? 'on' : 'at'} ${where}` + (component ? `, ${component}` : '');
}

const distinct = items => [...new Map(items.map(item => [String(item), item])).values()];

// ---- cases

const allCases = (results.cases || []).map(prepareCase);
const cases = allCases.filter(result => !result.verifies);
const isCompared = id => cases.some(result => result.id === id);
const verifications = allCases.filter(result => result.verifies);   // the reference alone, without models
const models = orderModels();

/// A table {columns, named, words, values} as objects; in the named columns values are indices into the words.
function unpack({columns, named, words, values}) {
  const isNamed = columns.map(column => named.includes(column));
  return values.map(line => Object.fromEntries(columns.map((column, i) => [column, isNamed[i] ? words[line[i]] : line[i]])));
}

function prepareCase(data) {
  const experiment = data.experiment || {};
  const key = [experiment.folder, experiment.name].filter(Boolean).join('-').replace(/[^\w-]/g, '_');
  const result = {
    experiment,
    name: experiment.name || '?',
    key, id: 'case-' + key, listed: experiment.listed || {part: '', symbol: 'ν', words: 'Poisson\'s ratio'},
    linear: experiment.kinematics === 'linear',
    verifies: (experiment.models || []).length === 0,
    runs: data.runs || [], rows: unpack(data.rows), references: data.references || [],
    checks: data.checks || [], published: data.published || [], lines: data.lines || [], histories: data.histories || [],
    warnings: data.warnings || [], splits: data.splits || [], deformations: data.deformations || [], cracks: data.cracks || [], regions: data.regions || [], validation: data.validation || [], validated: data.validated || '', notes: data.notes || [],
  };
  const at = item => `${item.model}|${cellsText(item.cells)}|${item.poisson_ratio}`;
  result.runAt = new Map(result.runs.map(run => [at(run), run]));
  result.rowAt = new Map(result.rows.map(row => [row.measure + '|' + at(row), row]));
  result.referenceAt = new Map(result.rows.map(row => [`${row.measure}|${row.poisson_ratio}`, row.reference]));
  const named = distinct(result.rows.map(row => row.measure));
  const leads = measure => isDistance(measure) ? 0 : measure.startsWith('volume') ? 1 : 2;
  result.measures = [0, 1, 2].flatMap(rank => named.filter(measure => leads(measure) === rank));
  result.nus = distinct(result.rows.concat(result.runs).map(row => row.poisson_ratio)).sort((a, b) => a - b);
  // The reference's own runs have no rows; they are not a model that is compared.
  result.models = distinct([...result.runs.filter(run => run.kind !== 'fem'), ...result.rows].map(item => item.model));
  result.cells = distinct(result.rows.map(row => row.cells)).sort(bySize);
  result.scales = new Map(result.measures.map(measure => [measure, errorScale(result, measure)]));
  const forces = forceScale(result);
  result.minor = new Set(result.measures.filter(measure => vanishes(result, measure, forces)));
  for (const measure of result.measures)
    if (!result.minor.has(measure) && repeats(result, measure)) result.minor.add(measure);
  return result;
}

/// What a case lists: Poisson's ratio of the body, or a modulus of a region; "ν = 0.3", "E of tumour = 10000".
const settingText = (result, value) => `${result.listed.symbol} = ${nuText(value)}`;
/// Of several cases those that list the same: Poisson's ratio of the body, if any does.
function ofOneAxis(several) {
  const first = several.find(result => !result.listed.part) || several[0];
  return several.filter(result => result.listed.words === first.listed.words);
}
const settingOption = (result, value) => result.listed.part ? settingText(result, value) : nuText(value);
const settingWords = chosen => chosen.length > 0 && chosen[0].listed.part ? chosen[0].listed.words.replace("'", '’') : 'Poisson’s ratio ν';

function findRun(result, {model, cells, poisson_ratio}) {
  return result.runAt.get(`${model}|${cellsText(cells)}|${poisson_ratio}`);
}

function findRow(result, measure, {model, cells, poisson_ratio}) {
  return result.rowAt.get(`${measure}|${model}|${cellsText(cells)}|${poisson_ratio}`);
}

/// Reference of the magnitude of a vector's component, e.g. of force.z_max.magnitude for force.z_max.x.
function magnitudeOf(result, row) {
  if (!/\.[xyz]$/.test(row.measure)) return null;
  return result.referenceAt.get(`${row.measure.slice(0, -1)}magnitude|${row.poisson_ratio}`) ?? null;
}

/// The largest force in a case [N], torques counted with the body's length as lever.
function forceScale(result) {
  const length = Math.max(0, ...(result.experiment.body?.size || [])) || 1;
  return result.rows.reduce((top, {measure, value}) => !/^(force|torque)\..*magnitude$/.test(measure) ? top :
    Math.max(top, Math.abs(value) / (measure.startsWith('torque') ? length : 1)), 0);
}

/// A measure that is zero up to its reference's uncertainty, or to round-off beside the others: torque in compression.
function vanishes(result, measure, forces) {
  if (isDistance(measure)) return false;
  const length = Math.max(0, ...(result.experiment.body?.size || [])) || 1;
  const beside = measure.startsWith('force.') ? forces : measure.startsWith('torque.') ? forces * length : 0;
  const rows = result.rows.filter(row => row.measure === measure);
  return rows.every(row => Math.abs(row.reference ?? row.value) <=
    Math.max(row.reference_uncertainty || 0, 1e-7 * beside, 1e-7 * (magnitudeOf(result, row) || 0)));
}

/// A reaction that equals an earlier one in size: the other plate's, or the only component of a magnitude.
function repeats(result, measure) {
  if (!/^(force|torque)\./.test(measure)) return false;
  const kind = measure.split('.')[0] + '.';
  const rows = result.rows.filter(row => row.measure === measure);
  const earlier = result.measures.slice(0, result.measures.indexOf(measure)).filter(other => other.startsWith(kind));
  return earlier.some(other => !result.minor.has(other) && rows.every(row => {
    const twin = findRow(result, other, row);
    return twin && Math.abs(Math.abs(twin.value) - Math.abs(row.value)) <= 1e-6 * Math.abs(row.value);
  }));
}

/// How the error of a measure is drawn: percent, percentage points, percent of the reference, or its own unit.
function errorScale(result, measure) {
  const rows = result.rows.filter(row => row.measure === measure);
  const unit = rows[0].unit;
  if (inPercent(measure, unit))
    return {of: x => 100 * x, unit: isDistance(measure) ? '%' : 'percentage points'};
  const compared = rows.filter(row => isNumber(row.reference));
  const clear = (size, row) => isNumber(size) && Math.abs(size) > 10 * (row.reference_uncertainty || 0) && size !== 0;
  if (isDistance(measure) || compared.length === 0) return {of: x => x, unit};
  if (compared.every(row => clear(magnitudeOf(result, row), row)))
    return {of: (x, row) => 100 * x / Math.abs(magnitudeOf(result, row)), unit: '% of the magnitude'};
  if (compared.every(row => clear(row.reference, row)))
    return {of: (x, row) => 100 * x / Math.abs(row.reference), unit: '% of the reference'};
  return {of: x => x, unit};
}

function scaledError(result, row) {
  if (!isNumber(row.error)) return null;
  const error = result.scales.get(row.measure).of(Math.abs(row.error), row);
  return isNumber(error) ? error : null;
}

function scaledUncertainty(result, row) {
  if (!isNumber(row.reference_uncertainty)) return null;
  const uncertainty = result.scales.get(row.measure).of(row.reference_uncertainty, row);
  return isNumber(uncertainty) ? uncertainty : null;
}

function errorText(result, row) {
  if (!isNumber(row.error)) return '–';
  const scale = result.scales.get(row.measure);
  const towards = scale.unit === '% of the reference' ? Math.sign(row.reference) : 1;   // +: larger in size
  const error = towards * scale.of(row.error, row);
  const sign = isDistance(row.measure) ? text => text : text => signed(error, text);
  if (scale.unit === 'percentage points') return sign(number(error, 2)) + ' points';
  if (scale.unit.startsWith('%')) return sign(percent(error));
  return sign(quantity(row.error, row.measure, row.unit, 2));
}

/// Rows of one measure at the finest (or coarsest, or given) cells of each model.
function rowsAt(result, measure, resolution = 'finest') {
  const rows = result.rows.filter(row => row.measure === measure);
  if (resolution !== 'finest' && resolution !== 'coarsest')
    return rows.filter(row => cellsText(row.cells) === resolution);
  const pick = resolution === 'finest' ? Math.max : Math.min;
  const chosen = new Map();
  for (const row of rows) {
    const count = cellCount(row.cells);
    chosen.set(row.model, chosen.has(row.model) ? pick(chosen.get(row.model), count) : count);
  }
  return rows.filter(row => cellCount(row.cells) === chosen.get(row.model));
}

/// The row of largest error of some rows, or null.
function worstOf(result, rows) {
  let worst = null;
  for (const row of rows) {
    const error = scaledError(result, row);
    if (error !== null && (worst === null || error > worst.error)) worst = {row, error};
  }
  return worst;
}

// ---- models and their colours (style.css), told apart by marker too; then dashed

function orderModels() {
  const all = distinct(cases.flatMap(result => result.models));
  return [...all.filter(model => !isFem(model)), ...all.filter(isFem)];
}

function isFem(model) {
  return model.startsWith('fem') || cases.some(c => c.runs.some(run => run.model === model && run.kind === 'fem'));
}

/// The present value of a colour of the style sheet.
const cssColor = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const palette = Array.from({length: 16}, (_, i) => cssColor(`--model-${i}`));
const markers = ['circle', 'triangle', 'rect', 'rectRot', 'star', 'crossRot', 'rectRounded', 'cross'];
const dashes = [[], [7, 4], [2, 3]];

const femMarkers = {fem_q1: 'rectRot', fem_q2: 'rect', fem_p1: 'triangle', fem_p2: 'circle'};

/// These have the same colour in every report; the others take the following ones in their order.
const namedModels = ['hybmss', 'emsm', 'emsm_random', 'msm_18', 'msm_random', 'hybmss_bt', 'hybmss A=1', 'hybmss_fd', 'hybmss_cf', 'hybmss_b'];

/// A model in motion has the style of its equilibrium.
function styleIndex(model) {
  const still = name => name.replace(/ in motion$/, ''), name = still(model);
  if (namedModels.includes(name)) return namedModels.indexOf(name);
  const others = distinct(models.map(still)).filter(other => !namedModels.includes(other) && !isFem(other));
  return namedModels.length + Math.max(0, others.indexOf(name));
}

/// The colour's name in the style sheet; "fem", the reference, is like trilinear elements.
const colorName = model => isFem(model) ? '--' + (femMarkers[model] ? model : 'fem_q1') : `--model-${styleIndex(model) % palette.length}`;

/// For elements of the page, which follow a change of colours, and for canvases, which are drawn anew.
const modelPaint = model => `var(${colorName(model)})`;

function modelStyle(model) {
  const color = cssColor(colorName(model));
  if (isFem(model)) return {color, marker: femMarkers[model] || femMarkers.fem_q1, dash: [6, 4]};
  const index = styleIndex(model);
  return {color, marker: markers[index % markers.length], dash: dashes[Math.min(2, Math.floor(index / markers.length))]};
}

/// The only Poisson's ratio that a model claims in a case, or null: it takes any.
const ownRatio = (result, model) => ((result.experiment.models || []).find(m => m.label === model) || {}).own_poisson_ratio ?? null;
const claims = (result, model, nu) => { const own = ownRatio(result, model); return own === null || Math.abs(own - nu) < 1e-9; };

function modelName(model) {
  return el('span', {class: 'model'}, swatch(model), model);
}

function swatch(model) {
  return el('i', {class: 'swatch', style: {background: modelPaint(model)}});
}
