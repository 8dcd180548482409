'use strict';
// Builds the page.  A section that cannot be built shows an error and does not affect the others.

function build(id, make) {
  const section = document.getElementById(id);
  try {
    return {show() {}, has: () => false, ...make(section)};
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

/// The sections in the order of the page: what builds each, and its words in the contents where they are not the heading.  One
/// that can `show` a case alone says by `has` which, and is linked from that case's page.
const sections = [
  {id: 'cases', heading: 'Cases', make: needsCases(casesSection)},
  {id: 'measured', heading: 'Beside what was measured', contents: 'Measured', make: measuredSection},
  {id: 'shapes', heading: 'Deformed shapes', make: shapesSection},
  {id: 'regions', heading: 'Materials of the body', contents: 'Materials', make: regionsSection},
  {id: 'motion', heading: 'Motion in time', contents: 'Motion', make: motionSection},
  {id: 'stability', heading: 'Equilibrium lost', make: stabilitySection},
  {id: 'poisson', heading: 'Error against Poisson’s ratio', contents: 'Error against ν', make: needsErrors(poissonSection)},
  {id: 'convergence', heading: 'Convergence', make: needsErrors(convergenceSection)},
  {id: 'cost', heading: 'Error against cost', make: costSection},
  {id: 'splits', heading: 'Parts of the error', make: splitsSection},
  {id: 'line', heading: 'Along the line', make: lineSection},
  {id: 'cracks', heading: 'Cracks of drying bodies', contents: 'Cracks', make: cracksSection},
  {id: 'verification', heading: 'Verification of the reference', contents: 'Verification', make: verificationSection},
  {id: 'fem-column', heading: 'The paper’s finite element column', contents: 'The paper’s finite elements', make: femColumnSection},
  {id: 'pages', heading: 'Case pages', make: section => pagesSection(section, jumps())},
  {id: 'about', heading: 'About this report', contents: 'About', make: aboutSection},
];

/// From a case's page to the sections that show it.
const jumps = () => sections.filter(({built}) => built)
  .map(({id, heading, contents, built}) => ({text: contents || heading, go: jumpTo(id, built), has: built.has}));

function start() {
  decorateHead();
  firstScreen();
  Chart.defaults.font.family = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
  Chart.defaults.font.size = 13;
  document.getElementById('contents').prepend(...sections.map(({id, heading, contents}) => el('a', {href: '#' + id}, contents || heading)));
  document.querySelector('main').append(...sections.map(({id, heading}) => el('section', {id}, el('h2', {}, heading))));
  for (const section of sections) section.built = build(section.id, section.make);
  const wanted = /^#png=(\d+)(?:&only=(.*))?$/.exec(location.hash);
  if (wanted) return writePictures(allCases[Number(wanted[1])], sections.map(({built}) => built), decodeURIComponent(wanted[2] || ''));
  preparePrinting();
  window.addEventListener('hashchange', followHash);
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  followHash();
}

start();
