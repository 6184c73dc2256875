// The chart of random scenes: the error of the table against that of the other one.

const isCloser = (scene) => scene.against !== null && scene.against.rmse < scene.error.rmse;
const alphaText = ([x, y]) => (x === y ? numberText(x) : `${numberText(x)} \u00d7 ${numberText(y)}`);
const unresolvedText = 'not exact enough: more than a tenth of what it judges';

// What can stand in a logarithmic chart.
const comparable = (scenes) => scenes.filter(({ error, against }) => error.rmse > 0 && against?.rmse > 0);

// The kinds of points, those of the other table on top.
function pointKinds(shading, colors) {
  const [own, other] = [shading.table.name, shading.against.name];
  const kind = (lost, resolved) => ({
    text: `${lost ? other : own} is closer${resolved ? '' : ', reference not exact enough'}`,
    holds: (scene) => isCloser(scene) === lost && scene.reference.resolved === resolved,
    symbol: lost ? symbols[3] : symbols[0],
    path: lost ? symbolShapes[3] : symbolShapes[0],
    size: lost ? 12 : 8,
    color: colors.series[lost ? 1 : 0],
    fill: resolved ? colors.series[lost ? 1 : 0] : colors.paper,
  });
  return [kind(false, true), kind(false, false), kind(true, true), kind(true, false)];
}

function scatterLegend(shading, scenes, colors) {
  const kinds = pointKinds(shading, colors).filter(({ holds }) => scenes.some(holds));
  return legendOf([
    ...kinds.map(({ path, color, fill, text }) => [
      sample(drawing('path', { ...path, fill, stroke: color, 'stroke-width': 1.5 })),
      text,
    ]),
    [
      sample(drawing('path', { d: 'M1 13 L33 1', fill: 'none', stroke: colors.quiet, 'stroke-dasharray': '5 3' })),
      'both alike',
    ],
  ]);
}

function sceneTooltip(shading, scene) {
  const { error, against, reference } = scene;
  return tooltipOf(
    `${scene.name}, alpha ${alphaText(scene.alpha)}`,
    `RMSE of ${shading.table.name}: ${numberText(error.rmse)}`,
    `RMSE of ${shading.against.name}: ${numberText(against.rmse)}`,
    `the one over the other: ${ratioText(error.rmse / against.rmse)}`,
    `own error of the reference: ${numberText(reference.rmse)}${reference.resolved ? '' : ` (${unresolvedText})`}`,
    ...(isCloser(scene) ? [`${shading.against.name} is closer: ${scene.explanation || 'no explanation'}`] : []),
  );
}

function scatterOption(colors, width, shading, scenes) {
  const narrow = width < 500;
  // one range for both axes, so that the diagonal is where both are alike
  const [low, high] = rangeOf(scenes.flatMap(({ error, against }) => [error.rmse, against.rmse]));
  const most = narrow ? 5 : 7;
  const place = ({ error, against }) => [Math.log10(against.rmse), Math.log10(error.rmse)];
  // names may be longer than an axis
  const short = (name) => (name.length > 30 ? `${name.slice(0, 29)}\u2026` : name);
  return {
    grid: { left: narrow ? 62 : 70, right: 18, top: 14, bottom: 50 },
    xAxis: logAxis(colors, `RMSE of ${short(shading.against.name)} (log)`, 30, low, high, most),
    yAxis: logAxis(colors, `RMSE of ${short(shading.table.name)} (log)`, narrow ? 46 : 52, low, high, most),
    tooltip: { ...frame(colors).tooltip, trigger: 'item' },
    series: [
      {
        type: 'line',
        symbol: 'none',
        silent: true,
        z: 1,
        tooltip: { show: false },
        data: [low, high].map((end) => [Math.log10(end), Math.log10(end)]),
        lineStyle: { color: colors.quiet, width: 1.5, type: [5, 3] },
      },
      ...pointKinds(shading, colors).flatMap(({ holds, symbol, size, color, fill }, i) => {
        const own = scenes.filter(holds);
        if (own.length === 0) return [];
        return {
          type: 'scatter',
          z: 3 + i,
          symbol,
          symbolSize: size,
          data: own.map(place),
          itemStyle: { opacity: 1, color: fill, borderColor: color, borderWidth: 1.5 },
          tooltip: { formatter: (item) => sceneTooltip(shading, own[item.dataIndex]) },
        };
      }),
    ],
  };
}

function addScatter(parent, id, shading, scenes) {
  const drawn = comparable(scenes);
  if (drawn.length < scenes.length)
    parent.append(
      note(`${countText(scenes.length - drawn.length)} scenes with an error of 0 are not in a logarithmic chart.`),
    );
  if (drawn.length === 0) return;
  const legend = element('div', {});
  parent.append(legend);
  const chart = addChart(
    parent,
    id,
    (colors, width) => {
      legend.replaceChildren(scatterLegend(shading, drawn, colors));
      return scatterOption(colors, width, shading, drawn);
    },
    () =>
      `Scatter of the RMSE of ${shading.table.name} against that of ${shading.against.name} over ` +
      `${countText(drawn.length)} random scenes; below the diagonal, where ${shading.table.name} is closer, lie ` +
      `${countText(drawn.filter((scene) => !isCloser(scene)).length)}. The others are listed below.`,
  );
  chart.box.classList.add('tall', 'even');
}
