// Charts: one ECharts instance each, redrawn when the width, the colour scheme or the medium changes.

const charts = [];
const darkness = matchMedia('(prefers-color-scheme: dark)');
const paper = matchMedia('print');
const printWidth = 660; // pixels: what A4 leaves between its margins

function theme() {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(`--${name}`).trim();
  return {
    text: color('text'),
    quiet: color('quiet'),
    line: color('line'),
    paper: color('paper'),
    hole: color('hole'),
    mark: color('mark'),
    series: ['series-0', 'series-1', 'series-2', 'series-3', 'series-4'].map(color),
    font: style.getPropertyValue('font-family'),
  };
}

// What all charts have in common.
function frame(colors) {
  return {
    animation: false,
    textStyle: { fontFamily: colors.font, color: colors.text, fontSize: 12 },
    tooltip: {
      confine: true,
      backgroundColor: colors.paper,
      borderColor: colors.line,
      transitionDuration: 0,
      extraCssText: 'max-width: min(340px, calc(100vw - 40px)); white-space: normal; overflow-wrap: anywhere;',
      textStyle: { color: colors.text, fontSize: 12, fontFamily: colors.font },
    },
  };
}

function axisStyle(colors, name, gap) {
  return {
    name,
    nameLocation: 'middle',
    nameGap: gap,
    nameTextStyle: { color: colors.text, fontSize: 12 },
    axisLine: { show: true, onZero: false, lineStyle: { color: colors.quiet } },
    axisTick: { lineStyle: { color: colors.quiet } },
    axisLabel: { color: colors.text, fontSize: 11, hideOverlap: true },
    splitLine: { lineStyle: { color: colors.line } },
  };
}

// An axis of log10(value): ECharts' own has ticks at whole decades only.
function logAxis(colors, name, gap, low, high, most, format = numberText) {
  const style = axisStyle(colors, name, gap);
  const at = logTicks(low, high, most).map((tick) => Math.log10(tick));
  return {
    ...style,
    type: 'value',
    min: Math.log10(low),
    max: Math.log10(high),
    axisLabel: { ...style.axisLabel, customValues: at, formatter: (value) => format(10 ** value) },
    axisTick: { ...style.axisTick, customValues: at },
  };
}

// Adds a chart to `parent`. option(colors, width, height) gives what ECharts draws, label() the text that stands for it.
function addChart(parent, id, option, label) {
  const box = element('div', { class: 'chart', id, role: 'img' });
  parent.append(box);
  let instance = null;
  const chart = {
    box,
    get instance() {
      return instance;
    },
    draw() {
      if (box.clientWidth === 0) return;
      // two pixels for one, so that print is sharp
      instance ??= echarts.init(box, null, { renderer: 'canvas', devicePixelRatio: Math.max(2, devicePixelRatio) });
      // a resize draws everything once more
      if (instance.getWidth() !== box.clientWidth || instance.getHeight() !== box.clientHeight) instance.resize();
      instance.setOption({ ...frame(theme()), ...option(theme(), box.clientWidth, box.clientHeight) }, { notMerge: true });
      box.setAttribute('aria-label', label());
    },
  };
  charts.push(chart);
  return chart;
}

let pending = false;
function redrawSoon() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(() => {
    pending = false;
    charts.forEach((chart) => chart.draw());
  });
}

function redrawNow() {
  charts.forEach((chart) => chart.draw());
}

// In print, charts get the light colours and the paper's width before the page is laid out for it.
function setPrinting(on) {
  document.documentElement.classList.toggle('printing', on);
  document.documentElement.style.setProperty('--print-width', `${printWidth}px`);
  redrawNow();
  // ECharts paints in the next frame, which print does not wait for
  charts.forEach((chart) => chart.instance?.getZr().flush());
}

function watchSurroundings() {
  const observer = new ResizeObserver((entries) => {
    if (entries.some((entry) => entry.contentRect.width > 0)) redrawSoon();
  });
  charts.forEach((chart) => observer.observe(chart.box));
  darkness.addEventListener('change', redrawSoon);
  paper.addEventListener('change', () => setPrinting(paper.matches));
  addEventListener('beforeprint', () => setPrinting(true));
  addEventListener('afterprint', () => setPrinting(false));
}

// Tooltips as elements, never as markup.
const tooltipOf = (...lines) =>
  element(
    'div',
    {},
    lines.map((line, i) => (i === 0 ? element('strong', {}, line) : element('div', {}, line))),
  );
