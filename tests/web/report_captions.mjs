// What every selector says is what stands at the axis, in the caption or in the text of what it chooses.
export async function captions(page) {
  return page.evaluate(() => {
    const found = [];
    const report = JSON.parse(document.getElementById('report').textContent);
    const axisName = (box, axis) => echarts.getInstanceByDom(box).getOption()[axis][0].name;
    for (const select of document.querySelectorAll('main select')) {
      const own = select.closest('section');
      const label = select.labels[0].textContent;
      const { value, text } = select.selectedOptions[0];
      const chart = own.querySelector('.chart');
      const spoken = chart?.getAttribute('aria-label') ?? '';
      const part = own.id.replace(/^table-\d+-/, '');
      const holds = {
        'pareto, Table': () => spoken.includes(`, ${text}. `),
        'pareto, Metric': () =>
          axisName(chart, 'yAxis').startsWith(`${text} / `) &&
          spoken.startsWith(`Scatter of ${text} over`) &&
          own.querySelector('caption').textContent.endsWith(`; ${text}`),
        'scores, Points': () => own.querySelector('caption').textContent.startsWith(`${value}, `),
        'maps, Metric': () => own.querySelector('.chart-title').textContent.startsWith(text),
        'maps, Show': () => own.querySelector('.chart-title').textContent.includes(`, ${text}`),
        'smoothness, Axis': () => own.querySelector('.chart-title').textContent.startsWith(text),
        'smoothness, Show': () => own.querySelector('.chart-title').textContent.includes(`, ${text}`),
        'histograms, Metric': () =>
          axisName(chart, 'xAxis').startsWith(text) && spoken.startsWith(`Histogram of ${text}`),
        'histograms, Points': () => spoken.includes(`, ${value}: `),
        'stability, Fitter': () => value === '',
        'stability, Verdict': () => value === '',
      }[`${part}, ${label}`];
      const across = { Across: 'xAxis', Up: 'yAxis' }[label];
      if (across ? !axisName(chart, across).startsWith(text) : !holds)
        found.push(`${own.id}, ${label}: "${text}" is not ${across ? axisName(chart, across) : 'checked'}`);
      else if (holds && !holds()) found.push(`${own.id}, ${label}: "${text}" is not what is shown: ${spoken}`);
    }
    const chosen = Object.fromEntries(
      [...document.querySelectorAll('#pareto select')].map((e) => [e.labels[0].textContent, e]),
    );
    if (chosen.Metric) {
      const { settings } = report.pareto[Number(chosen.Table?.value ?? 0)];
      const ratios = (name) => settings.map(({ errors }) => errors[name]?.ratio).join();
      const offered = [...chosen.Metric.options].some((option) => option.value === 'SW1rel');
      if (offered === (ratios('SW1') === ratios('SW1rel')))
        found.push(`SW1rel ${offered ? 'is offered, with the ratios of SW1' : 'is not offered'}`);
    }
    return found;
  });
}
