// Error maps, and how smooth a table is from node to node.

function byKey(entries, key) {
  const groups = new Map();
  for (const entry of entries) {
    if (!groups.has(entry[key])) groups.set(entry[key], new Map());
    groups.get(entry[key]).set(entry.table, entry.values);
  }
  return groups;
}

function mapSection(table, metrics, id) {
  const made = section(`${id}-maps`, 3, 'Error maps');
  const groups = byKey(table.maps, 'metric');
  const quantities = metrics
    .filter((metric) => groups.has(metric.name))
    .map(({ name, unit }) => ({ key: name, name, unit, values: groups.get(name) }));
  if (quantities.length === 0) {
    made.append(note('No values at the nodes.'));
    return made;
  }
  made.append(
    note('Each cell is a node. One colour scale for all tables and all slices; the lowest 2 % share a colour.'),
  );
  addNodeMap(made, table, {
    id: `${id}-map`,
    what: 'Metric',
    quantities,
    ratioNote:
      'Errors of single nodes are estimates from a few samples, quads and lights, and their ratios scatter: read regions, ' +
      'not cells.',
  });
  if (table.against.length === 0)
    made.append(absent('Maps of another table and of the ratio to it', '--against FILE'));
  return made;
}

function smoothnessTable(table) {
  const columns = [
    { title: 'Along', head: true },
    { title: 'Table', class: 'name' },
    ...statistics.map((title) => ({ title, number: true })),
    { title: 'steps', number: true },
    { title: 'not finite', number: true },
  ];
  const rows = table.smoothness.axes.flatMap(({ axis, results }) =>
    results.map(({ table: name, summary }, i) => [
      i === 0 ? axis : '',
      name,
      ...statistics.map((s) => numberText(summary[s])),
      countText(summary.count),
      countText(summary.non_finite),
    ]),
  );
  return scrolling(
    tableOf(withUnit('Step to the next node', table.smoothness.unit), columns, rows),
    `Smoothness of ${table.name}`,
  );
}

function smoothnessSection(table, id) {
  const { smoothness } = table;
  const made = section(`${id}-smoothness`, 3, 'Smoothness between neighbours', note(smoothness.meaning));
  made.append(smoothnessTable(table));
  const groups = byKey(smoothness.maps, 'axis');
  const quantities = [...groups].map(([axis, values]) => ({
    key: axis,
    name: `step along ${axis}`,
    unit: smoothness.unit,
    values,
  }));
  if (quantities.length > 0) addNodeMap(made, table, { id: `${id}-steps`, what: 'Axis', quantities });
  return made;
}
