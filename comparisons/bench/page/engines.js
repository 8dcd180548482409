'use strict';
// The section on real-time engines: tip error against Poisson's ratio, damping and spin against the step, all numbers.

const engineResults = results.engines ? results.engines.results : [];
const engineNames = distinct(engineResults.map(r => r.engine));
const isOurEngine = name => engineResults.some(r => r.engine === name && r.ours);
const percentText = x => signed(x, fixed(100 * x, 1)) + ' %';
const stepText = r => !isNumber(r.time_step_s) ? '' : [`1/${Math.round(1 / r.time_step_s)} s`, r.iterations > 1 ? `× ${r.iterations}` : '', r.integrator || ''].filter(Boolean).join(' ');

/// A line of an engine, ours heavy.
function engineLine(name, label, data) {
  const i = engineNames.indexOf(name), color = palette[i % palette.length], ours = isOurEngine(name);
  return {type: 'line', label, data, borderColor: color, backgroundColor: color, borderWidth: ours ? 4 : 1.5, borderDash: ours ? [] : dashes[i % 3],
          pointStyle: markers[i % markers.length], pointRadius: ours ? 6 : 4, order: ours ? 0 : 1};
}

function engineAxes(x, y) {
  const {ink, grid} = colors(), axis = title => ({type: 'linear', title: {display: true, text: title, color: ink}, ticks: {color: ink}, grid: {color: grid}});
  return {x: axis(x), y: axis(y)};
}

function tipChart(cells) {
  const rows = engineResults.filter(r => r.quantity === 'tip' && r.cells === cells && isNumber(r.error));
  const options = baseOptions();
  options.scales = engineAxes('Poisson’s ratio', 'error of the tip [%]');
  options.plugins.tooltip = {callbacks: {label: ({raw, dataset}) => `${dataset.label}: ${number(raw.y, 3)} %`}};
  const datasets = distinct(rows.map(r => r.engine)).map(name => engineLine(name, name, rows.filter(r => r.engine === name).map(r => ({x: r.poisson_ratio, y: 100 * r.error})).sort((a, b) => a.x - b.x)));
  return {type: 'line', data: {datasets}, options};
}

/// A quantity of the motion against the step; engines of several numbers of iterations have several lines.
function byStepChart(quantity, title, scale) {
  const rows = engineResults.filter(r => r.quantity === quantity && isNumber(r.value) && r.time_step_s);
  const lineOf = r => r.ours ? r.engine : [r.engine, r.iterations > 1 ? `× ${r.iterations}` : '', r.integrator === 'explicit' ? 'explicit' : ''].filter(Boolean).join(' ');
  const options = baseOptions();
  options.scales = engineAxes('time step [ms]; springs of ours take safe substeps', title);
  const datasets = distinct(rows.map(lineOf)).map(label => {
    const own = rows.filter(r => lineOf(r) === label);
    return engineLine(own[0].engine, label, own.map(r => ({x: 1000 * r.time_step_s, y: scale * r.value})).sort((a, b) => a.x - b.x));
  });
  return {type: 'line', data: {datasets}, options};
}

/// Rows by engine (and step), columns by `column`.
function enginePivot(section, title, rows, rowOf, columnOf, text) {
  if (rows.length === 0) return;
  const columns = distinct(rows.map(columnOf)), names = distinct(rows.map(rowOf));
  section.append(el('h4', {}, title), table('rows', ['', ...columns.map(c => el('th', {class: 'number'}, c))], names.map(name => {
    const own = rows.filter(r => rowOf(r) === name);
    return tr(own[0].ours ? el('b', {}, name) : name, ...columns.map(c => {
      const r = own.find(s => columnOf(s) === c);
      return el('td', {class: 'number'}, !r ? '' : r.why_not ? (r.why_not === 'burst' ? 'burst' : '–') : text(r));
    }));
  })));
}

function referenceNote(quantity) {
  const found = Object.entries(results.engines.references).filter(([key]) => key.startsWith(quantity + ','));
  return found.length === 0 ? '' : ` Reference: ${found.map(([key, r]) => `${key.slice(quantity.length + 2)}: ${number(r.value, 5)} ± ${number(r.uncertainty, 1)}`).join('; ')}.`;
}

function engineTables(section) {
  const of = quantity => engineResults.filter(r => r.quantity === quantity).sort((a, b) => a.poisson_ratio - b.poisson_ratio || a.cells.length - b.cells.length);
  const named = rows => engineNames.flatMap(name => rows.filter(r => r.engine === name));
  const byNu = r => `ν ${r.poisson_ratio}, ${r.cells}`, engine = r => r.engine, error = r => percentText(r.error);
  const energies = engineResults.filter(r => r.quantity.startsWith('energy'));
  enginePivot(section, 'Energy of prescribed fields over exact', energies, r => `${r.engine}, ν = ${r.poisson_ratio}`, r => r.quantity.slice(8), r => number(r.value, 4));
  for (const [quantity, title] of [['tip', 'Tip of the cantilever under exact nodal loads'], ['tip under its own gravity', 'Tip under the engine’s own gravity'],
                                   ['twist', 'Twist under an end torque'], ['volume change', 'Change of volume under an end pressure']])
    enginePivot(section, `${title}, error.${referenceNote(quantity.startsWith('tip') ? 'tip' : quantity)}`, of(quantity), engine, byNu, error);
  enginePivot(section, 'Tip by step and iterations, ν = 0.25', named(of('tip by step')), engine, stepText, error);
  enginePivot(section, 'Largest less smallest of these errors', of('dependence'), engine, () => 'points', r => fixed(100 * r.value, 1));
  const motion = ['frequency, y + z', 'frequency, y - z', 'damping, y + z', 'damping, y - z', 'spin kept'].flatMap(q => of(q));
  enginePivot(section, `Motion, ν = 0.25.${referenceNote('frequency')}`, motion, r => `${r.engine} ${r.ours ? '' : stepText(r)}`, r => r.quantity,
    r => r.quantity.startsWith('frequency') ? percentText(r.error) : r.quantity === 'spin kept' ? fixed(100 * r.value, 1) + ' %' : fixed(r.value, 4));
  enginePivot(section, 'CPU time per node and step; never judged', of('cost').filter(r => r.poisson_ratio === 0.25), r => `${r.engine} ${stepText(r)}`, r => r.cells, r => `${number(r.value, 3)} µs`);
}

function enginesSection(section) {
  if (engineResults.length === 0) return leaveOut(section);
  section.append(el('p', {class: 'lead'}, 'A bar of 4 × 1 × 1 m, E = 1e6 Pa, clamped at one end. Engines buy robustness at any step, and contact, with the accuracy that they give up; ' +
    'versions move, and corrections are invited. All numbers are of these versions and builds: ' + Object.values(results.engines.versions).join('; ') + '.'));
  if (results.engines.not_measured.length > 0) section.append(el('ul', {class: 'note'}, results.engines.not_measured.map(text => el('li', {}, text))));
  const drawn = (name, caption, make) => {
    const plot = figure();
    plot.node.firstChild.style.height = '460px';
    section.append(el('h4', {}, caption), plot.node);
    const draw = () => plot.draw({name, caption, notes: ['Heavy lines: springs of ours.'], make});
    draw();
    charts.push(draw);
  };
  for (const cells of distinct(engineResults.filter(r => r.quantity === 'tip').map(r => r.cells)))
    drawn(`engines-tip-${cells}`, `Error of the cantilever’s tip against Poisson’s ratio, ${cells} cells`, () => tipChart(cells));
  if (engineResults.some(r => r.quantity === 'spin kept')) {
    drawn('engines-damping', 'Damping of the first vibration against the step', () => byStepChart('damping, y + z', 'share of the critical damping', 1));
    drawn('engines-spin', 'Spin kept after four turns against the step', () => byStepChart('spin kept', '[%]', 100));
  }
  engineTables(section);
}
