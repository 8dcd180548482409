'use strict';
// Motion in time: the recorded quantities of every model, beside its equilibrium where the case has it.

const stillName = model => model.replace(/ in motion$/, '');

/// Names of the quantities that a case recorded, in their order.
const historyNames = result => distinct(result.histories.flatMap(record => record.names));

/// The value at rest of a quantity, from the rows of the same model's equilibrium.
function valueAtRest(result, record, name) {
  const row = result.rows.find(r => r.measure === name && r.model === stillName(record.model) && r.model !== record.model &&
    r.poisson_ratio === record.poisson_ratio && cellsText(r.cells) === cellsText(record.cells));
  return row ? row.value : null;
}

function motionChart(result, nu, name) {
  const {ink, grid} = colors();
  const records = result.histories.filter(record => String(record.poisson_ratio) === nu && record.names.includes(name));
  const several = distinct(records.map(record => cellsText(record.cells))).length > 1;
  const datasets = records.flatMap(record => {
    const values = record.values[record.names.indexOf(name)], still = valueAtRest(result, record, name);
    const label = record.model + (several ? `, ${cellsText(record.cells)}` : '');
    const count = cells => cells.reduce((product, n) => product * Math.max(n, 1), 1);
    const fine = records.every(other => other.model !== record.model || count(other.cells) <= count(record.cells));
    const plain = {pointRadius: 0, pointHitRadius: 6, borderWidth: fine ? 2 : 1, borderDash: fine ? [] : [2, 2]};
    const moving = Object.assign(lineDataset(record.model, label, record.time.map((x, i) => ({x, y: values[i]}))), plain);
    if (still === null) return [moving];
    const end = record.time[record.time.length - 1];
    return [moving, Object.assign(lineDataset(record.model, `${stillName(record.model)} at rest`, [{x: 0, y: still}, {x: end, y: still}]),
                                  plain, {borderDash: [5, 3]})];
  });
  const unit = records.length > 0 ? records[0].units[records[0].names.indexOf(name)] : '';
  const options = baseOptions();
  options.plugins.tooltip = {callbacks: {title: () => '', label: ({dataset, raw}) => `${dataset.label}: ${number(raw.y, 4)} at ${number(raw.x, 4)} s`}};
  options.scales = {
    x: {type: 'linear', title: {display: true, text: 'time [s]', color: ink}, grid: {color: grid}, ticks: {color: ink}},
    y: {type: 'linear', title: {display: true, text: `${name.replace(/_/g, ' ')}${unit && unit !== '1' ? ` [${unit}]` : ''}`, color: ink},
        grid: {color: grid}, ticks: {color: ink, callback: value => number(value, 3)}},
  };
  return {type: 'line', data: {datasets}, options};
}

function motionDrawing(result, nu, name) {
  const steps = distinct(result.histories.filter(record => String(record.poisson_ratio) === nu)
    .map(record => `${record.integrator}, ${number(1000 * record.time_step, 3)} ms`));
  return {
    name: `${result.key}-motion-${name}-nu${nuDigits(Number(nu))}`,
    caption: `${result.name}: ${name.replace(/_/g, ' ')} in time, ${settingText(result, Number(nu))}`,
    notes: [`Steps: ${steps.join('; ')}. ` +
            'Dotted: fewer cells. Dashed: the same model at rest under the whole load. Of several disordered networks the first is drawn.'],
    make: () => motionChart(result, nu, name),
  };
}

/// What is measured of a motion, with its heading; errors and uncertainties are those of the rows of the same name.
const motionMeasures = [...(results.motion_measures || []), ['motion_error', 'difference in time']];

function motionCell(result, record, name) {
  const value = record.measured[name];
  if (name === 'motion_error') {
    const {uncertainty} = record.measured;
    return isNumber(value) ? percent(100 * value) : isNumber(uncertainty) ? `± ${percent(100 * uncertainty)}` : '–';
  }
  if (!isNumber(value)) return '–';
  if (name.endsWith('_drift')) return number(value, 2);
  const rows = result.rows.filter(r => r.measure === `motion.${name}` && r.poisson_ratio === record.poisson_ratio && isNumber(r.reference));
  const own = rows.find(r => r.model === record.model && cellsText(r.cells) === cellsText(record.cells));
  if (own) return `${number(value)} (${own.error < 0 ? '−' : '+'}${percent(100 * Math.abs(own.error / own.reference))})`;
  return number(value) + (rows.length > 0 ? ` ± ${percent(100 * rows[0].reference_uncertainty / Math.abs(rows[0].reference))}` : '');
}

function motionTable(result, nu) {
  const records = result.histories.filter(record => String(record.poisson_ratio) === nu);
  const has = (record, name) => isNumber(record.measured[name]) || (name === 'motion_error' && isNumber(record.measured.uncertainty));
  const shown = motionMeasures.filter(([name]) => records.some(record => has(record, name)));
  return table('motions', ['model', 'cells', 'integrator', right('step [ms]'), ...shown.map(([, heading]) => right(heading))],
    records.map(record => tr(modelName(record.model), cellsText(record.cells), record.integrator, el('td', {class: 'number'}, number(1000 * record.time_step, 3)),
      shown.map(([name]) => el('td', {class: 'number'}, motionCell(result, record, name))))));
}

const historyNus = result => distinct(result.histories.map(record => record.poisson_ratio)).sort((a, b) => a - b).map(String);

const motionDrawings = result => historyNus(result).flatMap(nu => historyNames(result).map(name => motionDrawing(result, nu, name)));

function motionSection(section) {
  const having = cases.filter(result => result.histories.length > 0);
  if (having.length === 0) return leaveOut(section);
  const chart = figure(), measured = el('div');
  const caseChoice = select('Case', having.map(c => [c.id, c.name]), update);
  const nuChoice = select('ν', [], draw), quantityChoice = select('Quantity', [], draw);
  const result = () => having.find(c => c.id === caseChoice.value);

  function update() {
    replaceOptions(nuChoice, historyNus(result()).map(nu => [nu, settingOption(result(), Number(nu))]));
    replaceOptions(quantityChoice, historyNames(result()).map(name => [name, name.replace(/_/g, ' ')]));
    draw();
  }
  function draw() {
    chart.draw(motionDrawing(result(), nuChoice.value, quantityChoice.value));
    measured.replaceChildren(motionTable(result(), nuChoice.value));
  }
  section.append(el('p', {class: 'lead'}, 'The models in time, and finite elements where the case asks for them ([reference] in_time); the bodies above play the models’ motion.'),
    el('div', {class: 'choices'}, caseChoice.node, nuChoice.node, quantityChoice.node), chart.node, measured);
  update();
  charts.push(draw);
  return {show(id) { caseChoice.value = id; update(); }, has: id => having.some(c => c.id === id), drawings: motionDrawings};
}
