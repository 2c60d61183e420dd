// Contents of a model: base parameters, operations, code.
'use strict';

/** Element with texts and elements as children; texts are never markup. */
function element(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Name that may be broken after its underscores. */
function broken(name) {
  return name.split(/(?<=_)/).flatMap((part, at) => (at ? [document.createElement('wbr'), part] : [part]));
}

function table(header, rows, classes = []) {
  const content = one => (Array.isArray(one) ? one : broken(String(one)));
  const cell = kind => (one, at) => element(kind, classes[at] ? { class: classes[at] } : {}, ...content(one));
  const head = element('tr', {}, ...header.map(cell('th')));
  const body = rows.map(row => element('tr', {}, ...row.map(cell('td'))));
  const made = element('table', {}, element('thead', {}, head), element('tbody', {}, ...body));
  return element('div', { class: 'scroll', tabindex: '0' }, made);
}

/** Coefficient of a regrouping as text. */
function digits(value) {
  return String(Number(value.toPrecision(6)));
}

/** Sum that may only be broken between its terms. */
function regrouping(terms) {
  return terms.flatMap(({ parameter, coefficient }, at) => {
    const sign = coefficient < 0 ? (at ? '− ' : '−') : (at ? '+ ' : '');
    const factor = Math.abs(coefficient) === 1 ? '' : `${digits(Math.abs(coefficient))} `;
    const term = element('span', { class: 'term' }, `${sign}${factor}${parameter}`);
    return at ? [' ', term] : [term];
  });
}

function parametersOf(model) {
  const all = model.base_parameters;
  const standard = model.parameters.filter(name => !name.endsWith('_payload')).length;
  const rows = all.map(one => [[one.name], one.regrouping.length > 1 ? regrouping(one.regrouping) : []]);
  return [
    element('p', { class: 'soft' }, `${all.length} base parameters of ${standard} standard parameters; those with the suffix R have others regrouped into them.`),
    table(['base parameter', 'is'], rows, ['', 'text wide']),
  ];
}

function operationsOf(model) {
  const header = ['function', 'operations', '+ −', '×', '÷', '√', 'sin cos', 'atan2', 'each step', 'shape'];
  const rows = model.functions.map(one => [
    one.function, one.operations, one.additions,
    one.multiplications, one.divisions, one.square_roots, one.trigonometric_pairs, one.arc_tangents,
    one.iterations.map(iteration => iteration.operations).join(', '),
    one.outputs.map(output => output.shape.join(' × ')).join(', '),
  ]);
  return [table(header, rows)];
}

/** Saves a text as a file. */
function save(name, type, ...parts) {
  const link = element('a', { download: name, href: URL.createObjectURL(new Blob(parts, { type })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Button that saves a text as a file. */
function saving(name, type, text) {
  const button = element('button', { type: 'button' }, `Save ${name}`);
  button.addEventListener('click', () => save(name, type, text));
  return button;
}

/** Code with buttons to save it; of long code only the beginning is shown. */
function codeOf(files) {
  const LONGEST = 200000;
  const buttons = files.map(({ name, text }) => saving(name, 'text/plain', text));
  const shown = files.flatMap(({ name, text }) => [
    element('h2', {}, name),
    element('div', { class: 'scroll', tabindex: '0' }, element('pre', {}, text.slice(0, LONGEST))),
    ...(text.length > LONGEST ? [element('p', { class: 'soft' }, `The first ${LONGEST} of ${text.length} characters; the file has all.`)] : []),
  ]);
  return [element('p', { class: 'bar' }, ...buttons), ...shown];
}
