// Elements and numbers as text. What comes from the report becomes text nodes only, so that no name in it is markup.

// element('p', { class: 'note' }, 'text', child, ...); children that are null are left out.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return made;
}

function drawing(tag, attributes = {}, ...children) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
const missing = '\u2013';

// Three significant digits, or as many as asked for; a dash for what the report does not have.
function numberText(value, digits = 3) {
  if (!isNumber(value)) return missing;
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e4) {
    const text = value.toPrecision(digits);
    return String(text.includes('e') ? Math.round(value) : Number(text));
  }
  return value
    .toExponential(Math.max(0, digits - 1))
    .replace(/\.?0+e/, 'e')
    .replace('e+', 'e');
}

// Of a time in seconds; three digits, written out.
const milliseconds = (seconds) =>
  seconds < 10 ? numberText(1000 * seconds) : Number((1000 * seconds).toPrecision(3)).toLocaleString('en-US');
const countText = (value) => (isNumber(value) ? value.toLocaleString('en-US') : missing);
const ratioText = (value, digits) => (isNumber(value) ? `${numberText(value, digits)} \u00d7` : missing);
const unitText = (unit) => (unit && unit !== '1' ? unit : '');
const withUnit = (name, unit) => (unitText(unit) ? `${name} (${unitText(unit)})` : name);

// An axis value as "theta 45°", "alpha 0.25".
function axisValueText(axis, index) {
  const value = numberText(axis.values[index]);
  return `${axis.name} ${value}${axis.unit === 'degrees' ? '\u00b0' : ''}`;
}

// The nodes are row-major over the axes, slowest first.
function nodeIndices(axes, node) {
  const indices = [];
  let rest = node;
  for (let a = axes.length - 1; a >= 0; a--) {
    indices[a] = rest % axes[a].values.length;
    rest = Math.floor(rest / axes[a].values.length);
  }
  return indices;
}

function nodeAt(axes, indices) {
  return indices.reduce((node, index, a) => node * axes[a].values.length + index, 0);
}

const nodeText = (axes, node) =>
  nodeIndices(axes, node)
    .map((index, a) => axisValueText(axes[a], index))
    .join(', ');

const idOf = (...parts) => parts.join('-').replace(/[^A-Za-z0-9]+/g, '-');

// rows: arrays of texts or elements. columns: { title, number, head, class, note }; `head` cells are row headings.
function tableOf(caption, columns, rows) {
  const cell = (content, column) =>
    element(
      column.head ? 'th' : 'td',
      { scope: column.head ? 'row' : null, class: column.number ? 'number' : column.class },
      content,
    );
  return element(
    'table',
    {},
    element('caption', {}, caption),
    element(
      'thead',
      {},
      element(
        'tr',
        {},
        columns.map((column) =>
          element(
            'th',
            { scope: 'col', class: column.number ? 'number' : column.class, title: column.note },
            column.title,
          ),
        ),
      ),
    ),
    element(
      'tbody',
      {},
      rows.map((row) =>
        element(
          'tr',
          {},
          row.map((content, i) => cell(content, columns[i])),
        ),
      ),
    ),
  );
}

// A table that is wider than the page scrolls in a box of its own, which the keyboard reaches.
function scrolling(table, label) {
  return element('div', { class: 'scroll', role: 'region', tabindex: 0, 'aria-label': label }, table);
}

function section(id, level, title, ...children) {
  return element(
    'section',
    { id, 'aria-labelledby': `${id}-title` },
    element(`h${level}`, { id: `${id}-title` }, title),
    ...children,
  );
}

const note = (...children) => element('p', { class: 'note' }, ...children);
// One line in place of a section without data.
const absent = (what, option) =>
  element(
    'p',
    { class: 'absent' },
    `${what}: not in this report; `,
    element('code', {}, option),
    ' of ',
    element('code', {}, 'ltcfit report'),
    ' brings it in.',
  );
