// The chart of error against run time: a symbol for each setting, whiskers, the front, the defaults.

const paretoKind = (pareto) => ({ iso: 'isotropic', aniso: 'anisotropic' })[pareto.table] ?? pareto.table;
const symbols = [
  'circle',
  'rect',
  'triangle',
  'diamond',
  'path://M0 -6 L2 -2 L6 -2 L3 1 L4 6 L0 3 L-4 6 L-3 1 L-6 -2 L-2 -2 Z',
];
const symbolShapes = [
  { d: 'M12 7 a5 5 0 1 0 10 0 a5 5 0 1 0 -10 0 Z' },
  { d: 'M12 2 H22 V12 H12 Z' },
  { d: 'M17 1.5 L22.5 12 H11.5 Z' },
  { d: 'M17 1 L22 7 L17 13 L12 7 Z' },
  { d: 'M17 1 L18.7 5 L23 5 L20 8 L21 13 L17 10.3 L13 13 L14 8 L11 5 L15.3 5 Z' },
];
const fittersOf = (pareto) => [...new Set(pareto.settings.map((setting) => setting.fitter))];
const settingText = (setting) =>
  `${setting.fitter}, ${setting.name}${setting.preset ? ` (preset ${setting.preset})` : ''}`;

// What can stand in a logarithmic chart: the settings with a time and an error.
function drawable(pareto, metric) {
  return pareto.settings.filter((setting) => setting.cpu_seconds.median > 0 && setting.errors[metric]?.ratio > 0);
}

function paretoLegend(pareto, colors) {
  const mark = (i) =>
    drawing('path', { ...symbolShapes[i % symbolShapes.length], fill: colors.series[i % colors.series.length] });
  return legendOf([
    ...fittersOf(pareto).map((fitter, i) => [sample(mark(i)), fitter]),
    [
      sample(
        drawing('path', {
          d: 'M1 3 H17 V11 H33',
          fill: 'none',
          stroke: colors.text,
          'stroke-width': 1.5,
          'stroke-dasharray': '5 3',
        }),
      ),
      'front: nothing is both faster and better',
    ],
    [
      sample(drawing('circle', { cx: 17, cy: 7, r: 6, fill: 'none', stroke: colors.mark, 'stroke-width': 2 })),
      'a default',
    ],
    [
      sample(drawing('path', { d: 'M9 7 H25 M17 1 V13', stroke: colors.quiet, fill: 'none' })),
      'low to high over repeats',
    ],
  ]);
}

function rangeOf(values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const room = Math.max(1.06, (high / low) ** 0.06);
  return [low / room, high * room];
}

function whiskers(settings, metric, color) {
  const log = (value, fallback) => Math.log10(value > 0 ? value : fallback);
  return {
    type: 'custom',
    silent: true,
    z: 2,
    tooltip: { show: false },
    data: settings.map(({ cpu_seconds: time, errors: { [metric]: error } }) => [
      Math.log10(time.median),
      Math.log10(error.ratio),
      log(time.low, time.median),
      log(time.high, time.median),
      log(error.low, error.ratio),
      log(error.high, error.ratio),
    ]),
    encode: { x: [0, 2, 3], y: [1, 4, 5] },
    renderItem: (_, api) => {
      const at = (x, y) => api.coord([api.value(x), api.value(y)]);
      const line = ([x1, y1], [x2, y2]) => ({
        type: 'line',
        shape: { x1, y1, x2, y2 },
        style: { stroke: color, lineWidth: 1 },
      });
      return { type: 'group', children: [line(at(2, 1), at(3, 1)), line(at(0, 4), at(0, 5))] };
    },
  };
}

function frontLine(settings, metric, right, color) {
  const front = settings
    .filter((setting) => setting.errors[metric].front)
    .sort((a, b) => a.cpu_seconds.median - b.cpu_seconds.median)
    .map((setting) => [Math.log10(setting.cpu_seconds.median), Math.log10(setting.errors[metric].ratio)]);
  if (front.length > 0) front.push([Math.log10(right), front[front.length - 1][1]]);
  return {
    type: 'line',
    step: 'end',
    symbol: 'none',
    silent: true,
    z: 1,
    data: front,
    tooltip: { show: false },
    lineStyle: { color, width: 1.5, type: [5, 3] },
  };
}

function paretoOption(colors, width, pareto, metric) {
  const settings = drawable(pareto, metric);
  const times = settings.flatMap(({ cpu_seconds: t }) => [t.median, t.low, t.high]).filter((value) => value > 0);
  const ratios = settings
    .flatMap(({ errors: { [metric]: e } }) => [e.ratio, e.low, e.high])
    .filter((value) => value > 0);
  const [left, right] = settings.length > 0 ? rangeOf(times) : [0.01, 1];
  const [low, high] = settings.length > 0 ? rangeOf(ratios) : [1, 10];
  const narrow = width < 500;
  const place = (setting) => [Math.log10(setting.cpu_seconds.median), Math.log10(setting.errors[metric].ratio)];
  // beside the point near the edges of the chart, where the text would be cut
  const labelSide = (x) => {
    const at = (x - Math.log10(left)) / Math.log10(right / left);
    return at < 0.2 ? 'right' : at > 0.8 ? 'left' : 'top';
  };
  const defaults = settings.filter((setting) => setting.default_of.length > 0);
  return {
    grid: { left: narrow ? 58 : 66, right: 18, top: 14, bottom: 50 },
    xAxis: logAxis(colors, 'CPU seconds for one entry (logarithmic)', 30, left, right, narrow ? 5 : 9),
    yAxis: logAxis(
      colors,
      narrow ? `${metric} / best known (log)` : `${metric} / best known of each entry (logarithmic)`,
      narrow ? 42 : 48,
      low,
      high,
      8,
      ratioText,
    ),
    tooltip: { ...frame(colors).tooltip, trigger: 'item' },
    series: [
      whiskers(settings, metric, colors.quiet),
      frontLine(settings, metric, right, colors.text),
      ...fittersOf(pareto).map((fitter, i) => {
        const own = settings.filter((setting) => setting.fitter === fitter);
        return {
          type: 'scatter',
          z: 4,
          symbol: symbols[i % symbols.length],
          symbolSize: 11,
          data: own.map(place),
          itemStyle: {
            opacity: 1,
            color: colors.series[i % colors.series.length],
            borderColor: colors.paper,
            borderWidth: 1,
          },
          tooltip: {
            formatter: (item) => {
              const setting = own[item.dataIndex];
              const {
                cpu_seconds: time,
                errors: { [metric]: error },
              } = setting;
              return tooltipOf(
                settingText(setting),
                `${rangeText(time.median, time.low, time.high)} s for one entry`,
                `${metric}: ${rangeText(error.ratio, error.low, error.high)} \u00d7 the best known, about ${numberText(error.value)}`,
                ...(setting.default_of.length > 0 ? [`default of ${setting.default_of.join(', ')}`] : []),
              );
            },
          },
        };
      }),
      {
        type: 'scatter',
        z: 5,
        silent: true,
        symbol: 'circle',
        symbolSize: 20,
        tooltip: { show: false },
        itemStyle: { opacity: 1, color: 'transparent', borderColor: colors.mark, borderWidth: 2 },
        data: defaults.map((setting) => ({
          value: place(setting),
          label: { position: labelSide(place(setting)[0]) },
        })),
        label: {
          show: true,
          distance: 5,
          color: colors.text,
          fontSize: 11,
          fontWeight: 'bold',
          textBorderColor: colors.paper,
          textBorderWidth: 3,
          formatter: (item) => defaults[item.dataIndex].default_of.join(', '),
        },
      },
    ],
  };
}
