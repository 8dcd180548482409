'use strict';
// Share of the load up to which the equilibrium of each model is stable, against Poisson's ratio.

/// Of a run of springs at rest: the share of the load that it reached [%]; null: it has no such result.
function keptLoad(run) {
  if (run.kind !== 'msm') return null;
  const reached = run.ok ? 1 : (run.stability || {}).lost ? run.stability.load_reached : null;
  return isNumber(reached) ? 100 * reached : null;
}

/// Runs of models at rest of which it is known what they bore.
const restingRuns = result => result.runs.filter(run => keptLoad(run) !== null && !isMoving(result, run.model));
const losesEquilibrium = result => restingRuns(result).some(run => !run.ok);
const finestOf = result => cellsText(restingRuns(result).reduce((a, b) => cellCount(b.cells) > cellCount(a.cells) ? b : a).cells);

function stabilityChart(result, cells) {
  const {ink, grid} = colors(), runs = restingRuns(result).filter(run => cellsText(run.cells) === cells);
  const nus = distinct(runs.map(run => run.poisson_ratio)).sort((a, b) => a - b);
  const datasets = distinct(runs.map(run => run.model)).map(model => ({clip: false, ...lineDataset(model, model, nus.map(nu => {
    const run = runs.find(r => r.model === model && r.poisson_ratio === nu);
    return {x: nuText(nu), y: run ? keptLoad(run) : null, run};
  }))}));
  const options = baseOptions();
  options.plugins.tooltip = {callbacks: {title: items => items.length ? `${settingText(result, items[0].raw.run.poisson_ratio)}` : '',
    label: ({dataset, raw}) => raw.run.ok ? `${dataset.label} bears the whole load` : `${dataset.label} up to ${percent(raw.y)} of the load`,
    afterLabel: ({raw}) => raw.run.ok ? [] : [raw.run.message]}};
  options.scales = {
    x: {type: 'category', labels: nus.map(nuText), offset: true, title: {display: true, text: settingWords([result]), color: ink}, grid: {color: grid}, ticks: {color: ink}},
    y: {type: 'linear', min: 0, max: 100, title: {display: true, text: 'stable up to [% of the load]', color: ink}, grid: {color: grid}, ticks: {color: ink}},
  };
  return {type: 'line', data: {datasets}, options, plugins: withLineEnds(options, datasets)};
}

const stabilityDrawing = (result, cells) => ({
  name: `${result.key}-stable-load`,
  caption: `${result.name}: share of the load up to which equilibria are stable, ${cellsWords(restingRuns(result).find(run => cellsText(run.cells) === cells).cells)}`,
  notes: ['A model at 100 % bears the whole load. Where a line ends below, what happens there is told by the warnings.'],
  make: () => stabilityChart(result, cells),
});

const stabilityDrawings = result => losesEquilibrium(result) ? [stabilityDrawing(result, finestOf(result))] : [];

function stabilitySection(section) {
  const having = cases.filter(losesEquilibrium);
  if (having.length === 0) return leaveOut(section);
  const plot = figure();
  const caseChoice = select('Case', having.map(c => [c.id, c.name]), update);
  const cellsChoice = select('Cells', [], draw);
  const chosen = () => having.find(c => c.id === caseChoice.value);

  function update() {
    const all = distinct(restingRuns(chosen()).map(run => cellsText(run.cells)));
    replaceOptions(cellsChoice, all.map(text => [text, cellsWords(restingRuns(chosen()).find(run => cellsText(run.cells) === text).cells)]));
    cellsChoice.value = finestOf(chosen());
    draw();
  }
  function draw() {
    plot.draw(stabilityDrawing(chosen(), cellsChoice.value));
  }
  section.append(el('p', {class: 'lead'}, 'The load is raised until a state is no longer a stable equilibrium: neighbours move against each other, a cell is turned inside out, or the body buckles.'),
    el('div', {class: 'choices'}, caseChoice.node, cellsChoice.node), plot.node);
  update();
  charts.push(draw);
  return {show(id) { caseChoice.value = id; update(); }, has: id => having.some(c => c.id === id), drawings: stabilityDrawings};
}
