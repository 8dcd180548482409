'use strict';
// The page of `springproof bench`: ratios against targets, the roofline, all rows, the machine.

const subjects = distinct(results.rows.map(row => row.subject));
const subjectNames = {dynamics: 'Dynamics: explicit steps', statics: 'Statics: equilibrium', fem: 'The finite element reference', experiments: 'Built-in experiments', engines: 'Real-time engines: checks'};
const limitOf = row => row.target ? row.target.at_least ?? row.target.at_most : null;
const targetText = row => !row.target ? '' : `${'at_least' in row.target ? '≥' : '≤'} ${number(limitOf(row), 3)}`;
const judgedText = row => number(row.judged, 3) + (row.baseline ? '×' : '');
const sizeText = size => size.replace(/\^3/g, '³');
const nameOf = row => [row.what, sizeText(row.size)].filter(Boolean).join(', ');

function outcomeChip(row) {
  const kinds = {met: 'pass', missed: 'fail', 'no result': 'fail'};
  return row.outcome ? chip(kinds[row.outcome], row.outcome) : '';
}

// ---- head

function decorateBenchHead() {
  const {program, machine} = results;
  document.getElementById('version').textContent = `${program.version} · ${machine.processor} · ${program.instruction_set}` + (program.quick ? ' · a quick look, no measurement' : '');
  const judged = results.rows.filter(row => row.target);
  const count = outcome => judged.filter(row => row.outcome === outcome).length;
  document.getElementById('answer').textContent = 'Every figure stands beside its baseline, measured in the same run on the same machine; a target that is missed is shown as missed.';
  document.getElementById('counts').append(...[['pass', 'met', 'targets met'], ['fail', 'missed', 'missed'], ['fail', 'no result', 'without a result']]
    .filter(([, outcome]) => count(outcome) > 0).flatMap(([kind, outcome, words]) => [chip(kind, `${count(outcome)} ${words}`), ' ']));
}

// ---- ratios against targets: how far beyond its target each row is; 1 is the target, to the right is better

const margin = row => 'at_least' in row.target ? row.judged / limitOf(row) : limitOf(row) / Math.max(row.judged, 1e-12);

const barTexts = {
  id: 'barTexts',
  afterDatasetsDraw(chart) {
    const {ctx, chartArea, scales} = chart, {ink, soft} = colors();
    ctx.save();
    const one = scales.x.getPixelForValue(1);
    ctx.strokeStyle = ink;
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    ctx.moveTo(one, chartArea.top);
    ctx.lineTo(one, chartArea.bottom);
    ctx.stroke();
    ctx.font = `12px ${paperFont}`;
    ctx.textBaseline = 'middle';
    chart.getDatasetMeta(0).data.forEach((bar, i) => {
      const row = chart.data.datasets[0].rows[i];
      ctx.fillStyle = ink;
      const text = judgedText(row);
      ctx.textAlign = 'left';
      const at = Math.max(bar.x, one) + 8;
      ctx.fillText(text, at, bar.y);
      const width = ctx.measureText(text + ' ').width;
      ctx.fillStyle = soft;
      ctx.fillText(targetText(row), at + width, bar.y);
    });
    ctx.restore();
  },
};

function barsChart(rows) {
  const {ink, grid} = colors();
  const good = '#009e73', bad = '#d55e00';
  const margins = rows.map(margin), low = Math.min(0.5, ...margins), high = Math.max(2, ...margins);
  const data = {labels: rows.map(nameOf), datasets: [{data: margins.map(m => [1, m]), rows, backgroundColor: rows.map(row => row.outcome === 'met' ? good : bad),
    barPercentage: 0.72, categoryPercentage: 0.9, borderRadius: 2, minBarLength: 2}]};
  const tick = value => [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].some(t => Math.abs(value / t - 1) < 1e-6) ? number(value, 2) + '×' : null;
  const options = {...baseOptions(), indexAxis: 'y', base: 1};
  options.layout = {padding: {right: 24}};
  options.plugins = {legend: {display: false}, tooltip: {displayColors: false, callbacks: {
    title: items => nameOf(rows[items[0].dataIndex]),
    label: ({dataIndex}) => {
      const row = rows[dataIndex];
      return [`${number(row.value, 4)} ${row.unit}`, row.baseline ? `${row.baseline.name}: ${number(row.baseline.value, 4)}` : '', row.note].filter(Boolean);
    }}}};
  options.scales = {
    x: {type: 'logarithmic', min: low / 1.3, max: high * 2.2, grid: {color: context => context.tick && tick(context.tick.value) ? grid : 'transparent'},
        title: {display: true, text: 'times better than the target', color: ink}, ticks: {color: ink, autoSkip: false, maxRotation: 0, callback: tick}},
    y: {grid: {display: false}, ticks: {color: ink, autoSkip: false, font: {size: 12}}}};
  return {type: 'bar', data, options, plugins: [barTexts]};
}

function targetsSection(section) {
  const judged = results.rows.filter(row => row.target && isNumber(row.judged));
  if (judged.length === 0) return leaveOut(section);
  section.append(el('p', {class: 'lead'}, 'How far each figure is beyond its target: right of the line it is met, left of it missed. Beside each bar the figure and its target.'));
  for (const subject of distinct(judged.map(row => row.subject))) {
    const rows = judged.filter(row => row.subject === subject), plot = figure();
    plot.node.firstChild.style.height = `${70 + 24 * rows.length}px`;
    section.append(el('h4', {}, subjectNames[subject] || subject), plot.node);
    const draw = () => plot.draw({name: `bench-${subject}`, caption: `${subjectNames[subject]}: ratios against targets`, notes: [], make: () => barsChart(rows)});
    draw();
    charts.push(draw);
  }
}

// ---- roofline

const levelColor = level => ({L1: '#cc79a7', L2: '#56b4e9', L3: '#e69f00', DRAM: '#d55e00'})[level] || '#8a8f98';

function ceilings(xs) {
  const {memory, arithmetic} = results.machine, top = arithmetic[arithmetic.length - 1].gflops_fp64;
  const [low, high] = xs;
  const slopes = memory.map(level => {
    const knee = top / level.GB_per_s;
    return {label: `${level.name} ${number(level.GB_per_s, 3)} GB/s`, color: levelColor(level.name), width: 2, dash: [],
            data: [[low, low * level.GB_per_s], [Math.min(knee, high), Math.min(top, high * level.GB_per_s)]]};
  });
  const flat = arithmetic.map((a, i) => ({label: `FMA ${a.instruction_set}, ${number(a.gflops_fp64, 3)} GF/s`, color: '#667080', width: i === arithmetic.length - 1 ? 2 : 1,
    dash: i === arithmetic.length - 1 ? [] : [2, 3], data: [[a.gflops_fp64 / memory[0].GB_per_s, a.gflops_fp64], [high, a.gflops_fp64]]}));
  // A spring is 21 operations, of them one root and one division, which take the longest.
  const root = arithmetic.map((a, i) => ({label: `inverse root of a spring, ${a.instruction_set}`, color: '#009e73', width: i === arithmetic.length - 1 ? 2 : 1, dash: [7, 4],
    data: [[low, 21 / a.inverse_root_ns_fp64], [high, 21 / a.inverse_root_ns_fp64]]}));
  return [...slopes, ...flat, ...root];
}

const kindOf = point => point.name.startsWith('plain loop') ? 'plain loop' : point.name;

function rooflineChart(points) {
  const {ink, paper} = colors();
  const x = decades(points.map(p => p.flops_per_byte), []), xs = [x.min, Math.max(x.max, 10)];
  const lines = ceilings(xs).map(line => ({type: 'line', label: line.label, data: line.data.map(([a, b]) => ({x: a, y: b})), borderColor: line.color, backgroundColor: line.color,
    borderWidth: line.width, borderDash: line.dash, pointRadius: 0, pointHitRadius: 0, pointStyle: 'line', order: 5}));
  const kinds = distinct(points.map(kindOf));
  const dots = kinds.map((kind, i) => ({type: 'scatter', label: kind, data: points.filter(p => kindOf(p) === kind).map(p => ({x: p.flops_per_byte, y: p.gflops, p})),
    backgroundColor: palette[i % palette.length], borderColor: paper, borderWidth: 1, pointStyle: markers[i % 4], pointRadius: 7, pointHoverRadius: 9, order: 1}));
  const values = points.map(p => p.gflops).concat(lines.flatMap(line => line.data.map(d => d.y)));
  const y = decades(values, []);
  const options = baseOptions();
  options.plugins.legend.labels.boxWidth = 22;
  options.plugins.tooltip = {filter: item => item.raw && item.raw.p, callbacks: {
    label: ({raw}) => `${raw.p.name}, ${sizeText(raw.p.size)}: ${number(raw.y, 3)} GF/s at ${number(raw.x, 3)} flops per byte, data in ${raw.p.level}`}};
  options.scales = {x: logAxis('operations per byte read or written', {min: xs[0], max: xs[1]}), y: logAxis('GF/s', {min: Math.max(y.min, 0.1), max: y.max})};
  options.color = ink;
  return {type: 'scatter', data: {datasets: [...dots, ...lines]}, options, plugins: [pointSizes]};
}

/// Writes the size beside the last point of each kind.
const pointSizes = {
  id: 'pointSizes',
  afterDatasetsDraw(chart) {
    const {ctx} = chart;
    ctx.save();
    ctx.font = `11px ${paperFont}`;
    ctx.fillStyle = colors().soft;
    ctx.textBaseline = 'middle';
    const taken = [];
    chart.data.datasets.forEach((dataset, i) => {
      if (dataset.type !== 'scatter' || !chart.isDatasetVisible(i)) return;
      chart.getDatasetMeta(i).data.forEach((element, k) => {
        const text = sizeText(dataset.data[k].p.size), width = ctx.measureText(text).width;
        const spot = [[element.x + 11, element.y], [element.x - 11 - width, element.y], [element.x - width / 2, element.y - 15], [element.x - width / 2, element.y + 15]]
          .find(([left, at]) => taken.every(box => left > box[0] + box[2] + 3 || box[0] > left + width + 3 || Math.abs(at - box[1]) > 12));
        if (!spot) return;
        taken.push([...spot, width]);
        ctx.fillText(text, ...spot);
      });
    });
    ctx.restore();
  },
};

function rooflineSection(section) {
  if (results.roofline.length === 0 || results.machine.arithmetic.length === 0) return leaveOut(section);
  const plot = figure();
  plot.node.firstChild.style.height = '560px';
  section.append(el('p', {class: 'lead'}, 'The ceilings are measured in the same run. A slope is the bandwidth of one level of the memory, a flat line the arithmetic; ' +
    'springs need an inverse root each, which is their nearest flat ceiling.'), plot.node);
  const draw = () => plot.draw({name: 'bench-roofline', caption: `Roofline of one core of ${results.machine.processor}`, make: () => rooflineChart(results.roofline),
    notes: ['Operations and bytes are counted by docs/measured/performance.md: each array once per sweep, whatever level holds it. FP32 points have their own, higher ceilings, which are not drawn.']});
  draw();
  charts.push(draw);
}

// ---- rows

function usageCells(row) {
  const share = x => el('td', {class: 'number'}, isNumber(x) ? `${Math.round(100 * x)} %` : '');
  return [el('td', {class: 'number'}, row.usage ? number(row.usage.bytes_per_node, 3) : ''), share(row.usage?.bandwidth_share), share(row.usage?.arithmetic_share)];
}

function benchRow(row) {
  const cells = row.ok
    ? [el('td', {class: 'number'}, number(row.value, 4), el('small', {}, row.unit)),
       el('td', {class: 'number'}, row.baseline ? number(row.baseline.value, 4) : '', row.baseline ? el('small', {}, row.baseline.name) : ''),
       el('td', {class: 'number'}, row.baseline ? el('b', {}, judgedText(row)) : '')]
    : [el('td', {colspan: 3, class: 'lost'}, 'no result')];
  return el('tr', {}, el('td', {}, row.what, row.note ? el('small', {}, row.note) : ''), el('td', {}, sizeText(row.size)), ...cells,
            el('td', {class: 'number'}, targetText(row)), el('td', {}, outcomeChip(row)), ...usageCells(row));
}

function rowsSection(section) {
  const right = text => el('th', {class: 'number'}, text);
  section.append(el('p', {class: 'lead'}, 'The ratio is the baseline over ours, or, where the target is an upper one, ours over the baseline.'));
  for (const subject of subjects) {
    const rows = results.rows.filter(row => row.subject === subject);
    const used = rows.some(row => row.usage);
    const head = ['what', 'size', right('ours'), right('baseline'), right('ratio'), right('target'), ''];
    const body = rows.map(benchRow);
    if (!used) for (const node of body) while (node.children.length > 5 && node.lastChild.textContent === '' && node.lastChild !== node.children[6]) node.lastChild.remove();
    section.append(el('h4', {}, subjectNames[subject] || subject), table('rows', [...head, ...(used ? [right('bytes per node'), right('of the bandwidth'), right('of the arithmetic')] : [])], body));
  }
  if (results.remarks.length > 0) section.append(el('ul', {class: 'note'}, results.remarks.map(text => el('li', {}, text))));
}

// ---- machine

function machineSection(section) {
  const {processor, cores, memory, arithmetic} = results.machine;
  const right = text => el('th', {class: 'number'}, text), cell = (x, unit) => el('td', {class: 'number'}, isNumber(x) && x > 0 ? `${number(x, 3)} ${unit}` : '');
  section.append(el('p', {class: 'lead'}, `${processor}, ${cores} cores. Limits of one core, the best of many short samples.`));
  if (arithmetic.length > 0)
    section.append(table('arithmetic', ['instruction set', right('multiply-adds, FP64'), right('FP32'), right('inverse root, FP64'), right('FP32')],
      arithmetic.map(a => tr(a.instruction_set, cell(a.gflops_fp64, 'GF/s'), cell(a.gflops_fp32, 'GF/s'), cell(a.inverse_root_ns_fp64, 'ns'), cell(a.inverse_root_ns_fp32, 'ns')))));
  section.append(table('memory', ['memory', right('size'), right('one core'), right('all cores')],
    memory.map(m => tr(m.name, cell(m.bytes / 1024, 'KiB'), cell(m.GB_per_s, 'GB/s'), cell(m.GB_per_s_all_cores, 'GB/s')))),
    el('p', {class: 'note'}, 'Caches: read. DRAM: triad, the line that a store reads first counted (32 bytes per element). Charts: Chart.js 3.9 (MIT licence).'));
}

function startBench() {
  decorateBenchHead();
  Chart.defaults.font.family = paperFont;
  Chart.defaults.font.size = 13;
  for (const [id, make] of [['targets', targetsSection], ['roofline', rooflineSection], ['engines', enginesSection], ['rows', rowsSection], ['machine', machineSection]]) {
    const section = document.getElementById(id);
    try {
      make(section);
    } catch (error) {
      console.error(error);
      section.append(notice(`This section could not be drawn: ${error.message}`));
    }
  }
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { for (const draw of charts) draw(); });
}

startBench();
