// The figures of a table over a set of points, and their ratios to those of other tables.

const statistics = ['mean', 'p50', 'p90', 'p99', 'max'];

function ratioCell(ours, theirs) {
  if (!isNumber(ours) || !isNumber(theirs) || theirs === 0) return missing;
  const ratio = ours / theirs;
  const side = ratio < 0.995 ? ['better', '\u25bc'] : ratio > 1.005 ? ['worse', '\u25b2'] : ['equal', '='];
  return element(
    'span',
    { class: side[0] },
    ratioText(ratio),
    ' ',
    element('span', { role: 'img', 'aria-label': side[0] }, side[1]),
  );
}

function scoreRows(results, metrics) {
  const [ours, ...others] = results;
  const rows = [];
  const line = (first, name, summary) => [
    first,
    name,
    ...statistics.map((s) => numberText(summary?.[s])),
    countText(summary?.count),
    countText(summary?.non_finite),
  ];
  for (const metric of metrics) {
    const own = ours.metrics[metric.name];
    if (!own && others.every((other) => !other.metrics[metric.name])) continue;
    const first = element('span', {}, metricLink(metric.name), unitText(metric.unit) ? ` (${metric.unit})` : '');
    rows.push({ cells: line(first, ours.table, own), class: 'first' });
    for (const other of others) {
      const theirs = other.metrics[metric.name];
      rows.push({ cells: line('', other.table, theirs) });
      if (!own || !theirs) continue;
      rows.push({
        cells: ['', 'ratio', ...statistics.map((s) => ratioCell(own[s], theirs[s])), '', ''],
        class: 'ratio',
      });
    }
  }
  return rows;
}

function scoreTable(table, score, metrics) {
  const columns = [
    { title: 'Metric', head: true },
    { title: 'Table', class: 'name' },
    ...statistics.map((title) => ({ title, number: true })),
    { title: 'points', number: true },
    { title: 'not finite', number: true },
  ];
  const rows = scoreRows(score.results, metrics);
  const made = tableOf(
    `${score.points}, ${countText(score.count)} points`,
    columns,
    rows.map((row) => row.cells),
  );
  rows.forEach((row, i) => {
    if (row.class) made.tBodies[0].rows[i].classList.add(row.class);
  });
  made.classList.add('scores');
  return scrolling(made, `Scores of ${table.name}, ${score.points}`);
}

const pointsText = {
  nodes: 'at the nodes',
  'off-grid': 'off-grid: between the nodes, fetched as a shader does',
  extreme: 'extreme: sharp and grazing, fetched as a shader does',
};

function singularText(score) {
  const bad = score.results.filter((result) => result.singular > 0 || result.singular_float32 > 0);
  return bad.length === 0
    ? 'No singular matrix among them.'
    : bad
        .map(
          (result) =>
            `${result.table}: ${countText(result.singular)} singular matrices, ${countText(result.singular_float32)} in float32.`,
        )
        .join(' ');
}

function scoreSection(table, metrics, id) {
  const made = section(`${id}-scores`, 3, 'Scores');
  if (table.scores.length === 0) {
    made.append(note('No points were scored.'));
    return made;
  }
  const controls = element('div', { class: 'controls' });
  const body = element('div', { 'aria-live': 'off' });
  const show = (points) => {
    const score = table.scores.find((candidate) => candidate.points === points);
    body.replaceChildren(note(singularText(score)), scoreTable(table, score, metrics));
  };
  addSelect(
    controls,
    'Points',
    table.scores.map(({ points }) => [points, pointsText[points] ?? points]),
    show,
  );
  made.append(controls, body);
  if (table.against.length === 0) made.append(absent('Ratios to another table', '--against FILE'));
  show(table.scores[0].points);
  return made;
}
