'use strict';
// Strain and stress along a line, beside Kelvin's solution.

const lineComponents = ['xx', 'yy', 'zz', 'xy', 'yz', 'xz'];

const componentAt = (tensors, component) => tensors.filter((_, i) => i % 6 === component);

/// Points of one profile; the place on the line in percent.
function linePoints(record, values) {
  const end = record.distance[record.distance.length - 1];
  return values.map((y, i) => ({x: 100 * record.distance[i] / end, y}));
}

/// The values near the force run off the figure: its axis is that of the middle of the line.
function lineLimits(records, datasets) {
  const from = records[0].first;
  const values = datasets.flatMap(({data}) => data.filter(point => point.x >= from).map(point => point.y)).filter(isNumber);
  const low = Math.min(0, ...values), high = Math.max(0, ...values);
  return low < high ? {min: 1.05 * low, max: 1.05 * high} : {min: -1, max: 1};
}

function lineChart(records, quantityName, component, unit) {
  const {ink, grid} = colors();
  const plain = {pointRadius: 0, pointHitRadius: 6, borderWidth: 1.5};
  const ours = records.filter(record => record[quantityName].length > 0).map(record =>
    Object.assign(lineDataset(record.model, record.model, linePoints(record, componentAt(record[quantityName], component))), plain));
  const exact = Object.assign(lineDataset('', 'Kelvin', linePoints(records[0], componentAt(records[0]['exact_' + quantityName], component))),
    plain, {borderColor: ink, backgroundColor: ink, pointBorderColor: ink, pointStyle: 'line', borderWidth: 2, borderDash: [5, 3]});
  const datasets = [...ours, exact];
  const options = baseOptions();
  options.plugins.tooltip = {callbacks: {title: () => '', label: ({dataset, raw}) => `${dataset.label}: ${number(raw.y, 3)}`}};
  const limits = lineLimits(records, datasets);
  options.scales = {
    x: {type: 'linear', min: 0, max: 100, title: {display: true, text: 'place on the line [%]', color: ink}, grid: {color: grid}, ticks: {color: ink}},
    y: {type: 'linear', ...limits, title: {display: true, text: `${quantityName} ${lineComponents[component]}${unit}`, color: ink},
        grid: {color: grid}, ticks: {color: ink, includeBounds: false, callback: value => number(value, 3)}},
  };
  return {type: 'line', data: {datasets}, options};
}

function lineDrawing(result, quantityName, component) {
  const finest = Math.max(...result.lines.map(record => cellCount(record.cells)));
  const records = result.lines.filter(record => cellCount(record.cells) === finest);
  return {
    name: `${result.key}-line-${quantityName}-${lineComponents[component]}-nu${nuDigits(records[0].poisson_ratio)}`,
    caption: `${result.name}: ${quantityName} ${lineComponents[component]} along the line, ${settingText(result, records[0].poisson_ratio)}`,
    notes: [`Deviations are means over the points ${records[0].first} to ${records[0].last}; of several disordered networks the first is drawn.`],
    make: () => lineChart(records, quantityName, component, quantityName === 'stress' ? ' [Pa]' : ''),
  };
}

const lineDrawings = result => result.lines.length === 0 ? [] :
  ['strain', 'stress'].flatMap(quantityName => lineComponents.map((_, i) => lineDrawing(result, quantityName, i)));

function lineSection(section) {
  const having = cases.filter(result => result.lines.length > 0).sort((a, b) => b.models.length - a.models.length);
  if (having.length === 0) return leaveOut(section);
  const strain = figure(), stress = figure();
  const caseChoice = select('Case', having.map(c => [c.id, c.name]), draw);
  const componentChoice = select('Component', lineComponents.map((name, i) => [String(i), name]), draw);
  componentChoice.value = '3';

  function draw() {
    const result = having.find(c => c.id === caseChoice.value), component = Number(componentChoice.value);
    strain.draw({...lineDrawing(result, 'strain', component), notes: []});
    stress.draw(lineDrawing(result, 'stress', component));
  }
  section.append(el('p', {class: 'lead'}, 'Strain and stress inside the models beside Kelvin’s solution, from the point force (0) to the end of the line (100).'),
    el('div', {class: 'choices'}, caseChoice.node, componentChoice.node), strain.node, stress.node);
  draw();
  charts.push(draw);
  return {show(id) { caseChoice.value = id; draw(); }, has: id => having.some(c => c.id === id), drawings: lineDrawings};
}
