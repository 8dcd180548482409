'use strict';
// The first screen: two bodies, a dot for every model and case, and what the closest model costs.

const closestModels = (document.getElementById('first-bodies')?.dataset.closest || '').split('\n').filter(Boolean);
/// The cases that the answer is about: the linear ones, or where there are none those of large deformation.
const judgedCases = () => ofOneAxis(cases.some(result => result.linear) ? cases.filter(result => result.linear) : cases);

// ---- two bodies

/// The case, Poisson's ratio and pictures to show: a body of its own shape rather than a block, near nu = 0.4.
function firstPictures(model) {
  const offers = judgedCases().flatMap(result => {
    const {pictures} = picturesOf(result);
    const nus = distinct(pictures.map(p => p.poisson_ratio)).filter(nu => claims(result, model, nu))
      .sort((a, b) => Math.abs(a - 0.4) - Math.abs(b - 0.4));
    const surface = pictures.some(p => p.surface === 'smooth') ? 'smooth' : 'cells';
    const at = name => pictures.find(p => p.model === name && p.poisson_ratio === nus[0] && (p.surface || 'cells') === surface);
    return at('fem') && at(model) ? [{result, nu: nus[0], surface, pictures: [at('fem'), at(model)]}] : [];
  });
  return offers.find(offer => offer.surface === 'smooth') || offers[0] || null;
}

/// Of a model in motion: its curve beside that of finite elements in time, near nu = 0.4.
function firstMotion(model) {
  for (const result of judgedCases().filter(result => isMoving(result, model))) {
    const records = result.histories.filter(record => record.model === model);
    if (records.length === 0) continue;
    const record = records.reduce((a, b) => Math.abs(b.poisson_ratio - 0.4) < Math.abs(a.poisson_ratio - 0.4) ? b : a);
    const drawing = motionDrawing(result, String(record.poisson_ratio), record.probe || record.names[0]);
    return {...drawing, notes: [], make() {
      const configuration = drawing.make();
      configuration.options.plugins.legend = {...configuration.options.plugins.legend, position: 'bottom'};
      return configuration;
    }};
  }
  return null;
}

/// The body of a model in motion, near nu = 0.4, playing; who wants less motion sees it at its end.  Null: no frames.
function firstPlaying(model) {
  const offers = judgedCases().flatMap(result => picturesOf(result).pictures.filter(p => p.model === model && p.frames).map(picture => ({result, picture})));
  if (offers.length === 0) return null;
  const rank = ({picture}) => Math.abs(picture.poisson_ratio - 0.4) - (picture.surface === 'smooth' ? 1 : 0);
  const {result, picture} = offers.reduce((a, b) => rank(b) < rank(a) ? b : a);
  const viewer = new Viewer(), clock = el('output', {}), all = makePanels(picturesOf(result), [picture], true), panels = all.slice(1);
  const amplification = fittingAmplification(result, all);
  paintPanels(all, colourings.displacement, amplification);
  viewer.describe(`${result.name} in motion`);
  viewer.show(panels);
  aimAtPanels(viewer, panels, amplification, panels[0].shape.frames.flatMap(frame => Array.from(panels[0].shape.rest, (x, i) => x + amplification * frame[i])));
  charts.push(() => viewer.render());
  if (!matchMedia('(prefers-reduced-motion: reduce)').matches) playFrames(viewer, () => panels, () => amplification, clock);
  return [viewer.node, el('p', {class: 'note'}, `${result.name}, ${settingText(result, picture.poisson_ratio)}` +
    (amplification === 1 ? '' : `, displacements drawn ${number(amplification, 3)} times as large`), clock)];
}

/// Where no model was compared: how much of the load each of them bears, if some lose their equilibrium.
function firstStability() {
  const result = cases.find(losesEquilibrium);
  return result ? {...stabilityDrawing(result, finestOf(result)), notes: []} : null;
}

/// Finite elements and the closest model, the latter coloured by the difference; or a curve.
function firstBodies(model) {
  const box = document.getElementById('first-bodies'), curve = model ? firstMotion(model) : firstStability();
  if (curve) {
    const chart = figure();
    chart.draw(curve);
    charts.push(() => chart.draw(curve));
    return box.append(...(model && firstPlaying(model) || []), el('b', {}, curve.caption), chart.node);
  }
  const offer = model && firstPictures(model);
  if (!offer) {
    box.parentNode.classList.add('text');
    return box.remove();
  }
  const viewer = new Viewer(), bar = colorBar(), colouring = colourings.difference;
  const all = makePanels(picturesOf(offer.result), offer.pictures, true), panels = all.slice(1);
  const amplification = fittingAmplification(offer.result, all), top = paintPanels(all, colouring, amplification);
  for (const panel of panels) {
    const {title, text} = panelWords(panel, colouring);
    panel.label.append(el('span', {class: 'model'}, swatch(panel.picture.model), title), el('small', {}, text));
  }
  viewer.describe(`${offer.result.name}, deformed. ${panelsText(panels, colouring)}`);
  viewer.show(panels);
  aimAtPanels(viewer, panels, amplification);
  bar.show(colouring, top);
  charts.push(() => viewer.render());
  box.append(viewer.node, bar.node, el('p', {class: 'note'}, `${offer.result.name}, ${settingText(offer.result, offer.nu)}` +
    (amplification === 1 ? '' : `, displacements drawn ${number(amplification, 3)} times as large`) + '. Drag to turn.'));
}

// ---- a dot per model and case

const caseGlyphs = ['●', '▲', '■', '◆', '★', '▼', '✚', '✖'];

/// The errors by which models are ranked: at rest, and in motion where there are finite elements in time.
const rankedMeasures = ['displacement_error', 'reaction_error', 'motion_error'];
const shortNames = {displacement_error: 'displacement', reaction_error: 'reactions', motion_error: 'in time', volume_change: 'volume change'};
const isMoving = (result, model) => (result.experiment.models || []).some(m => m.label === model && m.in_motion);

/// Errors of a model in a case at those of these Poisson's ratios that the model claims [%], against the true body.
function errorsOf(result, model, nus, measures = rankedMeasures) {
  return measures.filter(measure => !isMoving(result, model) || measure === 'motion_error').flatMap(measure => rowsAt(result, measure)).filter(row => row.model === model && nus.includes(row.poisson_ratio) &&
    claims(result, model, row.poisson_ratio)).map(row => {
    return {result, row, error: scaledError(result, row), uncertainty: scaledUncertainty(result, row)};
  }).filter(entry => entry.error !== null);
}

/// The largest of some errors; none: null.
const largestOf = errors => errors.length === 0 ? null : errors.reduce((a, b) => b.error > a.error ? b : a);

/// A line of the plot: the largest error of each case, of all of them, and how many cases and Poisson's ratios it is of.
function dotLine(shown, model, nus) {
  const errors = shown.map(result => errorsOf(result, model, nus)), dots = errors.map(largestOf).filter(Boolean);
  return {model, dots, worst: Math.max(...dots.map(dot => dot.error)), nus: distinct(errors.flat().map(({row}) => row.poisson_ratio)).length};
}

/// No spring model: elements, the limit of two lattices, what another program computed for comparison.
const isBeside = model => isFem(model) || model.endsWith(' extrapolated') ||
  cases.some(({experiment}) => (experiment.models || []).some(m => m.label === model && m.options?.springs === false));

/// As the answer ranks them: those compared most widely first, and then by the largest error; what is beside them last.
const byRank = (a, b) => isBeside(a.model) - isBeside(b.model) || b.dots.length - a.dots.length || b.nus - a.nus || a.worst - b.worst;

/// Whether a label is another form of a model that has a row under its plain name.
const isVariant = model => judgedCases().some(({experiment}) => (experiment.models || []).some(m =>
  m.label === model && m.name !== model && (experiment.models || []).some(other => other.label === m.name)));

/// Behind a model's name: that it is none of springs, or its only Poisson's ratio.
function claimText(result, model) {
  const own = ownRatio(result, model), text = isFem(model) ? 'finite elements' : own !== null ? `ν = ${nuText(own)}` : '';
  return text ? el('small', {}, ' ' + text) : null;
}

/// "error of displacement and reactions".
function dottedErrors(compared) {
  const still = compared.filter(measure => measure !== 'motion_error');
  return [still.length > 1 ? 'error of displacement and reactions' : still[0] === 'reaction_error' ? 'error of the reactions of moved supports'
            : still.length > 0 ? 'displacement error' : '',
          still.length < compared.length ? 'difference of motions' : ''].filter(Boolean).join(', or ');
}

function dotPlot() {
  const box = document.getElementById('first-plot');
  const shown = judgedCases().filter(result => rankedMeasures.some(measure => result.measures.includes(measure)));
  if (shown.length === 0) return box.remove();
  const nus = distinct(shown.flatMap(result => result.nus)).sort((a, b) => a - b);
  const ordinary = nus.filter(nu => nu >= 0), several = ordinary.length > 0 ? ordinary : nus;
  const closest = closestModels, compared = rankedMeasures.filter(measure => shown.some(result => result.measures.includes(measure)));
  const names = models.filter(model => shown.some(result => result.models.includes(model)));
  const axis = el('div', {class: 'dots'}), said = el('output', {});
  const slider = el('input', {type: 'range', min: 0, max: nus.length, value: 0, step: 1, 'aria-label': 'Poisson’s ratio', oninput: draw});
  const variants = el('input', {type: 'checkbox', onchange: draw}), anyVariant = names.some(isVariant);

  function draw() {
    const choice = Number(slider.value), wanted = choice === 0 ? several : [nus[choice - 1]];
    said.textContent = choice > 0 ? `at ${settingText(shown[0], nus[choice - 1])}`
      : several.length === 1 ? `at ${settingText(shown[0], several[0])}` : `for ${shown[0].listed.symbol} from ${nuText(several[0])} to ${nuText(several[several.length - 1])}`;
    const lines = names.filter(model => variants.checked || !isVariant(model) || closest.includes(model))
      .map(model => dotLine(shown, model, wanted)).filter(line => line.dots.length > 0).sort(byRank);
    const all = lines.flatMap(line => line.dots.map(dot => dot.error)).filter(error => error > 0);
    const low = Math.floor(Math.log10(Math.min(1, ...all))), high = Math.max(low + 1, Math.ceil(Math.log10(Math.max(1, ...all))));
    const at = error => `${100 * Math.min(1, Math.max(0, (Math.log10(Math.max(error, 1e-12)) - low) / (high - low)))}%`;
    const ticks = Array.from({length: high - low + 1}, (_, i) => 10 ** (low + i));
    const marks = () => ticks.map(tick => el('span', {class: 'tick', style: {left: at(tick)}}));
    /// The uncertainty of the reference, to both sides of the error.
    const whisker = ({error, uncertainty}, model) => !uncertainty ? null : el('span', {class: 'whisker', style: {
      left: at(error - uncertainty), right: `calc(100% - ${at(error + uncertainty)})`, background: modelPaint(model)}});
    axis.replaceChildren(
      ...lines.flatMap(({model, dots, worst}) => [
        el('div', {class: closest.includes(model) ? 'dot-name closest' : 'dot-name'}, modelName(model), claimText(dots[0].result, model)),
        el('div', {class: 'dot-track'}, marks(), dots.map(dot => whisker(dot, model)), dots.map(({result, row, error}) => {
          const text = `${model}, ${result.name}: ${percent(error)}${compared.length > 1 ? ` (${shortNames[row.measure]})` : ''} at ${settingText(result, row.poisson_ratio)}`;
          return el('span', {class: 'dot', role: 'img', title: text, 'aria-label': text, style: {left: at(error), color: modelPaint(model)}},
                    caseGlyphs[shown.indexOf(result) % caseGlyphs.length]);
        })),
        el('div', {class: 'dot-worst'}, percent(worst))]),
      el('div', {}, ''), el('div', {class: 'dot-track scale'}, ticks.map(tick => el('span', {class: 'tick-text', style: {left: at(tick)}}, `${number(tick, 1)} %`))), el('div', {}, ''));
  }
  box.append(el('div', {class: 'dot-head'},
      el('b', {}, `Largest ${dottedErrors(compared)} against finite elements`), said,
      nus.length > 1 ? el('label', {class: 'choice'}, slider) : null,
      anyVariant ? el('label', {class: 'ghost'}, variants, 'variants') : null,
      el('span', {class: 'dot-legend'}, shown.map((result, i) => el('span', {}, caseGlyphs[i % caseGlyphs.length], ' ', result.name)),
         el('span', {}, el('i', {class: 'whisker-sample'}), 'uncertainty of the reference'))),
    axis,
    el('p', {class: 'note'}, 'Errors against the true body, coarse cells included. Models of most cases and Poisson’s ratios come first, then by their largest error, on the right.'));
  draw();
}

// ---- what it holds for, and costs

const listedErrors = (model, nus, measure) => judgedCases().map(result => largestOf(errorsOf(result, model, nus, [measure]))).filter(Boolean)
  .map(({result, error}) => `${result.name} ${percent(error)}`).join(', ').replace(/ %/g, '\u00a0%');

/// The middle of the CPU times of a model's solutions at the finest cells.
function middleSeconds(model) {
  const times = judgedCases().flatMap(result => result.runs.filter(run => run.model === model && run.ok &&
    cellsText(run.cells) === cellsText(result.cells[result.cells.length - 1])).map(run => run.seconds + (run.set_up_seconds || 0)));
  return times.sort((a, b) => a - b)[times.length >> 1];
}

function firstFacts(model) {
  const box = document.getElementById('first-facts');
  const parts = judgedCases().flatMap(result => result.regions.map(region => `${partName(region)} E = ${moduliOf(region).E} Pa, ν = ${moduliOf(region).nu}`));
  if (!model && parts.length === 0) return box.remove();
  const nus = distinct(judgedCases().flatMap(result => result.nus)), ordinary = nus.filter(nu => nu >= 0);
  const fact = (term, text) => text ? [el('dt', {}, term), el('dd', {}, text)] : [];
  const doubts = judgedCases().flatMap(result => rankedMeasures.flatMap(measure => rowsAt(result, measure)).map(row => scaledUncertainty(result, row))).filter(isNumber);
  const ours = middleSeconds(model), fem = middleSeconds('fem_q1');
  box.append(...fact('Materials', distinct(parts).join('; ')));
  if (model) box.append(...fact('Displacement of ' + model, listedErrors(model, ordinary, 'displacement_error')),
    ...fact('Motion of ' + stillName(model), listedErrors(model, nus, 'motion_error')),
    ...fact('Reactions of moved supports', listedErrors(model, ordinary, 'reaction_error')),
    ...fact('Displacement of auxetic solids, ν < 0', listedErrors(model, nus.filter(nu => nu < 0), 'displacement_error')),
    ...fact('Reference', doubts.length > 0 ? `uncertain by up to ${percent(Math.max(...doubts))}` : ''),
    ...fact('One solution', isNumber(ours) ? `${seconds(ours)}${isNumber(fem) ? `; trilinear finite elements on the same cells ${seconds(fem)}` : ''} (CPU, middle of all)` : ''));
}

function firstScreen() {
  const [model] = closestModels;
  for (const part of [() => firstFacts(model), dotPlot, () => firstBodies(model)]) {
    try {
      part();
    } catch (error) {
      console.error(error);
    }
  }
}
