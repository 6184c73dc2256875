// Error reached against run time, for every fitter and setting: the section around the chart.

function rangeText(middle, low, high, format = numberText) {
  if (!isNumber(low) || !isNumber(high) || low === high) return format(middle);
  return `${format(middle)} (${format(low)} to ${format(high)})`;
}

const timeText = ({ median, low, high }) => rangeText(median, low, high, milliseconds);

// The metrics to choose from. Over the best known at each entry, the lobe's width cancels: SW1rel shows nothing new.
function metricNames(pareto) {
  const same = pareto.settings.every(({ errors: { SW1, SW1rel } }) => SW1 && SW1rel && SW1.ratio === SW1rel.ratio);
  return pareto.metrics.map(({ name }) => name).filter((name) => !(same && name === 'SW1rel'));
}

function settingTable(pareto, metric) {
  const columns = [
    { title: 'Fitter', head: true },
    { title: 'Setting', class: 'name' },
    { title: 'Default of' },
    { title: 'CPU ms an entry (low to high)', number: true },
    { title: `${metric} / best known (low to high)`, number: true },
    { title: `${metric}, about`, number: true },
    { title: 'On the front' },
    { title: 'Entries', number: true },
    { title: 'Runs', number: true },
    { title: 'Not converged', number: true },
    { title: 'Not finite', number: true },
  ];
  const order = [...pareto.settings].sort((a, b) => a.cpu_seconds.median - b.cpu_seconds.median);
  const made = tableOf(
    `All settings, fastest first; ${metric}`,
    columns,
    order.map((setting) => {
      const error = setting.errors[metric] ?? {};
      return [
        setting.fitter,
        setting.name + (setting.preset ? ` (${setting.preset})` : ''),
        setting.default_of.join(', '),
        timeText(setting.cpu_seconds),
        rangeText(error.ratio, error.low, error.high),
        numberText(error.value),
        error.front ? '\u25cf yes' : '',
        countText(setting.entries),
        countText(setting.runs),
        countText(setting.not_converged),
        countText(setting.non_finite),
      ];
    }),
  );
  order.forEach((setting, i) => {
    if (setting.default_of.length > 0) made.tBodies[0].rows[i].classList.add('chosen');
  });
  return scrolling(made, 'All settings');
}

function paretoLabel(pareto, metric) {
  const front = drawable(pareto, metric).filter((setting) => setting.errors[metric].front);
  return (
    `Scatter of ${metric} over the best known against CPU time, ${paretoKind(pareto)}. On the front: ` +
    `${front.map(settingText).join('; ') || 'none'}. The table below has all figures.`
  );
}

function paretoSection(paretos) {
  const made = section('pareto', 2, 'Error against run time');
  if (paretos.length === 0) {
    made.append(absent('Error against run time', '--pareto FILE'));
    return made;
  }
  let current = paretos[0];
  // what the defaults are chosen by
  let metric = current.metrics.find(({ name }) => name === 'light')?.name ?? current.metrics[0].name;
  const controls = element('div', { class: 'controls' });
  const legend = element('div', {});
  const meaning = note();
  const body = element('div', {});
  made.append(controls, meaning, legend);
  const chart = addChart(
    made,
    'pareto-chart',
    (colors, width, height) => {
      legend.replaceChildren(paretoLegend(current, colors));
      return paretoOption(colors, width, height, current, metric);
    },
    () => paretoLabel(current, metric),
  );
  chart.box.classList.add('tall');
  made.append(body);
  const show = () => {
    const about = current.metrics.find(({ name }) => name === metric);
    const left = current.metrics.some(({ name }) => name === 'SW1rel') && !metricNames(current).includes('SW1rel');
    meaning.textContent =
      `${withUnit(metric, about.unit)}: ${about.meaning} Over ${current.entries.length} entries.` +
      (left && metric === 'SW1' ? ' SW1rel has the same ratios.' : '');
    body.replaceChildren(
      ...(current.defaults.length > 0
        ? [
            element('h3', {}, 'Why these defaults'),
            listOf(
              current.defaults.map((entry) => [
                entry.command,
                `${settingText(current.settings[entry.setting])}: ${entry.why}`,
              ]),
            ),
          ]
        : []),
      settingTable(current, metric),
    );
    chart.draw();
  };
  if (paretos.length > 1) {
    addSelect(
      controls,
      'Table',
      paretos.map((pareto, i) => [String(i), paretoKind(pareto)]),
      (value) => {
        current = paretos[Number(value)];
        const names = metricNames(current);
        if (!names.includes(metric)) [metric] = names;
        metricSelect.select.replaceChildren(...names.map((name) => element('option', { value: name }, name)));
        metricSelect.select.value = metric;
        show();
      },
    );
  } else {
    made.insertBefore(note(`${paretoKind(current)} table`), controls);
  }
  const metricSelect = addSelect(
    controls,
    'Metric',
    metricNames(current).map((name) => [name, name]),
    (value) => {
      metric = value;
      show();
    },
  );
  metricSelect.select.value = metric;
  show();
  return made;
}
