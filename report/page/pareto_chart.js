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

// Places for texts beside points, all in pixels: for each of `anchors`, { x, y, width, height } with the middle of the
// point and the size of its text, the nearest place within `area` that covers neither a point nor another text.
function placeTexts(anchors, points, area) {
  const pointRoom = 9;
  const taken = points.map(([x, y]) => ({ x: x - pointRoom, y: y - pointRoom, width: 2 * pointRoom, height: 2 * pointRoom }));
  const meet = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
  const clamp = (value, low, high) => Math.max(low, Math.min(high, value));
  return anchors.map(({ x, y, width, height }) => {
    let best = null;
    for (let distance = 16; distance < 240 && !best; distance += 8) {
      for (let k = 0; k < 16; k++) {
        // up first, then to both sides
        const angle = (Math.ceil(k / 2) * (k % 2 ? 1 : -1) * Math.PI) / 8;
        const middle = [
          x + (distance + width / 2) * Math.sin(angle),
          y - (distance + height / 2) * Math.cos(angle),
        ];
        const box = {
          x: clamp(middle[0] - width / 2, area.left, area.right - width),
          y: clamp(middle[1] - height / 2, area.top, area.bottom - height),
          width,
          height,
        };
        if (taken.some((other) => meet(box, other))) continue;
        best = box;
        break;
      }
    }
    best ??= { x: clamp(x - width / 2, area.left, area.right - width), y: area.top, width, height };
    taken.push(best);
    return best;
  });
}

// What the defaults are called, with a line from each name to its point.
function defaultLabels(places, colors) {
  return {
    type: 'custom',
    silent: true,
    z: 6,
    tooltip: { show: false },
    data: places.map(({ x, y }) => [x, y]),
    renderItem: ({ dataIndex }) => {
      const { x, y, box, text } = places[dataIndex];
      const end = [Math.max(box.x, Math.min(box.x + box.width, x)), y < box.y ? box.y : Math.min(y, box.y + box.height)];
      const length = Math.hypot(end[0] - x, end[1] - y);
      const ring = 10; // where the line starts
      const line = {
        type: 'line',
        shape: { x1: x + (ring * (end[0] - x)) / length, y1: y + (ring * (end[1] - y)) / length, x2: end[0], y2: end[1] },
        style: { stroke: colors.mark, lineWidth: 1 },
      };
      const name = {
        type: 'text',
        x: box.x,
        y: box.y,
        style: { text, font: labelFont(colors), fill: colors.text, stroke: colors.paper, lineWidth: 3 },
      };
      return { type: 'group', children: length > ring ? [line, name] : [name] };
    },
  };
}

const labelFont = (colors) => `bold 11px ${colors.font}`;
const measuring = document.createElement('canvas').getContext('2d');
function textWidth(text, font) {
  measuring.font = font;
  return measuring.measureText(text).width;
}

function paretoOption(colors, width, height, pareto, metric) {
  const settings = drawable(pareto, metric);
  const times = settings.flatMap(({ cpu_seconds: t }) => [t.median, t.low, t.high]).filter((value) => value > 0);
  const ratios = settings
    .flatMap(({ errors: { [metric]: e } }) => [e.ratio, e.low, e.high])
    .filter((value) => value > 0);
  const [left, right] = settings.length > 0 ? rangeOf(times) : [0.01, 1];
  const [low, high] = settings.length > 0 ? rangeOf(ratios) : [1, 10];
  const narrow = width < 500;
  const place = (setting) => [Math.log10(setting.cpu_seconds.median), Math.log10(setting.errors[metric].ratio)];
  const grid = { left: narrow ? 58 : 66, right: 18, top: 14, bottom: 50 };
  const area = { left: grid.left, right: width - grid.right, top: grid.top, bottom: height - grid.bottom };
  const pixels = (setting) => {
    const [x, y] = place(setting);
    return [
      area.left + ((x - Math.log10(left)) / Math.log10(right / left)) * (area.right - area.left),
      area.bottom - ((y - Math.log10(low)) / Math.log10(high / low)) * (area.bottom - area.top),
    ];
  };
  const defaults = settings.filter((setting) => setting.default_of.length > 0);
  const texts = defaults.map((setting) => setting.default_of.join(', '));
  const anchors = defaults.map((setting, i) => {
    const [x, y] = pixels(setting);
    return { x, y, width: textWidth(texts[i], labelFont(colors)), height: 12 };
  });
  const boxes = placeTexts(anchors, settings.map(pixels), area);
  const labels = anchors.map(({ x, y }, i) => ({ x, y, box: boxes[i], text: texts[i] }));
  return {
    grid,
    xAxis: logAxis(colors, 'CPU ms for one entry (logarithmic)', 30, left, right, narrow ? 5 : 9, milliseconds),
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
                `${timeText(time)} ms for one entry`,
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
        data: defaults.map(place),
      },
      defaultLabels(labels, colors),
    ],
  };
}
