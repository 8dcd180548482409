'use strict';
// Printed finite element values beside ours: on the paper's mesh (fem_q1), and converged.

/// Printed values of a case that a predicate picks: those that are gated, then those that are only shown.
function printedValues(result, wanted) {
  const gated = result.checks.filter(check => check.source === 'published' && wanted(check))
    .map(check => ({...check, printed: check.expected, remark: `gated, ± ${quantity(check.within, check.measure, check.unit, 2)}`}));
  const shown = result.published.filter(wanted).map(item => ({...item, printed: item.published, verdict: null}));
  return [...gated, ...shown].sort((a, b) => a.poisson_ratio - b.poisson_ratio);
}

function convergedValue(result, {measure, poisson_ratio}) {
  return result.references.find(record => record.measure === measure && record.poisson_ratio === poisson_ratio);
}

/// Ours, and below it how far from the printed value: in percent of it, or in points where values are percentages.
function besidePrinted(ours, uncertainty, {printed, measure, unit}) {
  if (!isNumber(ours)) return el('td', {class: 'number'}, '–');
  const points = inPercent(measure, unit);
  const off = points ? 100 * (ours - printed) : 100 * (ours / printed - 1);
  const text = points ? `${signed(off, number(off, 2))} points` : signed(off, percent(off));
  const doubt = isNumber(uncertainty) ? ` ± ${quantity(uncertainty, measure, unit, 2)}` : '';
  return el('td', {class: 'number'}, quantity(ours, measure, unit) + doubt, el('small', {}, Math.abs(off) < 1e-4 ? 'equal' : text));
}

function caseCell(result, {where}) {
  return el('td', {title: result.experiment.what}, el('a', {href: '#' + result.id}, where), el('small', {}, result.name));
}

function columnRow(result, item) {
  const cells = result.experiment.body.cells[0];
  const row = findRow(result, item.measure, {model: 'fem_q1', cells, poisson_ratio: item.poisson_ratio});
  const limit = convergedValue(result, item);
  return tr(caseCell(result, item), el('td', {class: 'measure'}, measureText(item.measure)),
    nuText(item.poisson_ratio), el('td', {class: 'number'}, quantity(item.printed, item.measure, item.unit)),
    besidePrinted(row && row.value, null, item), besidePrinted(limit && limit.value, limit && limit.uncertainty, item),
    el('td', {}, item.verdict ? verdictChip(item.verdict) : null, ' ', item.remark));
}

/// Distances of a model from the printed finite elements; ours are from the converged reference.
function distanceRow(result, item) {
  const cells = result.experiment.body.cells[0], at = {cells, poisson_ratio: item.poisson_ratio};
  const cell = (measure, model) => {
    const row = findRow(result, measure, {model, ...at});
    return el('td', {class: 'number'}, row ? fixed(row.value, 4) + ' m' : '–',
              row ? el('small', {}, '± ' + number(row.reference_uncertainty, 2)) : null);
  };
  return tr(caseCell(result, item), modelName(item.model), nuText(item.poisson_ratio),
    el('td', {class: 'number'}, `${item.printed} m`), cell('section_axis_distance', item.model), cell('section_distance', item.model),
    cell('section_axis_distance', 'fem_q1'), el('td', {}, item.verdict ? verdictChip(item.verdict) : null, ' ', item.remark));
}

function femColumnSection(section) {
  const rows = cases.flatMap(result => printedValues(result, item => item.model === 'fem_q1').map(item => columnRow(result, item)));
  const distances = cases.flatMap(result => printedValues(result, item => item.measure.startsWith('section_'))
    .map(item => distanceRow(result, item)));
  leaveOut(section, rows.length + distances.length === 0);
  if (rows.length > 0) section.append(
    el('p', {class: 'lead'}, 'What the paper’s finite elements (LS-Dyna, hypoelastic) printed, ours on its mesh with eight-node bricks ' +
       '(B-bar), and ours converged with its uncertainty; below each its difference from the printed value. Converged values lie ' +
       'lower: eight-node bricks on this mesh are too stiff. Gated values agree within half of the last printed digit and what ' +
       'the mesh is off.'),
    table('fem-column', ['printed', 'quantity', 'ν', right('paper'), right('ours, paper’s mesh'), right('ours, converged'),
                         'what differs, and why'], rows));
  if (distances.length > 0) section.append(el('h4', {}, 'Mean distance of the model from the finite elements in the middle layer'),
    table('fem-column', ['printed', 'model', 'ν', right('paper'), right('ours, per coordinate'), right('ours, length'),
                         right('eight-node bricks, per coordinate'), 'what differs, and why'], distances));
}
