'use strict';
// Bodies of several materials: a section through them, and what each part is.

function sectionPicture(result) {
  const {section} = picturesOf(result);
  return section ? el('figure', {class: 'section'}, el('img', {src: 'data:image/svg+xml;base64,' + btoa(section), alt: `a section through ${result.name}`})) : null;
}

const partName = ({name}) => name || 'in no region';

/// Of a region {E, nu} as text, of all materials that it is given.
const moduliOf = region => ({E: distinct([].concat(region.youngs_modulus_Pa).map(E => number(E))).join(', '), nu: distinct([].concat(region.poisson_ratio).map(nuText)).join(', ')});

/// A line for each material.
function regionsTable(result) {
  const whole = result.regions.reduce((sum, region) => sum + region.volume_m3, 0), cells = (result.regions[0] || {cells: []}).cells;
  return table('regions', ['part', right('E [Pa]'), right('ν'), right('density [kg/m³]'), right('volume [m³]'), right('share'), ...(cells.length > 0 ? [right('cells')] : [])],
    result.regions.map((region, i) => tr(el('td', {}, el('i', {class: 'sample', style: {background: region.colour}}), ' ', partName(region)),
      ...[moduliOf(region).E, moduliOf(region).nu, number(region.density_kg_m3),
          number(region.volume_m3), percent(100 * region.volume_m3 / whole), ...(cells.length > 0 ? [region.cells.join(', ')] : [])]
        .map(text => el('td', {class: 'number'}, text)))));
}

/// Of one case: on its page too.
const regionsPart = result => result.regions.length > 0 ? [regionsTable(result), sectionPicture(result)] : [];

function regionsSection(section) {
  const having = cases.filter(result => result.regions.length > 0);
  if (having.length === 0) return leaveOut(section);
  const node = el('div', {}), caseChoice = select('Case', having.map(c => [c.id, c.name]), draw);
  function draw() {
    node.replaceChildren(...regionsPart(having.find(c => c.id === caseChoice.value)).filter(Boolean));
  }
  section.append(el('p', {class: 'lead'}, 'A plane section through the regions, and each part of the body by its material.'),
    el('div', {class: 'choices'}, caseChoice.node), node);
  draw();
  return {show(id) { caseChoice.value = id; draw(); }, has: id => having.some(c => c.id === id)};
}
