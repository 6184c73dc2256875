// How often which error: histograms of the tables over one another, told apart by line and fill.

const dashes = ['', '6 3', '2 3', '10 3 2 3', '1 4'];
const dashLists = dashes.map((dash) => (dash ? dash.split(' ').map(Number) : 'solid'));

// How many points are in the bins, and which have no place on the axis.
function pointsOf(series) {
  const drawn = series.counts.reduce((sum, count) => sum + (count ?? 0), 0);
  const others = [
    series.zero > 0 ? `${countText(series.zero)} exactly 0` : null,
    series.non_finite > 0 ? `${countText(series.non_finite)} not finite` : null,
  ].filter(Boolean);
  return `${countText(drawn)} points${others.length > 0 ? `, without ${others.join(' and ')}` : ''}`;
}

function histogramLegend(histogram, colors) {
  return legendOf(
    histogram.series.map((series, i) => {
      const color = colors.series[i % colors.series.length];
      const line = drawing('path', {
        d: 'M1 12 V5 H17 V8 H33',
        fill: 'none',
        stroke: color,
        'stroke-width': 2,
        'stroke-dasharray': dashes[i % dashes.length] || 'none',
      });
      const fill = drawing('path', { d: 'M1 13 V5 H17 V8 H33 V13 Z', fill: color, 'fill-opacity': 0.25 });
      return [sample(...(i === 0 ? [fill, line] : [line])), `${series.table} (${pointsOf(series)})`];
    }),
  );
}

function outline(counts, places, api, color, i) {
  const points = counts.flatMap((count, bin) => [
    api.coord([places[bin], count ?? 0]),
    api.coord([places[bin + 1], count ?? 0]),
  ]);
  const ground = [places[places.length - 1], places[0]].map((place) => api.coord([place, 0]));
  const fill = { type: 'polygon', shape: { points: [...points, ...ground] }, style: { fill: color, opacity: 0.25 } };
  const line = {
    type: 'polyline',
    shape: { points },
    style: { stroke: color, fill: 'none', lineWidth: 2, lineDash: dashLists[i % dashLists.length] },
  };
  return { type: 'group', children: i === 0 ? [fill, line] : [line] };
}

function histogramOption(colors, width, histogram, title) {
  const edges = histogram.edges.filter(isNumber);
  const place = (edge) => (histogram.log ? Math.log10(edge) : edge);
  const xAxis = histogram.log
    ? logAxis(colors, `${title} (logarithmic)`, 30, edges[0], edges[edges.length - 1], width < 500 ? 5 : 9)
    : { ...axisStyle(colors, title, 30), type: 'value', min: edges[0], max: edges[edges.length - 1] };
  const binText = (bin) => `${numberText(edges[bin])} to ${numberText(edges[bin + 1])}`;
  return {
    grid: { left: 62, right: 16, top: 12, bottom: 50 },
    xAxis: { ...xAxis, splitLine: { show: false } },
    yAxis: { ...axisStyle(colors, 'points per bin', 46), type: 'value', min: 0, minInterval: 1 },
    tooltip: {
      ...frame(colors).tooltip,
      trigger: 'axis',
      axisPointer: { type: 'line', animation: false },
      formatter: (items) => {
        const bin = items[0].dataIndex;
        return tooltipOf(
          binText(bin),
          ...histogram.series.map((series) => `${series.table}: ${countText(series.counts[bin])}`),
        );
      },
    },
    series: histogram.series.map((series, i) => ({
      type: 'custom',
      name: series.table,
      clip: true,
      z: 3 + histogram.series.length - i,
      data: series.counts.map((count, bin) => [(place(edges[bin]) + place(edges[bin + 1])) / 2, count]),
      // the whole outline at the first bin: ECharts' own stepped lines are slanted where a step is small
      renderItem: (params, api) =>
        params.dataIndex > 0
          ? null
          : outline(series.counts, edges.map(place), api, colors.series[i % colors.series.length], i),
    })),
  };
}

function histogramLabel(histogram, title) {
  const tops = histogram.series.map((series) => {
    const bin = series.counts.indexOf(Math.max(...series.counts.map((count) => count ?? 0)));
    return (
      `${series.table} has most points between ${numberText(histogram.edges[bin])} and ` +
      numberText(histogram.edges[bin + 1])
    );
  });
  return `Histogram of ${title}, ${histogram.points}: ${tops.join('; ')}.`;
}

function histogramTable(histogram, title) {
  const columns = [
    { title: `${title}, from`, number: true },
    { title: 'to', number: true },
    ...histogram.series.map((series) => ({ title: series.table, number: true })),
  ];
  const rows = histogram.edges
    .slice(1)
    .map((edge, i) => [
      numberText(histogram.edges[i]),
      numberText(edge),
      ...histogram.series.map((series) => countText(series.counts[i])),
    ]);
  return scrolling(tableOf('Points per bin', columns, rows), 'Points per bin');
}

function histogramSection(table, metrics, id) {
  const made = section(`${id}-histograms`, 3, 'Histograms');
  if (table.histograms.length === 0) {
    made.append(note('No histograms.'));
    return made;
  }
  const units = new Map(metrics.map((metric) => [metric.name, metric.unit]));
  const unique = (key) => [...new Set(table.histograms.map((histogram) => histogram[key]))];
  let current = table.histograms[0];
  const controls = element('div', { class: 'controls' });
  const legend = element('div', {});
  const numbers = element('details', {}, element('summary', {}, 'As numbers'));
  made.append(controls, legend);
  const title = () => withUnit(current.metric, units.get(current.metric));
  const chart = addChart(
    made,
    `${id}-histogram`,
    (colors, width) => {
      legend.replaceChildren(histogramLegend(current, colors));
      return histogramOption(colors, width, current, title());
    },
    () => histogramLabel(current, title()),
  );
  made.append(numbers);
  const show = (metric, points) => {
    current =
      table.histograms.find((histogram) => histogram.metric === metric && histogram.points === points) ??
      table.histograms.find((histogram) => histogram.metric === metric);
    pointSelect.select.value = current.points;
    numbers.replaceChildren(numbers.firstChild, histogramTable(current, title()));
    chart.draw();
  };
  const metricSelect = addSelect(
    controls,
    'Metric',
    unique('metric').map((name) => [name, name]),
    (metric) => show(metric, pointSelect.select.value),
  );
  const pointSelect = addSelect(
    controls,
    'Points',
    unique('points').map((name) => [name, pointsText[name] ?? name]),
    (points) => show(metricSelect.select.value, points),
  );
  show(current.metric, current.points);
  return made;
}
