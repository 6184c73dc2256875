// Pictures of single lobes: the GGX lobe, the table's LTC, and their difference.

function lobeFigure(image, images) {
  const source = images[image.id];
  const caption = element(
    'figcaption',
    {},
    element('strong', {}, image.what),
    image.table ? element('span', {}, ` ${image.table}`) : null,
  );
  // only pictures that the page itself holds
  const picture =
    typeof source === 'string' && source.startsWith('data:image/')
      ? element('img', { src: source, alt: image.alt, loading: 'eager' })
      : element('p', { class: 'no-picture' }, 'no picture');
  return element('figure', { class: image.what === 'GGX' ? 'target' : '' }, picture, caption);
}

function lobeLegends(lobe) {
  const signed = (value) => `${value > 0 ? '+' : '\u2212'}${numberText(Math.abs(value), 2)}`;
  const ends = [
    [0, signed(-lobe.difference)],
    [0.5, '0'],
    [1, signed(lobe.difference)],
  ];
  return element(
    'div',
    { class: 'lobe-legends' },
    isNumber(lobe.peak)
      ? colorBar('density in sr\u207b\u00b9', viridis, [
          [0, '0'],
          [1, numberText(lobe.peak)],
        ])
      : null,
    isNumber(lobe.difference) ? colorBar('LTC \u2212 GGX in sr\u207b\u00b9', blueOrange, ends) : null,
  );
}

function lobeFigures(lobe, metrics) {
  const names = [...new Set(lobe.figures.flatMap((figure) => Object.keys(figure.metrics)))];
  const units = new Map(metrics.map((metric) => [metric.name, metric.unit]));
  const columns = [
    { title: 'Table', head: true, class: 'name' },
    ...names.map((name) => ({ title: withUnit(name, units.get(name)), number: true })),
  ];
  const rows = lobe.figures.map((figure) => [figure.table, ...names.map((name) => numberText(figure.metrics[name]))]);
  return scrolling(tableOf('Errors of this lobe', columns, rows), `Errors at ${lobe.title}`);
}

function lobeCard(lobe, images, metrics) {
  const target = lobe.images.filter((image) => image.table === null);
  const others = lobe.images.filter((image) => image.table !== null);
  return element(
    'article',
    { class: 'lobe' },
    element('h4', {}, lobe.title),
    element('p', { class: 'note' }, `Pictures are ${numberText(2 * lobe.half_width_degrees)}\u00b0 wide and high.`),
    element(
      'div',
      { class: 'lobe-pictures' },
      element(
        'div',
        { class: 'first' },
        target.map((image) => lobeFigure(image, images)),
        lobeLegends(lobe),
      ),
      element(
        'div',
        { class: 'pairs' },
        others.map((image) => lobeFigure(image, images)),
      ),
    ),
    lobeFigures(lobe, metrics),
  );
}

function lobeSection(table, images, metrics, id) {
  const made = section(`${id}-lobes`, 3, 'Lobes');
  if (table.lobes.length === 0) {
    made.append(note('No lobes were drawn.'));
    return made;
  }
  made.append(
    note(
      'Densities per solid angle, lobes normalised to 1. In the difference blue is where the LTC has too little, ' +
        'orange where it has too much. The line is the horizon.',
    ),
    element(
      'div',
      { class: 'lobes' },
      table.lobes.map((lobe) => lobeCard(lobe, images, metrics)),
    ),
  );
  return made;
}
