// Colour scales, and the legends that explain them. The pictures of lobes are made with the same two lists of stops,
// evenly spaced and linear in sRGB between them.

// viridis, from low to high
const viridis = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
// from blue, less, over neutral to orange, more: told apart with any colour vision
const blueOrange = ['#1b4f9c', '#7fadd9', '#f2f2f0', '#f2a65a', '#b34700'];

// The colour at `at`, 0..1, of evenly spaced stops; beyond the ends it is theirs.
function colorAt(stops, at) {
  const place = Math.min(1, Math.max(0, at)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(place));
  const channel = (stop, c) => parseInt(stop.slice(1 + 2 * c, 3 + 2 * c), 16);
  const mixed = [0, 1, 2].map((c) =>
    Math.round(channel(stops[i], c) + (place - i) * (channel(stops[i + 1], c) - channel(stops[i], c))),
  );
  return `rgb(${mixed.join(',')})`;
}

// Ticks 1, 2, 5 times powers of ten within [low, high], thinned to powers of ten or to every n-th of them.
function logTicks(low, high, most = 7) {
  const ticks = (factors) => {
    const found = [];
    for (let k = Math.floor(Math.log10(low)) - 1; k <= Math.ceil(Math.log10(high)); k++) {
      for (const factor of factors) {
        const tick = Number(`${factor}e${k}`);
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) found.push(tick);
      }
    }
    return found;
  };
  for (const factors of [
    [1, 1.2, 1.5, 2, 3, 4, 5, 6, 8],
    [1, 2, 5],
    [1, 3],
  ]) {
    const found = ticks(factors);
    if (found.length <= most && found.length >= 2) return found;
  }
  const decades = ticks([1]);
  const step = Math.ceil(decades.length / most);
  return decades.filter((_, i) => i % step === 0);
}

// A logarithmic scale over the positive values, `sources` being arrays of them: { low, high }. The lowest two percent
// share one colour: a few nodes that fit almost exactly would otherwise take most of the scale.
function errorScale(sources) {
  const positive = sources
    .flat()
    .filter((value) => isNumber(value) && value > 0)
    .sort((a, b) => a - b);
  if (positive.length === 0) return { low: 1e-3, high: 1 };
  const high = positive[positive.length - 1];
  const low = positive[Math.floor(0.02 * positive.length)];
  return low < 0.9 * high ? { low, high } : { low: 0.5 * high, high };
}

// Of ratios: symmetric around 1, so that neutral means equal.
function ratioScale(values) {
  const sizes = values
    .filter((value) => isNumber(value) && value > 0)
    .map((value) => Math.abs(Math.log10(value)))
    .sort((a, b) => a - b);
  const size = sizes.length > 0 ? sizes[Math.floor(0.98 * (sizes.length - 1))] : 1;
  const half = 10 ** Math.min(3, Math.max(0.05, size));
  return { low: 1 / half, high: half };
}

// A legend: the stops as a bar with ticks below. ticks: [[position 0..1, text]].
function colorBar(title, stops, ticks) {
  const bar = element('div', { class: 'bar' });
  bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
  return element(
    'div',
    {
      class: 'colorbar',
      role: 'img',
      'aria-label': `Colour scale: ${title}, from ${ticks[0][1]} to ${ticks[ticks.length - 1][1]}`,
    },
    element('div', { class: 'title' }, title),
    bar,
    element(
      'div',
      { class: 'ticks' },
      ticks.map(([at, text]) => {
        const tick = element('span', {}, text);
        tick.style.left = `${100 * at}%`;
        // the texts at the ends stay within the bar's width
        tick.style.transform = `translateX(-${Math.round(100 * at)}%)`;
        return tick;
      }),
    ),
  );
}

function logColorBar(title, stops, { low, high }, format) {
  const span = Math.log10(high / low);
  const at = (value) => Math.log10(value / low) / span;
  // room for the texts at both ends, on a phone too
  const inner = logTicks(low, high, 6).filter((tick) => at(tick) > 0.24 && at(tick) < 0.84);
  return colorBar(title, stops, [
    [0, `\u2264 ${format(low, 2)}`],
    ...inner.map((tick) => [at(tick), format(tick)]),
    [1, format(high, 2)],
  ]);
}
