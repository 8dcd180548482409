'use strict';
// Section: simulated values beside measured ones, by ASME V&V 20.

/// In % of D, or of S where D is awaited: a difference above 0 makes the value larger.
const baseOf = v => isNumber(v.measured) ? v.measured : v.simulated;
const ofMeasured = (v, x) => isNumber(x) && baseOf(v) ? 100 * x / baseOf(v) : null;
const change = (v, x) => isNumber(ofMeasured(v, x)) ? signed(x / baseOf(v), fixed(ofMeasured(v, x), 1)) : '–';
const spread = (v, u) => isNumber(ofMeasured(v, u)) ? fixed(Math.abs(ofMeasured(v, u)), 1) : '–';

/// E with u_val on both sides; a line at 0.
function measuredChart(values) {
  const {ink, grid} = colors();
  const points = values.map(v => ({x: v.name, y: ofMeasured(v, v.error), value: v}));
  const errors = {type: 'line', label: 'E ± 2 u_val', data: points, showLine: false, borderColor: '#0072b2', backgroundColor: '#0072b2',
                  pointRadius: 5, pointStyle: points.map(({value}) => isNumber(value.ratio) && value.ratio <= 2 ? 'circle' : 'rectRot'),
                  whiskers: values.map(v => isNumber(v.u_val) ? 2 * Math.abs(ofMeasured(v, v.u_val)) : null)};
  const reach = 10 * Math.ceil(Math.max(...points.map((p, i) => Math.abs(p.y) + (errors.whiskers[i] || 0)), 1) / 10);
  const options = baseOptions();
  options.plugins.legend.display = false;
  options.plugins.tooltip = {callbacks: {label: ({raw}) => `E = ${change(raw.value, raw.value.error)} %, |E|/u_val = ${number(raw.value.ratio, 2)}`}};
  options.scales = {
    x: {type: 'category', labels: values.map(v => v.name), offset: true, grid: {display: false}, ticks: {color: ink, autoSkip: false}},
    y: {min: -reach, max: reach, title: {display: true, text: 'E = S − D [% of D]', color: ink},
        grid: {color: context => context.tick && context.tick.value === 0 ? ink : grid}, ticks: {color: ink, callback: value => number(value, 3)}},
  };
  return {type: 'line', data: {datasets: [errors]}, options, plugins: [whiskers]};
}

const measuredDrawing = result => ({
  name: `${result.key}-measured`,
  caption: `${result.name}: simulation − measurement, ${result.validation[0].model}`,
  notes: ['The bars are 2 u_val on both sides: where one reaches 0, no error of the model shows. Values that an input was fitted to are left out.'],
  make: () => measuredChart(result.validation.filter(v => isNumber(v.ratio))),
});

/// Samples of a history in time: measured within 2 u_D, simulated.
function historyChart(values) {
  const {ink, grid, band, soft} = colors();
  const {unit, factor} = displayUnit(values[0].quantity, values[0].unit, values.flatMap(v => [v.simulated, v.measured]));
  const at = of => values.map(v => ({x: v.time, y: isNumber(of(v)) ? factor * of(v) : null}));
  const edge = {pointRadius: 0, borderWidth: 0, backgroundColor: band, borderColor: band};
  const measured = {type: 'line', label: 'measured', data: at(v => v.measured), borderColor: ink, backgroundColor: ink, pointRadius: 5, showLine: false};
  const simulated = {...lineDataset(values[0].model, values[0].model, at(v => v.simulated)), pointRadius: 3};
  const options = baseOptions();
  options.plugins.legend.labels = {...options.plugins.legend.labels, filter: item => item.text !== ''};
  options.plugins.tooltip = {callbacks: {title: () => '', label: ({dataset, raw}) => `${dataset.label}: ${number(raw.y, 4)} ${unit} at ${number(raw.x, 4)} s`}};
  options.scales = {
    x: {type: 'linear', title: {display: true, text: 'time under the load [s]', color: ink}, grid: {color: grid}, ticks: {color: ink}},
    y: {title: {display: true, text: `${values[0].quantity.replace(/_/g, ' ')} [${unit}]`, color: ink}, grid: {color: grid},
        ticks: {color: ink, callback: value => number(value, 3)}},
  };
  return {type: 'line', options, data: {datasets: [measured, simulated,
    {...edge, label: 'measured ± 2 u_D', data: at(v => v.measured + 2 * v.u_measured), fill: '+1', borderColor: soft},
    {...edge, label: '', data: at(v => v.measured - 2 * v.u_measured)}]}};
}

const historyDrawings = result => distinct(result.validation.map(v => v.history)).filter(Boolean).map((name, i) => ({
  name: `${result.key}-measured-history-${i + 1}`,
  caption: `${result.name}: ${name}, measured and by ${result.validation[0].model}`,
  notes: [`${name}: the shaded band is 2 u_D on both sides of what was measured.`],
  make: () => historyChart(result.validation.filter(v => v.history === name && isNumber(v.measured))),
}));

function validationTable(values) {
  const write = unit => column('', unit, values.filter(v => v.unit === unit).flatMap(v => [v.simulated, v.measured]).filter(isNumber));
  const row = v => {
    const {unit, text} = write(v.unit), outside = isNumber(v.ratio) && v.ratio > 2;
    return tr(v.name, v.load_case, text(v.simulated), isNumber(v.measured) ? text(v.measured) : 'awaited', unit, change(v, v.error), spread(v, v.u_numerical),
      v.fitted ? '' : spread(v, v.u_input), spread(v, v.u_measured), v.fitted ? '' : spread(v, v.u_val),
      v.fitted ? chip('', 'fitted') : !isNumber(v.ratio) ? '–' : chip(outside ? 'fail' : 'pass', v.ratio.toFixed(1)));
  };
  return table('numbers', ['value', 'load case', 'S', 'D', 'unit', 'E [%]', 'u_num [%]', 'u_input [%]', 'u_D [%]', 'u_val [%]', '|E|/u_val'],
    values.filter(v => v.fitted).concat(values.filter(v => !v.fitted)).map(row));
}

function sharesTable(values) {
  const names = distinct(values.flatMap(v => v.inputs.map(i => i.input)));
  const input = (v, name) => { const found = v.inputs.find(i => i.input === name); return found ? change(v, found.change) : ''; };
  const line = (name, of) => tr(name, ...values.map(of));
  return table('numbers', ['% of D', ...values.map(v => v.name)], [
    line('springs: beside finite elements on the same cells', v => change(v, v.springs)),
    line('cells: the finest beside their limit', v => change(v, v.resolution)),
    ...names.map(name => line((values.some(v => v.inputs.some(i => i.input === name && i.alternative)) ? 'instead: ' : '') + name, v => input(v, name))),
    line('data: u_D', v => spread(v, v.u_measured)),
    line('E', v => change(v, v.error))]);
}

function measuredSection(section) {
  const having = cases.filter(result => result.validation.length > 0);
  if (having.length === 0) return leaveOut(section);
  for (const result of having) {
    const plot = figure();
    section.append(...(having.length > 1 ? [el('h3', {}, result.name)] : []),
      el('p', {class: 'lead'}, result.validated),
      validationTable(result.validation), plot.node,
      el('p', {class: 'note'}, 'S: simulated, in the limit of the lattices; D: measured; E = S − D; u: standard uncertainties, u_val² = u_num² + u_input² + u_D² (ASME V&V 20). ' +
         'Rows of one fit or one load are not independent.'),
      el('h3', {}, 'Whose share'), sharesTable(result.validation.filter(v => !v.fitted)),
      el('p', {class: 'note'}, 'An input is changed by its uncertainty; of values beside a fitted one only what the fit does not answer to is shown. “Instead” is another choice, not part of u_input. ' +
         distinct(result.validation.map(v => `Measured: ${v.source}; ${v.licence}.`)).join(' ')));
    const curves = historyDrawings(result).map(drawing => ({drawing, node: figure()}));
    plot.node.after(...curves.map(({node}) => node.node));
    const draw = () => {
      plot.draw(measuredDrawing(result));
      for (const {drawing, node} of curves) node.draw(drawing);
    };
    charts.push(draw);
    draw();
  }
  return {has: id => having.some(c => c.id === id), show: () => {},
          drawings: result => result.validation.length > 0 ? [measuredDrawing(result), ...historyDrawings(result)] : []};
}
