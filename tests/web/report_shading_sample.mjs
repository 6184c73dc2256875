// Made-up results of `ltcfit check-gl`, as consistent as real ones. No figure in them is measured.
import { generator, picture } from './report_sample_pieces.mjs';

const figure = (value) => Number(value.toPrecision(5));
const errors = (rmse) => ({
  rmse: figure(rmse),
  relative_mse: figure(40 * rmse * rmse),
  psnr: rmse > 0 ? figure(Math.min(150, -20 * Math.log10(figure(rmse)))) : 150,
  largest: figure(9 * rmse),
});
const mean = (values) => figure(values.reduce((a, b) => a + b, 0) / values.length);

function pictures(index, compared) {
  const keys = ['ltc', 'reference', 'difference', ...(compared ? ['against', 'against_difference'] : [])];
  return Object.fromEntries(keys.map((key, k) => [key, picture(k, index)]));
}

function scene(name, title, index, random, { compared, rmse, ratio, resolved = true, passed = true, clipping = true }) {
  const lost = compared && ratio > 1;
  const alpha = figure(0.01 + 0.9 * random());
  const psnr = figure(passed ? 60 + 40 * random() : 31);
  return {
    name,
    title,
    random: name.startsWith('random-'),
    loss: 'float32 look-up and edge sums, some 1e-6 each',
    alpha: [alpha, index % 3 ? alpha : figure(alpha / 4)],
    gl: { psnr, floor: 50, largest: 1e-4, non_finite: 0, kinds_differ: 2, pixels: 12345 },
    passed,
    reference: { rmse: figure(Math.min(rmse, rmse / ratio) * (resolved ? 0.04 : 0.6)), samples: 256.5, resolved },
    error: errors(rmse),
    against: compared ? errors(rmse / ratio) : null,
    clipping: clipping
      ? {
          exact: figure(rmse),
          'proxy-sphere': figure(rmse * (1 + 2 * random())),
          'proxy-sphere-table': figure(rmse * (1.1 + 2 * random())),
        }
      : null,
    explanation: lost ? `${Math.round(20 + 70 * random())} % of the excess is at grazing views, beyond 70 degrees` : '',
    pictures: !name.startsWith('random-') || lost ? pictures(index, compared) : null,
  };
}

function sums(scenes, compared) {
  const own = scenes.filter(({ random }) => random);
  if (own.length === 0) return null;
  const clipped = own.filter(({ clipping }) => clipping);
  return {
    scenes: own.length,
    rmse: mean(own.map(({ error }) => error.rmse)),
    against_rmse: compared ? mean(own.map(({ against }) => against.rmse)) : null,
    closer: compared ? own.filter(({ error, against, reference }) => against.rmse - error.rmse > reference.rmse).length : null,
    resolved: own.filter(({ reference }) => reference.resolved).length,
    reference_rmse: mean(own.map(({ reference }) => reference.rmse)),
    clipping:
      clipped.length > 0
        ? Object.fromEntries(
            Object.keys(clipped[0].clipping).map((way) => [way, mean(clipped.map(({ clipping }) => clipping[way]))]),
          )
        : null,
  };
}

function file(kind, names, scenes, more = {}) {
  const table = (name) => ({
    name,
    source: 'read texel for texel from KTX2, half',
    isotropic: kind === 'isotropic',
    precision: 'half',
  });
  const compared = names.length > 1;
  return {
    format: 'ltcfit-shading',
    version: 1,
    command: 'ltcfit check-gl table.ktx2 -o checked',
    tool_version: '0.1.0',
    table: table(names[0]),
    against: compared ? table(names[1]) : null,
    renderer: 'a renderer of made-up figures, 4.5',
    options: { width: 160, height: 120, random_scenes: 48, random_size: 48, seed: 1, max_samples: 4096 },
    passed: scenes.every(({ passed }) => passed),
    scenes,
    random: sums(scenes, compared),
    cost: [
      { name: 'isotropic, quad', fetches: 2, arithmetic: 321, selects: 12, branches: 8, special: { atan: 4, sqrt: 4 } },
      { name: 'anisotropic, quad', fetches: 16, arithmetic: 1432, selects: 31, branches: 11, special: { division: 9 } },
    ].map((entry) => ({
      ...entry,
      total:
        entry.fetches +
        entry.arithmetic +
        entry.selects +
        entry.branches +
        Object.values(entry.special).reduce((a, b) => a + b, 0),
    })),
    frames: [
      { scene: 'rectangle', seconds: 0.0412, width: 1280, height: 720 },
      { scene: 'several-lights', seconds: 0.123, width: 1280, height: 720 },
    ],
    ...more,
  };
}

export function sampleShading(kind) {
  const isotropic = kind === 'isotropic';
  const random = generator(isotropic ? 31 : 32);
  const named = [
    ['rectangle', 'a plane and a sphere under a rectangular light, alpha 0.25'],
    ['horizon', 'a light through the ground: half of it is below <b>the horizon</b>, alpha 0.3'],
    ['several-lights', 'four coloured lights on three materials'],
    ['brushed-spheres', 'brushed spheres, tangents turned by 0, 30, 60 and 90 degrees; alpha 0.5 x 0.05'],
    ['stained-glass', 'a textured light'],
  ].map(([name, title], i) =>
    scene(name, title, i, random, {
      compared: true,
      rmse: 0.004 * Math.exp(random()),
      ratio: i === 3 ? 1.2 : 0.6,
      resolved: i !== 2,
      passed: isotropic || i !== 1,
      clipping: i !== 4,
    }),
  );
  const others = Array.from({ length: 48 }, (_, i) =>
    scene(`random-${isotropic ? 'iso' : 'aniso'}-${i}`, 'a random light, view and material', i, random, {
      compared: true,
      rmse: 0.001 * Math.exp(2 * random()),
      // 10 of 48, two of them unresolved
      ratio: i % 5 === 2 ? 1.05 + 0.4 * random() : 0.2 + 0.7 * random(),
      resolved: i % 7 !== 2,
    }),
  );
  return file(kind, isotropic ? ['ltc_iso.ktx2', 'ltc2017-1.npy'] : ['ltc_aniso.ktx2', 'kt2022.npy'], [
    ...named,
    ...others,
  ]);
}

// What real ones seldom hold: no other table; errors of 0, and parts without anything in them. Names as given.
export function plainShading(names) {
  const random = generator(33);
  const scenes = (compared, rmse) => [
    { ...scene('custom', names[0], 0, random, { compared, rmse, ratio: 1, clipping: false }), pictures: null },
    scene('touching', names[1] ?? '', 1, random, { compared, rmse, ratio: 1, clipping: false }),
    scene('random-0', '', 2, random, { compared, rmse, ratio: 1, clipping: false }),
  ];
  return [
    file('isotropic', [names[1]], scenes(false, 0.002), { renderer: names[0] }),
    file('anisotropic', names, scenes(true, 0), { cost: [], frames: [] }),
  ];
}
