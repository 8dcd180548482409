'use strict';
// Cracks of drying bodies: pictures from above, fragments and energy against drying.

function crackPicture(record) {
  const bytes = new TextEncoder().encode(record.svg);
  const source = 'data:image/svg+xml;base64,' + btoa(Array.from(bytes, b => String.fromCharCode(b)).join(''));
  return el('figure', {class: 'crack'},
    el('img', {src: source, alt: `cracks of ${record.model} seen from above`}),
    el('figcaption', {}, `${record.model}, ${cellsText(record.cells)}`));
}

const crackCurves = [['fragments', 'fragments of the top'], ['broken', 'share of the springs broken'], ['released', 'energy released [J]']];

function crackChart(records, [key, title]) {
  const {ink, grid} = colors();
  const datasets = records.map(record => Object.assign(
    lineDataset(record.model, record.model, record.shrinkage.map((x, i) => ({x: 100 * x, y: record[key][i]}))), {pointRadius: 0}));
  const options = baseOptions();
  options.scales = {
    x: {type: 'linear', min: 0, title: {display: true, text: 'shrinkage at the top [%]', color: ink}, grid: {color: grid}, ticks: {color: ink}},
    y: {type: 'linear', min: 0, title: {display: true, text: title, color: ink}, grid: {color: grid}, ticks: {color: ink}},
  };
  return {type: 'line', data: {datasets}, options};
}

const finestCracks = result => {
  const finest = Math.max(...result.cracks.map(record => cellCount(record.cells)));
  return result.cracks.filter(record => cellCount(record.cells) === finest);
};

const crackDrawing = (result, curve) => ({
  name: `${result.key}-cracks-${curve[0]}`,
  caption: `${result.name}: ${curve[1]} against drying`,
  notes: ['Means over the samples, at the finest resolution.'],
  make: () => crackChart(finestCracks(result), curve),
});

const crackDrawings = result => result.cracks.length === 0 ? [] : crackCurves.map(curve => crackDrawing(result, curve));

function cracksSection(section) {
  const having = cases.filter(result => result.cracks.length > 0);
  if (having.length === 0) return leaveOut(section);
  const pictures = el('div', {class: 'cracks'}), curve = figure();
  const caseChoice = select('Case', having.map(c => [c.id, c.name]), draw);
  const curveChoice = select('Curve', crackCurves.map(([key, title]) => [key, title]), draw);

  function draw() {
    const result = having.find(c => c.id === caseChoice.value);
    pictures.replaceChildren(...(picturesOf(result).cracks || []).map(crackPicture));
    curve.draw(crackDrawing(result, crackCurves.find(([key]) => key === curveChoice.value)));
  }
  section.append(el('p', {class: 'lead'}, 'The first sample of each model, from above. Grey: intact springs of the top layer, displaced; strokes: across the ' +
      'broken springs of open cracks in the upper half, dark red the first to break, orange the last.'),
    el('div', {class: 'choices'}, caseChoice.node, curveChoice.node), pictures, curve.node);
  draw();
  charts.push(draw);
  return {show(id) { caseChoice.value = id; draw(); }, has: id => having.some(c => c.id === id), drawings: crackDrawings};
}
