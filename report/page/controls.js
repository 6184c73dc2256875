// Labelled selectors and sliders.

let controlCount = 0;

// options: [[value, text]]; changed(value) is called with the value chosen.
function addSelect(parent, label, options, changed, chosen = options[0][0]) {
  const id = `control-${++controlCount}`;
  const select = element(
    'select',
    { id },
    options.map(([value, text]) => element('option', { value }, text)),
  );
  select.value = chosen;
  select.addEventListener('change', () => changed(select.value));
  const box = element('div', { class: 'control' }, element('label', { for: id }, label), select);
  parent.append(box);
  return { box, select };
}

// Over the nodes of an axis; the current one stands beside it as text.
function addSlider(parent, label, changed) {
  const id = `control-${++controlCount}`;
  const input = element('input', { id, type: 'range', min: 0, step: 1 });
  const output = element('output', { for: id });
  const name = element('label', { for: id }, label);
  let axis = null;
  const show = () => {
    output.textContent = axisValueText(axis, Number(input.value));
    input.setAttribute('aria-valuetext', output.textContent);
  };
  input.addEventListener('input', () => {
    show();
    changed(Number(input.value));
  });
  const box = element('div', { class: 'control slider' }, name, input, output);
  parent.append(box);
  return {
    box,
    input,
    set(newAxis, index) {
      axis = newAxis;
      name.textContent = withUnit(axis.name, axis.unit);
      input.max = axis.values.length - 1;
      input.value = index;
      show();
    },
  };
}

// A legend of lines or symbols: entries are [svg, text].
function legendOf(entries) {
  return element(
    'ul',
    { class: 'legend' },
    entries.map(([picture, text]) => element('li', {}, picture, ' ', text)),
  );
}

function sample(...shapes) {
  return drawing('svg', { width: 34, height: 14, viewBox: '0 0 34 14', 'aria-hidden': 'true' }, ...shapes);
}
