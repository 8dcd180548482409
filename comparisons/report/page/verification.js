'use strict';
// The reference alone: benchmarks with known answers, and observed orders against exact fields.

/// The element that a name in [[expect]] stands for.
function elementOf(result, model) {
  return model === 'fem' ? (result.experiment.reference?.elements || [])[0] : model.replace(/^fem_/, '');
}

function recordOf(result, check) {
  const element = elementOf(result, check.model);
  return result.references.find(r => r.element === element && r.measure === check.measure &&
    r.poisson_ratio === check.poisson_ratio) || null;
}

const elementNames = {q1: 'Q1 hexahedra', q2: 'Q2 hexahedra', p1: 'P1 tetrahedra', p2: 'P2 tetrahedra'};
const elementCell = element => el('td', {title: elementNames[element]}, String(element).toUpperCase());
const orderText = order => isNumber(order) ? minus(order.toFixed(2)) : 'none';
const caseLink = result => el('a', {href: '#' + result.id}, el('b', {}, result.name));

// ---- benchmarks

function benchmarkRow(result, check) {
  const record = recordOf(result, check), {measure, unit} = check;
  const shown = displayUnit(measure, unit, [check.expected, check.computed]);
  const text = (x, digits = 5) => number(isNumber(x) ? shown.factor * x : x, digits);
  const off = isNumber(check.computed) && check.expected !== 0 ? 100 * (check.computed / check.expected - 1) : null;
  const beyond = record && isNumber(check.computed) && Math.abs(check.computed - check.expected) > record.uncertainty;
  const within = check.expected !== 0 ? percent(100 * check.within / Math.abs(check.expected)) : text(check.within, 2);
  return el('tr', {},
    el('td', {}, withUnit(measureText(measure), shown.unit),
       el('small', {}, [check.source, check.where].filter(Boolean).join(', '))),
    el('td', {}, nuText(check.poisson_ratio)), elementCell(elementOf(result, check.model)),
    [0, 1, 2].map(i => el('td', {class: 'number'}, record ? text(record.values[i]) : '–',
                          record ? el('small', {}, cellsText(record.cells[i])) : '')),
    el('td', {class: 'number'}, record ? orderText(record.observed_order) : '–'),
    el('td', {class: 'number'}, el('b', {}, text(check.computed)),
       record ? el('small', {}, '± ' + text(record.uncertainty, 2)) : ''),
    el('td', {class: 'number'}, text(check.expected)),
    el('td', {class: 'number'}, off === null ? '–' : signed(off, percent(off)), el('small', {}, 'of ± ' + within),
       beyond ? el('small', {}, 'beyond our uncertainty') : []),
    el('td', {}, verdictChip(check.verdict)));
}

function benchmarkRows(result) {
  const checks = result.checks.filter(check => !check.at_least);
  if (checks.length === 0) return [];
  return [el('tr', {class: 'group'}, el('td', {colspan: 11}, caseLink(result), el('small', {}, result.experiment.cite || ''))),
    ...checks.map(check => benchmarkRow(result, check))];
}

function benchmarkPart() {
  const rows = verifications.flatMap(benchmarkRows);
  if (rows.length === 0) return [];
  return [el('h3', {}, 'Benchmarks'),
    el('p', {class: 'note'}, 'Published or exact values beside the finite element limit: values on three grids, the observed ' +
       'order, the extrapolated limit with its uncertainty, and its distance from the target beside the tolerance.'),
    table('benchmarks', ['quantity', 'ν', 'element', right('coarse'), right('medium'), right('fine'), right('order'),
      right('limit'), right('target'), right('difference'), 'verdict'], rows)];
}

// ---- orders

const theory = element => 1 + Number(element[1]);   // L2 norm of the displacement, degree + 1

function orderRow(result, record) {
  const check = result.checks.find(c => c.at_least && c.measure === 'displacement_error_order' &&
    c.poisson_ratio === record.poisson_ratio && elementOf(result, c.model) === record.element);
  const coarse = Math.log2(record.values[0] / record.values[1]);
  return tr(elementCell(record.element), caseLink(result), nuText(record.poisson_ratio),
    record.values.map((error, i) => el('td', {class: 'number'}, number(error, 3), el('small', {}, cellsText(record.cells[i])))),
    el('td', {class: 'number'}, orderText(coarse)),
    el('td', {class: 'number'}, el('b', {}, orderText(record.observed_order))),
    el('td', {class: 'number'}, String(theory(record.element))),
    check ? verdictChip(check.verdict) : el('small', {}, 'shown, not judged'));
}

function orderPart() {
  const records = verifications.filter(result => result.experiment.exact).flatMap(result =>
    result.references.filter(r => r.measure === 'displacement_error').map(record => ({result, record})));
  if (records.length === 0) return [];
  const place = ({record}) => Object.keys(elementNames).indexOf(record.element);
  records.sort((a, b) => place(a) - place(b) || a.result.name.localeCompare(b.result.name) ||
    a.record.poisson_ratio - b.record.poisson_ratio);
  return [el('h3', {}, 'Orders of convergence'),
    el('p', {class: 'note'}, 'Manufactured solutions: |u − u_exact| / |u_exact| in the L2 norm on three grids, each of half the ' +
       'cell size of the one before; the order is that of the two finest.'),
    table('orders', ['element', 'case', 'ν', right('coarse'), right('medium'), right('fine'), right('order, coarse'),
      right('order'), right('theory'), 'verdict'], records.map(({result, record}) => orderRow(result, record)))];
}

// ---- calibration

const kindNames = {hexahedra: 'hexahedra', tetrahedra: 'tetrahedra', 'near-incompressible': 'ν ≥ 0.45', 'finite strain': 'finite strain', all: 'all'};
const numberCell = text => el('td', {class: 'number'}, text);
const shareText = share => percent(100 * share.inside / share.quantities);

function outsideRow(q) {
  const shown = displayUnit(q.measure, q.unit, [q.known, q.value]);
  const text = (x, digits = 6) => number(shown.factor * x, digits);
  return tr(q.case, nuText(q.poisson_ratio), elementCell(q.element), withUnit(measureText(q.measure), shown.unit),
    numberCell(text(q.value)), numberCell('± ' + text(q.uncertainty, 2)), numberCell(text(q.known)),
    numberCell(number(Math.abs(q.value - q.known) / q.uncertainty, 3)), q.where, q.note);
}

function calibrationPart() {
  const calibration = results.calibration;
  if (!calibration) return [];
  const outside = calibration.quantities.filter(q => Math.abs(q.value - q.known) > q.uncertainty);
  return [el('h3', {}, 'Are the stated uncertainties right?'),
    el('p', {class: 'note'}, 'Quantities of the reference whose values are exact, or known from far finer grids: how many lie within their stated ' +
       'uncertainty, and |error| / uncertainty. A median far below 1 means bars that are too wide.'),
    table('calibration', ['reference', right('quantities'), right('inside'), right('share'), right('median |error| / uncertainty'), right('largest')],
      calibration.shares.map(s => tr(kindNames[s.kind], numberCell(String(s.quantities)), numberCell(String(s.inside)), numberCell(shareText(s)),
        numberCell(number(s.median_ratio, 2)), numberCell(number(s.largest_ratio, 3))))),
    outside.length === 0 ? [] : [el('h4', {}, 'Outside their uncertainty'),
      table('outside', ['case', 'ν', 'element', 'quantity', right('value'), right('uncertainty'), right('known'), right('|error| / uncertainty'), 'known from', 'how'],
        outside.map(outsideRow))]];
}

function verificationSection(section) {
  if (verifications.length === 0 && cases.length > 0) return leaveOut(section);
  if (verifications.length === 0) return section.append(notice('No verification case was run.'));
  section.append(el('p', {class: 'lead'}, 'Can the reference itself be trusted? Finite elements alone, against answers that ' +
    'are known.'), ...[benchmarkPart(), orderPart(), calibrationPart()].flat(Infinity));
}
