// A map of values over two axes of a table, with sliders for the other axes.
//
// quantities: [{ key, name, unit, values: Map from table name to one value for each node or null }].
// The caller says what the first selector is called; the second chooses a table, or this table over another, to which
// ratioNote is then said.

const defaultAxes = (axes) => {
  const at = (name) => axes.findIndex((axis) => axis.name === name);
  return axes.length === 2
    ? [at('alpha') >= 0 ? at('alpha') : 1, at('theta') >= 0 ? at('theta') : 0]
    : [at('alpha') >= 0 ? at('alpha') : 0, at('theta') >= 0 ? at('theta') : 1];
};

function viewsOf(table, quantity) {
  const names = [table.name, ...table.against].filter((name) => quantity.values.has(name));
  const views = names.map((name, i) => ({
    key: `table-${i}`,
    text: name,
    values: quantity.values.get(name),
    ratio: false,
  }));
  const ours = quantity.values.get(table.name);
  for (const [i, name] of table.against.entries()) {
    const theirs = quantity.values.get(name);
    if (!ours || !theirs) continue;
    const values = ours.map((value, k) =>
      isNumber(value) && isNumber(theirs[k]) && theirs[k] > 0 ? value / theirs[k] : null,
    );
    views.push({ key: `ratio-${i}`, text: `${table.name} / ${name}`, values, ratio: true });
  }
  return views;
}

// The cells of the part that is shown, x fastest: { node, x, y, value }.
function cellsOf(axes, values, shown, fixed) {
  const [xAxis, yAxis] = shown;
  const cells = [];
  for (let y = 0; y < axes[yAxis].values.length; y++) {
    for (let x = 0; x < axes[xAxis].values.length; x++) {
      const indices = [...fixed];
      indices[xAxis] = x;
      indices[yAxis] = y;
      const node = nodeAt(axes, indices);
      cells.push({ node, x, y, value: values[node] });
    }
  }
  return cells;
}

function mapOption(colors, width, { axes, shown, cells, scale, stops, describe }) {
  const [xAxis, yAxis] = shown.map((a) => axes[a]);
  const low = Math.log10(scale.low);
  const high = Math.log10(scale.high);
  const colorOf = (value) => colorAt(stops, value > 0 ? (Math.log10(value) - low) / (high - low) : 0);
  const category = (axis, gap, most) => {
    const style = axisStyle(colors, withUnit(axis.name, axis.unit), gap);
    const last = axis.values.length - 1;
    const step = Math.ceil(last / most);
    // every step-th node and the last one, whose neighbour makes room
    const interval = (index) => index === last || (index % step === 0 && last - index >= step);
    return {
      ...style,
      type: 'category',
      data: axis.values.map((value) => numberText(value, 2)),
      splitLine: { show: false },
      axisLabel: { ...style.axisLabel, interval },
      axisTick: { ...style.axisTick, interval, alignWithLabel: true },
    };
  };
  return {
    grid: {
      left: width < 500 ? 54 : 62,
      right: 10,
      top: 8,
      bottom: 46,
      show: true,
      backgroundColor: colors.hole,
      borderWidth: 0,
    },
    xAxis: category(xAxis, 28, width < 500 ? 5 : 9),
    yAxis: category(yAxis, width < 500 ? 38 : 44, 9),
    tooltip: { ...frame(colors).tooltip, formatter: (item) => tooltipOf(...describe(cells[item.dataIndex])) },
    // Not ECharts' own heat map: 6.1.0 draws that in slices of 15 ms whatever `progressive` says, and print takes the
    // first of them.
    series: [
      {
        type: 'custom',
        progressive: 0,
        data: cells.map((cell) => [cell.x, cell.y]),
        renderItem: ({ dataIndex }, api) => {
          const { x, y, value } = cells[dataIndex];
          if (!isNumber(value)) return null;
          const center = api.coord([x, y]);
          const size = api.size([1, 1]);
          // edges at whole pixels, so that no seams show
          const [x0, y0] = center.map((at, i) => Math.round(at - size[i] / 2));
          const [x1, y1] = center.map((at, i) => Math.round(at + size[i] / 2));
          return {
            type: 'rect',
            shape: { x: x0, y: y0, width: x1 - x0, height: y1 - y0 },
            style: { fill: colorOf(value) },
            emphasis: { style: { stroke: colors.mark, lineWidth: 2 } },
          };
        },
      },
    ],
  };
}

// Arrow keys move a read-out over the cells.
function steerByKeys(chart, readout, size, describe) {
  let at = null;
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const leave = () => {
    if (at === null) return;
    chart.instance.dispatchAction({ type: 'downplay', seriesIndex: 0 });
    chart.instance.dispatchAction({ type: 'hideTip' });
    at = null;
  };
  chart.box.tabIndex = 0;
  chart.box.addEventListener('keydown', (event) => {
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    const [nx, ny] = size();
    const x = at === null ? 0 : Math.min(nx - 1, Math.max(0, (at % nx) + step[0]));
    const y = at === null ? 0 : Math.min(ny - 1, Math.max(0, Math.floor(at / nx) + step[1]));
    chart.instance.dispatchAction({ type: 'downplay', seriesIndex: 0 });
    at = y * nx + x;
    chart.instance.dispatchAction({ type: 'highlight', seriesIndex: 0, dataIndex: at });
    chart.instance.dispatchAction({ type: 'showTip', seriesIndex: 0, dataIndex: at });
    readout.textContent = describe(at).join(': ');
  });
  chart.box.addEventListener('blur', leave);
  return leave;
}

function worstTable(table, view, title) {
  const order = view.values
    .map((value, node) => ({ value, node }))
    .filter(({ value }) => isNumber(value))
    .sort((a, b) => b.value - a.value)
    .slice(0, 10);
  const columns = [
    ...table.axes.map((axis) => ({ title: withUnit(axis.name, axis.unit), number: true })),
    { title, number: true },
  ];
  return tableOf(
    `The ten highest of all ${countText(table.nodes)} nodes, ${view.text}`,
    columns,
    order.map(({ value, node }) => [
      ...nodeIndices(table.axes, node).map((index, a) => numberText(table.axes[a].values[index])),
      view.ratio ? ratioText(value) : numberText(value),
    ]),
  );
}

function addNodeMap(parent, table, { id, what, quantities, ratioNote = null }) {
  const axes = table.axes;
  const state = {
    quantity: quantities[0],
    view: null,
    shown: defaultAxes(axes),
    fixed: axes.map((axis) => Math.floor((axis.values.length - 1) / 2)),
  };
  const controls = element('div', { class: 'controls' });
  const left = element('div', { class: 'map' });
  const legend = element('div', {});
  const readout = element('output', { class: 'readout', id: `${id}-readout`, 'aria-live': 'polite' });
  const side = element('div', { class: 'side' });
  parent.append(controls, element('div', { class: 'map-and-side' }, left, side));

  let cells = [];
  let scale = null;
  const title = () => withUnit(state.quantity.name, state.quantity.unit);
  const format = () => (state.view.ratio ? ratioText : numberText);
  const describe = (cell) => [
    nodeText(axes, cell.node),
    ...viewsOfNow.map((view) => `${view.text}: ${(view.ratio ? ratioText : numberText)(view.values[cell.node])}`),
  ];
  let viewsOfNow = [];
  const fixedText = () =>
    axes
      .map((axis, a) => (state.shown.includes(a) ? null : axisValueText(axis, state.fixed[a])))
      .filter(Boolean)
      .join(', ');
  const label = () => {
    const numbers = cells.filter((cell) => isNumber(cell.value));
    const worst = numbers.reduce((best, cell) => (best === null || cell.value > best.value ? cell : best), null);
    const over = state.shown.map((a) => axes[a].name).join(' and ');
    return (
      `Map of ${title()}, ${state.view.text}, over ${over}${fixedText() ? `, at ${fixedText()}` : ''}. ` +
      (worst ? `Highest ${format()(worst.value)} at ${nodeText(axes, worst.node)}. ` : 'No values. ') +
      'Arrow keys read single nodes.'
    );
  };

  const heading = element('p', { class: 'chart-title' });
  left.append(heading);
  const chart = addChart(
    left,
    id,
    (colors, width) =>
      mapOption(colors, width, {
        axes,
        shown: state.shown,
        cells,
        scale,
        stops: state.view.ratio ? blueOrange : viridis,
        describe,
      }),
    label,
  );
  chart.box.classList.add('square');
  left.append(legend, readout);
  const leave = steerByKeys(
    chart,
    readout,
    () => state.shown.map((a) => axes[a].values.length),
    (index) => describe(cells[index]),
  );

  const redraw = () => {
    leave();
    cells = cellsOf(axes, state.view.values, state.shown, state.fixed);
    heading.textContent = [`${title()}, ${state.view.text}`, fixedText()].filter(Boolean).join('; ');
    const values = cells.map((cell) => cell.value).filter(isNumber);
    readout.textContent =
      values.length === 0
        ? 'No values here.'
        : `Shown: ${format()(Math.min(...values))} to ${format()(Math.max(...values))}.`;
    chart.draw();
  };
  const showView = () => {
    // one scale for all tables and slices, so that they can be compared
    scale = state.view.ratio ? ratioScale(state.view.values) : errorScale([...state.quantity.values.values()]);
    const holes = state.view.values.some((value) => !isNumber(value));
    const legendTitle = state.view.ratio
      ? `${state.quantity.name}: ratio, blue where ${table.name} is better`
      : title();
    legend.replaceChildren(
      logColorBar(`${legendTitle} (logarithmic)`, state.view.ratio ? blueOrange : viridis, scale, format()),
      ...(holes ? [element('p', { class: 'holes' }, element('span', { class: 'hole' }), ' no value')] : []),
      ...(state.view.ratio && ratioNote ? [note(ratioNote)] : []),
    );
    side.replaceChildren(
      scrolling(worstTable(table, state.view, state.view.ratio ? 'ratio' : title()), 'Highest values'),
    );
    redraw();
  };
  const showQuantity = (key) => {
    state.quantity = quantities.find((quantity) => quantity.key === key);
    viewsOfNow = viewsOf(table, state.quantity);
    const kept = viewsOfNow.find((view) => view.key === state.view?.key) ?? viewsOfNow[0];
    viewSelect.select.replaceChildren(...viewsOfNow.map((view) => element('option', { value: view.key }, view.text)));
    viewSelect.select.value = kept.key;
    state.view = kept;
    showView();
  };

  addSelect(
    controls,
    what,
    quantities.map(({ key, name }) => [key, name]),
    showQuantity,
  );
  const viewSelect = addSelect(controls, 'Show', [['', '']], (key) => {
    state.view = viewsOfNow.find((view) => view.key === key);
    showView();
  });
  if (axes.length > 2) addSlices(controls, axes, state, redraw);
  showQuantity(quantities[0].key);
}

// Which two axes are shown, and a slider for each of the others.
function addSlices(controls, axes, state, redraw) {
  const names = axes.map((axis, a) => [String(a), axis.name]);
  const free = () => axes.map((_, a) => a).filter((a) => !state.shown.includes(a));
  const choose = (side) => (value) => {
    const chosen = Number(value);
    // the axis that the other side already shows: swap them
    if (state.shown[1 - side] === chosen) state.shown[1 - side] = state.shown[side];
    state.shown[side] = chosen;
    selects.forEach((select, i) => {
      select.select.value = String(state.shown[i]);
    });
    setSliders();
    redraw();
  };
  const selects = ['Across', 'Up'].map((label, side) =>
    addSelect(controls, label, names, choose(side), String(state.shown[side])),
  );
  const group = element('div', { class: 'controls sliders' });
  controls.after(group);
  const sliders = free().map((_, i) =>
    addSlider(group, '', (index) => {
      state.fixed[free()[i]] = index;
      redraw();
    }),
  );
  const setSliders = () => free().forEach((a, i) => sliders[i].set(axes[a], state.fixed[a]));
  setSliders();
}
