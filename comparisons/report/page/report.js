'use strict';
// Builds the page.  A section that cannot be built shows an error and does not affect the others.

function build(id, make) {
  const section = document.getElementById(id);
  try {
    return make(section) || {show() {}, has: () => false};
  } catch (error) {
    console.error(error);
    section.append(notice(`This section could not be drawn: ${error.message}`));
    return {show() {}, has: () => false};
  }
}

/// Leaves out a section without data in this kind of run; an empty run shows a notice.
const needsCases = make => section => {
  if (cases.length > 0) return make(section);
  if (verifications.length > 0) return leaveOut(section);
  return section.append(notice('No model was compared.'));
};

/// The same, left out also where nothing was compared with a reference: bodies that only move or dry.
const needsErrors = make => section =>
  cases.length > 0 && !cases.some(result => result.rows.some(row => isNumber(row.error))) ? leaveOut(section) : needsCases(make)(section);

function jumpTo(id, part) {
  return caseId => {
    part.show(caseId);
    document.getElementById(id).scrollIntoView({behavior: 'smooth'});
  };
}

function flatten(object, prefix = '') {
  return Object.entries(object || {}).flatMap(([key, value]) => value !== null && typeof value === 'object' && !Array.isArray(value)
    ? flatten(value, prefix + key + ' ') : [[prefix + key, String(value)]]);
}

function aboutSection(section) {
  const {program = {}, host = {}, generated} = results;
  const facts = [...flatten(program), ['generated', generated || '–'], ...flatten(host)];
  section.append(el('dl', {}, facts.flatMap(([term, value]) => definition(term.replace(/_/g, ' '), value))),
    el('p', {class: 'note'}, 'The page loads nothing from the network. The same numbers are in results.json and results.csv. ' +
       'Charts: Chart.js 3.9; shapes: three.js r111 (both MIT licence); colours: viridis, Moreland, Okabe and Ito.'));
}

function decorateHead() {
  document.getElementById('generated').textContent = [results.program && results.program.version, results.generated]
    .filter(Boolean).join(' · ');
  const title = cases.length === 0 && verifications.length > 0 ? 'Are the reference’s finite elements right?'
    : cases.length > 0 && cases.every(result => result.cracks.length > 0) ? 'How does a drying body crack?' : null;
  if (title) document.querySelector('#head h1').textContent = title;
  for (const item of document.querySelectorAll('.verdicts li')) item.prepend(swatch(item.dataset.model));
  for (const link of document.querySelectorAll('#verdict a[data-case]')) link.href = '#' + allCases[link.dataset.case].id;
}

/// Opens the case page that the address names.
function followHash() {
  const target = document.getElementById(location.hash.slice(1));
  if (!target || !target.classList.contains('case')) return;
  target.open = true;
  target.fill();
  target.scrollIntoView();
}

/// On paper: everything open, dark ink on white.
function preparePrinting() {
  let closed = [];
  window.addEventListener('beforeprint', () => {
    document.documentElement.dataset.theme = 'light';
    for (const page of document.querySelectorAll('details.case')) page.fill();
    closed = [...document.querySelectorAll('details:not([open]):not(.fold)')];
    for (const node of closed) node.open = true;
    redraw();
  });
  window.addEventListener('afterprint', () => {
    delete document.documentElement.dataset.theme;
    for (const node of closed) node.open = false;
    redraw();
  });
}

function start() {
  decorateHead();
  firstScreen();
  Chart.defaults.font.family = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
  Chart.defaults.font.size = 13;
  build('cases', needsCases(casesSection));
  const compared = id => cases.some(result => result.id === id);
  const poisson = build('poisson', needsErrors(poissonSection));
  const convergence = build('convergence', needsErrors(convergenceSection));
  const cost = build('cost', costSection);
  const splits = build('splits', splitsSection);
  const shapes = build('shapes', shapesSection);
  const motion = build('motion', motionSection);
  const line = build('line', lineSection);
  const cracks = build('cracks', cracksSection);
  const stability = build('stability', stabilitySection);
  build('verification', verificationSection);
  build('fem-column', femColumnSection);
  build('pages', section => pagesSection(section, [
    {text: 'Error against ν', go: jumpTo('poisson', poisson), has: compared},
    {text: 'Convergence', go: jumpTo('convergence', convergence), has: compared},
    {text: 'Error against cost', go: jumpTo('cost', cost), has: id => cost.has(id)},
    {text: 'Parts of the error', go: jumpTo('splits', splits), has: id => splits.has(id)},
    {text: 'Along the line', go: jumpTo('line', line), has: id => line.has(id)},
    {text: 'Cracks', go: jumpTo('cracks', cracks), has: id => cracks.has(id)},
    {text: 'Equilibrium lost', go: jumpTo('stability', stability), has: id => stability.has(id)},
    {text: 'Motion', go: jumpTo('motion', motion), has: id => motion.has(id)},
    {text: 'Deformed shapes', go: jumpTo('shapes', shapes), has: id => shapes.has(id)},
  ]));
  build('about', aboutSection);
  const wanted = /^#png=(\d+)(?:&only=(.*))?$/.exec(location.hash);
  if (wanted) return writePictures(allCases[Number(wanted[1])], [shapes, poisson, convergence, cost, splits, motion, line, cracks, stability], decodeURIComponent(wanted[2] || ''));
  preparePrinting();
  window.addEventListener('hashchange', followHash);
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  followHash();
}

start();
