// What stands around the figures: header, verdicts, contents, provenance, what each metric means.

const kindText = { isotropic: 'isotropic', anisotropic: 'anisotropic' };
const sizeText = (table) => table.axes.map((axis) => axis.values.length).join(' \u00d7 ');
const tableTitle = (table) => `${table.name}, ${kindText[table.kind] ?? table.kind} ${sizeText(table)}`;

function verdictMark(pass) {
  return element('span', { class: pass ? 'pass' : 'fail' }, pass ? '\u2713 pass' : '\u2717 fail');
}

function fillHeader(report) {
  const verdicts = report.tables.flatMap((table) => table.verdicts);
  const failed = verdicts.filter((verdict) => !verdict.pass).length;
  const names = report.tables.flatMap((table, i) => [i > 0 ? ', ' : null, element('span', {}, table.name)]);
  let result = element('p', { class: 'result' }, 'no checks were made');
  if (failed > 0)
    result = element('p', { class: 'result fail' }, `\u2717 ${failed} of ${verdicts.length} checks fail`);
  else if (verdicts.length > 0)
    result = element('p', { class: 'result pass' }, `\u2713 all ${verdicts.length} checks pass`);
  const facts = report.tables.map((table) =>
    element(
      'li',
      {},
      `${tableTitle(table)}: ${countText(table.nodes)} nodes`,
      table.against.length > 0 ? `, against ${table.against.join(', ')}` : null,
    ),
  );
  facts.push(
    ...report.shading.map((shading) =>
      element('li', {}, `${shading.table.name}, rendered: `, verdictMark(shading.passed), `, ${agreementText(shading)}`),
    ),
  );
  document
    .getElementById('top')
    .append(
      element('p', { class: 'kicker' }, `ltcfit ${report.tool_version} report`),
      element('h1', {}, names),
      result,
      element('ul', { class: 'facts' }, facts),
    );
}

function fillContents(entries) {
  document.getElementById('contents').append(
    element(
      'ul',
      {},
      entries.map(([id, title, inner]) =>
        element(
          'li',
          {},
          element('a', { href: `#${id}` }, title),
          inner && inner.length > 0
            ? element(
                'ul',
                {},
                inner.map(([innerId, innerTitle]) =>
                  element('li', {}, element('a', { href: `#${innerId}` }, innerTitle)),
                ),
              )
            : null,
        ),
      ),
    ),
  );
}

function verdictSection(report) {
  const columns = [
    { title: 'Verdict' },
    { title: 'Check', head: true, class: 'wide' },
    { title: 'Value', number: true },
    { title: 'Limit', number: true },
    { title: 'Detail', class: 'wide' },
  ];
  const parts = report.tables.map((table) => {
    if (table.verdicts.length === 0) return note(`${table.name}: no checks were made.`);
    // what fails comes first
    const ordered = [...table.verdicts].sort((a, b) => a.pass - b.pass);
    const rows = ordered.map((verdict) => [
      verdictMark(verdict.pass),
      verdict.what,
      numberText(verdict.value),
      `${verdict.relation.replace('<=', '\u2264').replace('>=', '\u2265')} ${numberText(verdict.limit)}`,
      verdict.detail || '',
    ]);
    const made = tableOf(table.name, columns, rows);
    made.classList.add('verdicts');
    // on a phone the cells stand under one another, without their headings
    for (const row of made.tBodies[0].rows)
      [...row.cells].forEach((cell, i) => cell.setAttribute('data-title', columns[i].title));
    ordered.forEach((verdict, i) => {
      if (!verdict.pass) made.tBodies[0].rows[i].classList.add('failed');
    });
    return scrolling(made, `Checks of ${table.name}`);
  });
  return section('verdicts', 2, 'Verdicts', ...parts);
}

function listOf(pairs) {
  return element(
    'dl',
    { class: 'facts' },
    pairs
      .filter(([, value]) => value !== '' && value !== null && value !== undefined)
      .map(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]),
  );
}

const optionText = (options) =>
  Object.entries(options ?? {})
    .map(([name, value]) => `${name} ${value}`)
    .join(', ');
const code = (text) => (text ? element('code', {}, text) : '');

function provenanceSection(report) {
  const tables = report.tables.map((table) => {
    const from = table.provenance ?? {};
    const origin = [from.tool, from.tool_version].filter(Boolean).join(' ');
    return [
      element('h3', {}, table.name),
      listOf([
        ['made by', origin || 'unknown: the file does not say'],
        ['command', code(from.command)],
        ['seed', isNumber(from.seed) ? String(from.seed) : ''],
        ['options', optionText(from.options)],
        ['size', `${sizeText(table)} (${table.axes.map((axis) => axis.name).join(', ')})`],
        ['stores', `${table.stores}, ${table.normalization}`],
        [
          'interpolated',
          table.interpolated ? `${table.interpolated.stores}, ${table.interpolated.normalization}` : '',
        ],
        ['channels', table.channels.join(', ')],
        ['alpha floor', numberText(table.alpha_floor)],
        ['compared with', table.against.join(', ')],
      ]),
    ];
  });
  const others = [
    ...report.shading.map((shading) => [`Shading, ${shadingKind(shading)}`, shading]),
    ...report.pareto.map((pareto) => [`Error against run time, ${paretoKind(pareto)}`, pareto]),
    ...(report.stability ? [['Stability', report.stability]] : []),
  ].map(([title, part]) => [
    element('h3', {}, title),
    listOf([
      ['made by', `ltcfit ${part.tool_version}`],
      ['command', code(part.command)],
      ['options', optionText(part.options)],
    ]),
  ]);
  return section(
    'provenance',
    2,
    'Provenance',
    element('h3', {}, 'This report'),
    listOf([
      ['made by', `ltcfit ${report.tool_version}`],
      ['command', code(report.command)],
      ['options', optionText(report.options)],
    ]),
    ...tables.flat(),
    ...others.flat(),
  );
}

const metricId = (name) => idOf('metric', name);
const metricLink = (name) => element('a', { href: `#${metricId(name)}` }, name);

function metricSection(metrics) {
  return section(
    'metrics',
    2,
    'What the figures mean',
    note('All are errors: less is better. Ratios are of this table to the other: below 1 this table is better.'),
    element(
      'dl',
      { class: 'meanings' },
      metrics.map((metric) => [
        element('dt', { id: metricId(metric.name) }, withUnit(metric.name, metric.unit)),
        element('dd', {}, metric.meaning),
      ]),
    ),
  );
}

function fillFooter(report) {
  document
    .getElementById('footer')
    .append(
      element(
        'p',
        {},
        `Made by ltcfit ${report.tool_version}. Charts: Apache ECharts ${echarts.version}, `,
        'Apache License 2.0. The page reads nothing from the network.',
      ),
      element('p', {}, element('a', { href: '#top' }, 'Back to the top')),
    );
}
