// How the fitters behave over the hard entries: limits, findings, and all runs.

const pageSize = 50;

const outcomeText = (outcomes) =>
  Object.entries(outcomes ?? {})
    .filter(([, count]) => count > 0)
    .map(([name, count]) => `${name} ${countText(count)}`)
    .join(', ');

// title, key and the unit or meaning of each column of the rows
const stabilityColumns = [
  ['fitter', 'fitter', 'which fitter; * is the default of the command line'],
  ['alpha_x', 'alpha_x', 'GGX alpha along x'],
  ['alpha_y', 'alpha_y', 'GGX alpha along y'],
  ['theta (\u00b0)', 'theta_degrees', 'angle between view and normal'],
  ['phi (\u00b0)', 'phi_degrees', 'azimuth of the view'],
  ['verdict', 'pass', 'within all limits, to which only the default fitter is held'],
  ['limits broken', 'broken', 'names of the limits'],
  ['SW1', 'sw1', 'from the usual start, on samples that no fit sees'],
  ['SW1 / best', 'sw1_over_best', 'the worst run over the best of any fitter, both at least a hundredth of the width'],
  ['TV', 'tv', 'total variation between lobe and fit'],
  ['spread of starts', 'spread_starts', '(largest - smallest) / smallest SW1 over the starts'],
  ['spread of seeds', 'spread_seeds', 'the same over the seeds'],
  ['cond M', 'condition_m', 'condition number of M'],
  ['cond raw', 'condition_raw', 'of the Hessian over the entries of M'],
  ['cond scaled', 'condition_scaled', 'of the Hessian over the parameters that the fit moves'],
  ['gradient error', 'gradient_error', 'relative, of the derivatives against differences'],
  ['float32 shift', 'float32_shift', 'of the lobe by float32 storage and inversion, in lobe widths'],
  ['half shift (rad)', 'half_shift', 'of the lobe by half storage'],
  ['interpolation', 'interpolation', 'SW1 between the lobe fetched from the default table and the direct fit, in lobe widths'],
  ['runs', 'runs', 'starts times seeds'],
  ['restarted', 'restarted', 'runs whose own descent did not arrive, so that the usual start\u2019s was kept'],
  ['handed over', 'handed_over', 'runs whose lobe the lights did not hold, so that another fit was taken'],
  ['start kept', 'start_kept', 'of those, runs whose start was better than any fit of it'],
  ['not finite', 'non_finite', 'runs'],
  ['det < 0', 'det_negative', 'runs'],
  ['outcomes', 'outcomes', 'how the runs ended'],
];
const textKeys = new Set(['fitter', 'pass', 'broken', 'outcomes']);

function sortValue(row, key) {
  if (key === 'broken') return row.broken.length;
  if (key === 'pass') return row.default ? Number(row.pass) : null;
  if (key === 'outcomes') return outcomeText(row.outcomes);
  return row[key];
}

// Rows without a value stand last, whichever way the others are sorted.
function sorted(rows, key, descending) {
  const sign = descending ? -1 : 1;
  return [...rows].sort((a, b) => {
    const [x, y] = [sortValue(a, key), sortValue(b, key)];
    const [noX, noY] = [x === null || x === undefined, y === null || y === undefined];
    if (noX || noY) return noX - noY;
    return sign * (typeof x === 'string' ? x.localeCompare(y) : x - y);
  });
}

function rowCells(row) {
  return stabilityColumns.map(([, key]) => {
    if (key === 'fitter') return row.fitter + (row.default ? ' *' : '');
    if (key === 'pass') return row.default ? verdictMark(row.pass) : 'not judged';
    if (key === 'broken') return row.broken.join(', ');
    if (key === 'outcomes') return outcomeText(row.outcomes);
    return numberText(row[key]);
  });
}

const plainColumns = () =>
  stabilityColumns.map(([title, key, meaning], i) => ({
    title,
    note: meaning,
    number: !textKeys.has(key),
    head: i === 0,
  }));

// The row's greatest figure in units of its limit, for limits that are named like a figure. A row that passes although a
// figure is above a limit is not held to that one.
function nearness(row, limits) {
  return Math.max(
    0,
    ...limits
      .filter(({ id, limit }) => isNumber(row[id]) && limit > 0 && !(row.pass && row[id] > limit))
      .map(({ id, limit }) => row[id] / limit),
  );
}

// What failed, what came nearest to failing, and last the rows that are not judged, by the same figure.
function worstFirst({ rows, limits }) {
  const rank = (row) => (row.default ? Number(row.pass) : 2);
  return rows
    .map((row) => ({ row, near: nearness(row, limits) }))
    .sort((a, b) => rank(a.row) - rank(b.row) || b.near - a.near)
    .map(({ row }) => row);
}

// For paper: as many as one reads.
function printedRows(stability) {
  const judged = worstFirst(stability).filter((row) => row.default);
  const failed = judged.filter((row) => !row.pass);
  const worst = judged.filter((row) => row.pass).slice(0, 30);
  const columns = plainColumns();
  // as many columns as fit on paper
  const kept = columns
    .map((_, i) => i)
    .filter(
      (i) =>
        !['outcomes', 'condition_raw', 'condition_scaled', 'runs', 'restarted', 'handed_over', 'start_kept', 'non_finite', 'det_negative'].includes(
          stabilityColumns[i][1],
        ),
    );
  const pick = (list) => kept.map((i) => list[i]);
  return tableOf(
    `The ${countText(failed.length)} rows that fail, and of the others the ${worst.length} nearest to a limit`,
    pick(columns),
    [...failed, ...worst].map((row) => pick(rowCells(row))),
  );
}

function addRowBrowser(parent, stability) {
  const state = { fitter: '', verdict: '', key: null, descending: true, page: 0 };
  const controls = element('div', { class: 'controls' });
  const position = element('output', { class: 'position', 'aria-live': 'polite' });
  const previous = element('button', { type: 'button' }, 'Previous');
  const next = element('button', { type: 'button' }, 'Next');
  const all = worstFirst(stability);
  const made = tableOf(
    'All rows; * is the default fitter, which alone is judged: its rows first, those nearest to a limit on top',
    plainColumns(),
    [],
  );
  const headings = [...made.tHead.rows[0].cells];

  const show = () => {
    const matching = all.filter(
      (row) =>
        (state.fitter === '' || row.fitter === state.fitter) &&
        (state.verdict === '' || (row.default && row.pass === (state.verdict === 'pass'))),
    );
    const ordered = state.key === null ? matching : sorted(matching, state.key, state.descending);
    const pages = Math.max(1, Math.ceil(ordered.length / pageSize));
    state.page = Math.min(state.page, pages - 1);
    const first = state.page * pageSize;
    const rows = ordered.slice(first, first + pageSize);
    const body = tableOf('', plainColumns(), rows.map(rowCells)).tBodies[0];
    rows.forEach((row, i) => {
      if (row.default && !row.pass) body.rows[i].classList.add('failed');
    });
    made.tBodies[0].replaceWith(body);
    position.textContent =
      ordered.length === 0
        ? 'no such row'
        : `rows ${first + 1} to ${first + rows.length} of ${countText(ordered.length)}`;
    previous.disabled = state.page === 0;
    next.disabled = state.page === pages - 1;
    headings.forEach((heading, i) => {
      const chosen = stabilityColumns[i][1] === state.key;
      if (chosen) heading.setAttribute('aria-sort', state.descending ? 'descending' : 'ascending');
      else heading.removeAttribute('aria-sort');
    });
  };
  const change = (part) => {
    Object.assign(state, { page: 0 }, part);
    show();
  };
  headings.forEach((heading, i) => {
    const [title, key] = stabilityColumns[i];
    const button = element('button', { type: 'button', class: 'sort' }, title);
    // the first press puts the worst on top
    button.addEventListener('click', () =>
      change({ key, descending: state.key === key ? !state.descending : key !== 'pass' && key !== 'fitter' }),
    );
    heading.replaceChildren(button);
  });
  previous.addEventListener('click', () => change({ page: state.page - 1 }));
  next.addEventListener('click', () => change({ page: state.page + 1 }));
  const fitters = [...new Set(stability.rows.map((row) => row.fitter))];
  addSelect(controls, 'Fitter', [['', 'all'], ...fitters.map((fitter) => [fitter, fitter])], (fitter) =>
    change({ fitter }),
  );
  addSelect(
    controls,
    'Verdict',
    [
      ['', 'all'],
      ['fail', 'fail'],
      ['pass', 'pass'],
    ],
    (verdict) => change({ verdict }),
  );
  const box = scrolling(made, 'All rows of the stability runs');
  box.classList.add('high');
  parent.append(controls, element('div', { class: 'pager' }, previous, next, position), box);
  show();
}

function stabilitySection(stability) {
  const made = section('stability', 2, 'Stability');
  if (!stability) {
    made.append(absent('Stability of the fits', '--stability FILE'));
    return made;
  }
  const names = [...new Set(stability.summary.flatMap((entry) => Object.keys(entry.outcomes ?? {})))];
  const columns = [
    { title: 'Fitter', head: true },
    { title: 'Rows', number: true },
    { title: 'Failed', number: true },
    { title: 'Verdict' },
    { title: 'Runs', number: true },
    { title: 'Not finite', number: true },
    ...names.map((title) => ({ title, number: true })),
  ];
  made.append(
    note(`${stability.set}. Starts: ${stability.starts.join(', ')}. Seeds: ${stability.seeds.join(', ')}.`),
    scrolling(
      tableOf(
        'Fitters; * is the default',
        columns,
        stability.summary.map((entry) => [
          entry.fitter + (entry.default ? ' *' : ''),
          countText(entry.rows),
          entry.default ? countText(entry.failed) : '\u2013',
          entry.default ? verdictMark(entry.failed === 0) : 'not judged',
          countText(entry.runs),
          countText(entry.non_finite),
          ...names.map((name) => countText(entry.outcomes[name] ?? 0)),
        ]),
      ),
      'Stability of each fitter',
    ),
  );
  if (stability.limits.length > 0) {
    made.append(
      scrolling(
        tableOf(
          'Limits',
          [
            { title: 'Name', head: true },
            { title: 'Limit', number: true },
            { title: 'What must hold', class: 'wide' },
          ],
          stability.limits.map(({ id, limit, text }) => [id, numberText(limit), text]),
        ),
        'Limits',
      ),
    );
  }
  if (stability.findings.length > 0) {
    made.append(
      element('h3', {}, 'Known weaknesses of fitters, looked for again'),
      element(
        'ul',
        { class: 'findings' },
        stability.findings.map((finding) =>
          element(
            'li',
            {},
            element('strong', {}, finding.title),
            `: ${finding.seen ? 'seen' : 'not seen'}. ${countText(finding.rows)} of `,
            `${countText(finding.of)} lobes: ${finding.text}.`,
          ),
        ),
      ),
    );
  }
  made.append(element('h3', {}, 'Rows'));
  if (stability.rows.length === 0) {
    made.append(note('No rows.'));
    return made;
  }
  const browser = element('div', { class: 'screen-only' });
  addRowBrowser(browser, stability);
  const printed = element('div', { class: 'print-only' });
  const fill = () => {
    if (printed.childElementCount === 0) printed.append(printedRows(stability));
  };
  paper.addEventListener('change', fill);
  addEventListener('beforeprint', fill);
  made.append(browser, printed);
  return made;
}
