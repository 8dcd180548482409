'use strict';
// The table of cases and a page per case: problem, reference and its uncertainty, results, tolerances.

const right = (...text) => el('th', {class: 'number'}, text);   // a heading over numbers

// ---- verdicts and tints

const verdictKinds = {'pass': 'pass', 'fail': 'fail', 'reference too coarse': 'coarse', 'no reference': 'none', 'no result': 'none'};
const verdictOrder = ['fail', 'no result', 'reference too coarse', 'no reference', 'pass'];

/// The gravest verdict of a case.
function caseVerdict(result) {
  return verdictOrder.find(verdict => result.checks.some(check => check.verdict === verdict)) || null;
}

function verdictChip(verdict) {
  return verdict ? chip(verdictKinds[verdict] || 'none', verdict) : chip('none', 'no expectations');
}

const tintLimits = [1, 5, 20];   // percent

/// Class of a table cell by the size of its error; none where it is not a percentage.
function tint(result, row) {
  const scale = result.scales.get(row.measure), error = scaledError(result, row);
  if (error === null || !/^%|points/.test(scale.unit)) return '';
  const uncertainty = scaledUncertainty(result, row);
  if (uncertainty !== null && error <= uncertainty) return 'tint0';
  return 'tint' + (1 + tintLimits.filter(limit => error > limit).length);
}

function tintLegend() {
  const entries = [['tint0', 'below the uncertainty of the reference'], ['tint1', 'up to 1 %'], ['tint2', 'up to 5 %'],
                   ['tint3', 'up to 20 %'], ['tint4', 'more']];
  return el('p', {class: 'note legend'}, entries.map(([kind, text]) => el('span', {}, el('i', {class: 'sample ' + kind}), text)));
}

// ---- table of cases

/// Differences from the reference's displacements: at rest, and of probes over the whole motion.
const displacementRows = result => ['displacement_error', 'motion_error'].flatMap(measure => rowsAt(result, measure));

/// Those by which models are judged: of reactions where no displacement was compared.
function judgedRows(result) {
  const rows = displacementRows(result);
  return rows.length > 0 ? rows : rowsAt(result, 'reaction_error');
}

/// The largest of a model.
const worstJudged = (result, model) => worstOf(result, judgedRows(result).filter(row => row.model === model));

function worstCell(result, model) {
  const worst = worstJudged(result, model);
  const failed = result.runs.filter(run => run.model === model && !run.ok).length;
  const lost = failed ? el('small', {class: 'lost'}, `${failed} without result`) : null;
  if (!worst) return el('td', {class: 'number'}, failed ? lost : '–');
  const reaction = worstReaction(result, model), worse = reaction && reaction.error > worst.error ? reaction : worst;
  return el('td', {class: 'number ' + tint(result, worse.row)}, percent(worst.error),
            el('small', {}, `${settingText(result, worst.row.poisson_ratio)}`), reactionNote(result, model), lost);
}

/// The largest reaction error of a model, where a support is moved.
const worstReaction = (result, model) => worstOf(result, rowsAt(result, 'reaction_error').filter(row => row.model === model));

function reactionNote(result, model) {
  const worst = worstReaction(result, model);
  return worst && displacementRows(result).length > 0 ? el('small', {}, `reactions ${percent(worst.error)}`) : null;
}

function worstUncertainty(result) {
  const all = judgedRows(result).map(row => scaledUncertainty(result, row)).filter(isNumber);
  return all.length > 0 ? percent(Math.max(...all)) : '–';
}

function heldText(result) {
  const held = result.checks.filter(check => check.verdict === 'pass').length;
  return result.checks.length > 0 ? `${held} of ${result.checks.length} hold` : null;
}

/// The closest model and those of most cases get a column each, the others share one.
function splitModels() {
  const closest = closestModels, byCases = model => cases.filter(c => c.models.includes(model)).length;
  const leading = [...models].sort((a, b) => closest.includes(b) - closest.includes(a) || byCases(b) - byCases(a)).slice(0, models.length > 6 ? 5 : 6);
  return {leading, others: models.filter(m => !leading.includes(m))};
}

function otherModel(result, model) {
  const worst = worstJudged(result, model);
  const failed = result.runs.some(run => run.model === model && !run.ok);
  return worst ? `${model}: ${percent(worst.error)}` : failed ? `${model}: without result` : null;
}

function caseRow(result, {leading, others}) {
  const {experiment} = result;
  return el('tr', {},
    el('td', {title: experiment.what}, el('a', {href: '#' + result.id}, el('b', {}, result.name)),
       el('small', {}, experiment.folder)),
    el('td', {}, verdictChip(caseVerdict(result)), el('small', {}, heldText(result))),
    el('td', {}, experiment.kinematics || '–',
       el('small', {}, seconds(result.runs.reduce((sum, run) => sum + (run.set_up_seconds || 0) + (run.seconds || 0), 0)))),
    el('td', {class: 'number'}, '± ' + worstUncertainty(result)),
    leading.map(model => worstCell(result, model)),
    others.length > 0 ? el('td', {class: 'others'}, others.map(model => otherModel(result, model)).filter(Boolean).map(text => el('small', {}, text))) : null);
}

function casesSection(section) {
  const split = splitModels();
  const head = ['Case', 'Expectations', 'Kinematics, time', right('Reference'),
                ...split.leading.map(model => right(modelName(model))), ...(split.others.length > 0 ? ['Other models'] : [])];
  section.append(
    el('p', {class: 'lead'}, 'Per model the largest displacement error over all Poisson’s ratios, at the finest resolution (of models in motion, the probes’ difference in time), and the largest reaction error where a support is moved; ' +
       'beside it the largest uncertainty of the reference, and the time of all runs.'),
    table('cases', head, cases.map(result => caseRow(result, split))), tintLegend());
}

// ---- problem

function definition(term, ...content) {
  const parts = content.flat().filter(part => part !== null && part !== undefined && part !== '');
  return parts.length > 0 ? [el('dt', {}, term), el('dd', {}, parts)] : [];
}

const vectorText = v => `(${v.map(x => number(x)).join(', ')})`;

function bodyText({geo, size = [], cells = []}, units) {
  const edges = size.every(s => s > 0) && size.length === 3
    ? `${size.map(s => number(units === 'mm' ? 1e3 * s : s)).join(' × ')} ${units || 'm'}` : '';
  return [geo, edges, cells.length > 0 ? 'cells ' + cells.map(cellsText).join(', ') : ''].filter(Boolean).join('; ');
}

function materialText(materials = [], weighs, units) {
  const mm = units === 'mm';
  const moduli = distinct(materials.map(m => mm ? 1e-6 * m.youngs_modulus : m.youngs_modulus)),
    densities = weighs ? distinct(materials.map(m => mm ? 1e-12 * m.density : m.density)) : [];
  const list = values => values.map(v => number(v)).join(', ');
  return `E = ${list(moduli)} ${mm ? 'MPa' : 'Pa'}; ν = ${materials.map(m => nuText(m.poisson_ratio)).join(', ')}` +
    (weighs ? `; density ${list(densities)} ${mm ? 't/mm³' : 'kg/m³'}` : '');
}

const bullets = items => items.length > 0 ? el('ul', {}, items.map(item => el('li', {}, item))) : null;

function kinematicsText(result) {
  const law = result.experiment.kinematics;
  return result.linear ? 'linear (small displacements)' : `finite; the reference follows the law “${law}”, the springs their own`;
}

function modelText({name, label, options = {}, own_poisson_ratio, made_of}) {
  const list = Object.entries(options).map(([key, value]) => `${key} = ${value}`).join(', ');
  return [modelName(label || name), list && (label || name) !== list ? ` ${list}` : '', made_of ? `: ${made_of}` : '',
    isNumber(own_poisson_ratio) ? ` (a solid of ν = ${nuText(own_poisson_ratio)} alone)` : ''];
}

function problemPart(result) {
  const e = result.experiment;
  return [el('h4', {}, 'Problem'), el('dl', {},
    definition('Question', e.what),
    definition('Source', e.cite),
    definition('Body', e.body ? bodyText(e.body, e.units) : ''),
    definition('Meshes and cells', bullets(result.notes)),
    definition('Material', (e.materials || []).length > 0 ? materialText(e.materials, (e.loads || []).some(load => load.includes('gravity')), e.units) : ''),
    definition('Regions', regionsPart(result)),
    definition('Loads', bullets(e.loads || [])),
    definition('Kinematics', e.kinematics ? kinematicsText(result) : ''),
    definition('Models', bullets((e.models || []).map(modelText))),
    definition('Measures', (e.measures || []).map(measureText).join('; ')),
    definition('Probes', (e.probes || []).map(p => `${p.name} at ${vectorText(p.at)} m`).join('; ')),
    definition('Section', e.section ? `through ${vectorText(e.section.point)} m, normal ${vectorText(e.section.normal)}` : ''))];
}

// ---- reference

const withUnit = (text, unit) => unit ? `${text} [${unit}]` : text;

function referenceTable(result, measure, records) {
  const unit = records[0].unit;
  const write = column(measure, unit, records.flatMap(record => [...record.values, record.value]));
  const columns = Math.max(...records.map(record => record.values.length));
  const grids = Array.from({length: columns}, (_, i) => distinct(records.map(record => cellsText(record.cells[i]))));
  const elements = distinct(records.map(record => record.element));
  const line = record => tr(elements.length > 1 ? el('td', {}, elementNames[record.element] || record.element) : [], nuText(record.poisson_ratio),
    grids.map((names, i) => el('td', {class: 'number'}, write.text(record.values[i]),
                               names.length > 1 ? el('small', {}, cellsText(record.cells[i])) : '')),
    el('td', {class: 'number'}, isNumber(record.observed_order) ? minus(record.observed_order.toFixed(2)) : 'none'),
    el('td', {class: 'number'}, el('b', {}, write.text(record.value))),
    el('td', {class: 'number'}, '± ' + write.short(record.uncertainty)), record.note);
  return [el('h5', {}, withUnit(measureText(measure), write.unit)),
    table('reference', [...(elements.length > 1 ? ['element'] : []), result.listed.symbol, ...grids.map((names, i) => right(names.length > 1 ? `grid ${i + 1}` : names[0] || `grid ${i + 1}`)),
                        right('observed order'), right('value'), right('uncertainty'), 'how'], records.map(line))];
}

function referencePart(result) {
  const measures = distinct(result.references.map(record => record.measure));
  const tables = list => list.map(measure => referenceTable(result, measure, result.references.filter(r => r.measure === measure)));
  return [el('h4', {}, 'Reference and its uncertainty'),
    measures.length === 0 ? notice('There is no record of a reference for this case.')
      : el('p', {class: 'note'}, 'Finite elements on successively finer grids; where their values fall into a regular ' +
           'sequence, the limit is extrapolated (Richardson), and the uncertainty is the grid convergence index.'),
    tables(measures.filter(m => !result.minor.has(m))),
    minorFold(measures.filter(m => result.minor.has(m)), tables), deformationTable(result)];
}

/// A sum of forces; components that are round-off beside the larger sum are 0.
function forceCell({applied_N: applied = [], reacted_N: reacted = []}, sum = []) {
  const size = Math.max(...[...applied, ...reacted].map(Math.abs), 0);
  return el('td', {class: 'number'}, sum.length === 3 ? vectorText(sum.map(x => Math.abs(x) < 1e-9 * size ? 0 : x)) : '–');
}

/// Size of the deformation of the reference; amber where linear theory does not hold.
function deformationTable(result) {
  if (result.deformations.length === 0) return null;
  const limits = {principal_strain: 0.05, rotation_deg: 5};
  const cell = (d, key, text) => el('td', {class: 'number' + (result.linear && d[key] > limits[key] ? ' coarse' : '')}, text);
  return [el('h5', {}, 'Largest principal strain and rotation', el('small', {}, '99 % of the volume stay below' +
      (result.linear ? '; linear theory is for a few per cent and a few degrees: marked beyond 5 % or 5°' : ''))),
    table('deformation', [result.listed.symbol, right('principal strain'), right('rotation'), right('loads applied [N]'), right('supports react with [N]')], result.deformations.map(d => tr(nuText(d.poisson_ratio),
      cell(d, 'principal_strain', percent(100 * d.principal_strain)), cell(d, 'rotation_deg', number(d.rotation_deg, 2) + '°'),
      forceCell(d, d.applied_N), forceCell(d, d.reacted_N))))];
}

/// What to know of a case before its numbers are believed.
const warningsOf = result => result.warnings.map(warning => el('p', {}, el('span', {class: 'amber'}, warning + '.')));

function minorFold(measures, tables) {
  return measures.length === 0 ? null : el('details', {class: 'fold'},
    el('summary', {}, `Measures that vanish here or repeat another in size: ${measures.length}`), tables(measures));
}

// ---- results

function resultCell(result, measure, at, write) {
  const row = findRow(result, measure, at);
  if (row) {
    const attributes = {class: 'number ' + tint(result, row), title: `${row.value} ${row.unit}`};
    if (isDistance(measure)) return el('td', attributes, inPercent(measure, row.unit) ? percent(100 * row.value) : write.text(row.value));
    return el('td', attributes, write.text(row.value), isNumber(row.error) ? el('small', {}, errorText(result, row)) : null);
  }
  const run = findRun(result, at);
  return run && !run.ok ? el('td', {class: 'number lost', title: run.message}, 'no result') : el('td', {class: 'number'}, '–');
}

function referenceLine(result, measure, write) {
  const cells = result.nus.map(nu => {
    const row = result.rows.find(r => r.measure === measure && r.poisson_ratio === nu && isNumber(r.reference_uncertainty)) ||
      result.rows.find(r => r.measure === measure && r.poisson_ratio === nu && isNumber(r.reference));
    if (!row) return el('td', {class: 'number'}, '–');
    return el('td', {class: 'number'}, isDistance(measure) ? '' : write.text(row.reference),
              el('small', {}, isNumber(row.reference_uncertainty) ? '± ' + write.short(row.reference_uncertainty) : ''));
  });
  return el('tr', {class: 'reference-line'}, el('th', {scope: 'row'}, 'reference'), el('td', {}, ''), cells);
}

function resolutionsOf(result, model) {
  return distinct([...result.rows, ...result.runs].filter(item => item.model === model).map(item => item.cells)).sort(bySize);
}

function resultTable(result, measure) {
  const rows = result.rows.filter(row => row.measure === measure);
  const write = column(measure, rows[0].unit, rows.flatMap(row => [row.value, row.reference]));
  const lines = models.filter(model => result.models.includes(model)).flatMap(model =>
    resolutionsOf(result, model).map((cells, i) => el('tr', {class: i === 0 ? 'group' : ''},
      el('th', {scope: 'row'}, i === 0 ? modelName(model) : ''), el('td', {}, cellsText(cells)),
      result.nus.map(nu => resultCell(result, measure, {model, cells, poisson_ratio: nu}, write)))));
  const scale = result.scales.get(measure).unit;
  const small = isDistance(measure) || !rows.some(row => isNumber(row.error)) ? '' : `below each value its error${scale.startsWith('%') ? ' in ' + scale : ''}`;
  return [el('h5', {}, withUnit(measureText(measure), write.unit),
             el('small', {}, [measureMeaning(measure), small].filter(Boolean).join('; '))),
    table('results', ['model', 'cells', ...result.nus.map(nu => right(`${settingText(result, nu)}`))],
          [referenceLine(result, measure, write), ...lines])];
}

function resultsPart(result) {
  const tables = list => list.map(measure => resultTable(result, measure));
  return [el('h4', {}, 'Results'), result.measures.length === 0 ? notice('No run of this case gave a result.')
    : [tables(result.measures.filter(m => !result.minor.has(m))),
       minorFold(result.measures.filter(m => result.minor.has(m)), tables), tintLegend()]];
}

// ---- expectations, published values, runs

function expectedText({measure, unit, expected, within, at_least}) {
  if (at_least) return `≥ ${quantity(expected, measure, unit)}`;
  const tolerance = quantity(within, measure, unit, 2);
  return isDistance(measure) && expected === 0 ? `≤ ${tolerance}` : `${quantity(expected, measure, unit)} ± ${tolerance}`;
}

function checkRow(check) {
  const {measure, unit} = check;
  const off = isNumber(check.computed) ? Math.abs(check.computed - check.expected) : null;
  return tr(verdictChip(check.verdict), modelName(check.model), nuText(check.poisson_ratio), cellsText(check.cells),
    el('td', {class: 'measure'}, measureText(measure)),
    el('td', {class: 'number'}, expectedText(check)),
    el('td', {class: 'number'}, quantity(check.computed, measure, unit)),
    el('td', {class: 'number'}, off !== null && check.within > 0 ? percent(100 * off / check.within) : '–'),
    el('td', {class: 'number'}, isNumber(check.reference_uncertainty) ? '± ' + quantity(check.reference_uncertainty, measure, unit, 2) : '–'),
    el('td', {class: 'measure'}, [check.source, check.where].filter(Boolean).join(', ')));
}

function checksTable(result, checks) {
  return table('checks', ['verdict', 'model', result.listed.symbol, 'cells', 'measure', right('expected'), right('computed'),
    right('of the tolerance'), right('uncertainty of the reference'), 'source'], checks.map(checkRow));
}

/// All checks if they are few; if many, those that pass are folded away.
function checksPart(result) {
  const checks = [...result.checks].sort((a, b) => verdictOrder.indexOf(a.verdict) - verdictOrder.indexOf(b.verdict));
  const open = checks.length > 16 ? checks.filter(check => check.verdict !== 'pass') : checks;
  const held = checks.length > 16 ? checks.filter(check => check.verdict === 'pass') : [];
  return [el('h4', {}, 'Expectations'), checks.length === 0 ? notice('This case states no expectations.') : null,
    open.length > 0 ? checksTable(result, open) : null,
    held.length > 0 ? el('details', {class: 'fold'}, el('summary', {}, `${held.length} expectations hold`), checksTable(result, held)) : null];
}

function publishedRow(item) {
  const {measure, unit} = item;
  const ratio = isNumber(item.computed) && item.published !== 0 ? 100 * (item.computed / item.published - 1) : null;
  return tr(modelName(item.model), nuText(item.poisson_ratio), el('td', {class: 'measure'}, measureText(measure)),
    el('td', {class: 'number'}, quantity(item.published, measure, unit)),
    el('td', {class: 'number'}, quantity(item.computed, measure, unit)),
    el('td', {class: 'number'}, ratio === null ? '–' : signed(ratio, percent(ratio))), item.where, item.remark);
}

function publishedPart(result) {
  if (result.published.length === 0) return [];
  return [el('h4', {}, 'Published values'), table('published', ['model', result.listed.symbol, 'measure', right('published'), right('ours'),
    right('ours to published'), 'where', 'remark'], result.published.map(publishedRow))];
}

function runRow(run) {
  return el('tr', {class: run.ok ? '' : 'lost'}, [modelName(run.model), nuText(run.poisson_ratio), cellsText(run.cells), run.kinematics,
    run.solver].map(cell => el('td', {}, cell)),
    [String(run.iterations ?? '–'), number(run.residual, 2), seconds(run.set_up_seconds), seconds(run.seconds), number(run.unknowns, 9), number(run.memory_MiB, 4)]
      .map(cell => el('td', {class: 'number'}, cell)), el('td', {}, run.message));
}

function runsPart(result) {
  const failed = result.runs.filter(run => !run.ok).length;
  const time = result.runs.reduce((sum, run) => sum + (run.set_up_seconds || 0) + (run.seconds || 0), 0);
  return el('details', {class: 'fold'},
    el('summary', {}, `Runs: ${result.runs.length}` + (failed ? `, ${failed} without result` : '') + `, ${seconds(time)}`),
    table('runs', ['model', result.listed.symbol, 'cells', 'kinematics', 'solver', right('iterations'), right('residual'), right('set-up'), right('solve'),
                   right('unknowns'), right('memory [MiB]'), 'message'], result.runs.map(runRow)));
}

// ---- the page of a case

/// How far the models are from the reference, in one sentence, with the checks beside it.
function outcome(result) {
  const worst = models.filter(model => result.models.includes(model) && !isBeside(model)).map(model => ({model, worst:
    worstOf(result, judgedRows(result).filter(row => row.model === model && claims(result, model, row.poisson_ratio)))}))
    .filter(entry => entry.worst).sort((a, b) => a.worst.error - b.worst.error);
  const words = worst.length === 0 ? '' : `Largest ${displacementRows(result).length > 0 ? 'displacement errors' : 'errors of reactions'}: ${worst.slice(0, 3).map(({model, worst: {error}}) => `${model} ${percent(error)}`).join(', ')}` +
    (worst.length > 3 ? `; ${worst[worst.length - 1].model} ${percent(worst[worst.length - 1].worst.error)}` : '') +
    `. The reference is uncertain by ${worstUncertainty(result)}.`;
  return el('p', {class: 'outcome'}, verdictChip(caseVerdict(result)), ' ', heldText(result) || '', heldText(result) && words ? '. ' : '', words);
}

function casePage(result, jumps) {
  const body = el('div', {class: 'case-body'});
  const links = jumps.filter(jump => jump.has(result.id)).map(jump =>
    el('button', {type: 'button', onclick: () => jump.go(result.id)}, jump.text));
  const page = el('details', {class: 'case', id: result.id},
    el('summary', {}, el('span', {class: 'case-name'}, result.name), el('span', {class: 'case-what'}, result.experiment.what),
       verdictChip(caseVerdict(result))), body);
  const fill = () => {
    if (body.childElementCount > 0) return;
    const picture = problemPicture(result);
    if (picture) charts.push(picture.redraw);
    body.append(...[picture && picture.node, outcome(result), warningsOf(result), el('p', {class: 'jumps'}, links), referencePart(result),
      result.verifies ? [] : resultsPart(result),
      checksPart(result), publishedPart(result), problemPart(result), runsPart(result)].flat(Infinity).filter(Boolean));
    if (result.experiment.text)
      body.append(el('details', {class: 'fold'}, el('summary', {}, 'The case file'), el('pre', {}, result.experiment.text)));
  };
  page.addEventListener('toggle', () => { if (page.open) fill(); });
  page.fill = fill;
  return page;
}

function pagesSection(section, jumps) {
  if (allCases.length === 0) return section.append(notice('No case was run.'));
  section.append(...allCases.map(result => casePage(result, jumps)));
}
