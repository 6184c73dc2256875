// Made-up reports with the shape of `ltcfit report`'s JSON, for what real tables do not show: null values, strange
// names, missing parts. No figure in them is measured.
import { generator, picture } from './report_sample_pieces.mjs';
import { plainShading, sampleShading } from './report_shading_sample.mjs';

const metricUnits = {
  SW1: '',
  SW1rel: '',
  form: '',
  light_s: '',
  light_m: '',
  light_l: '',
  TV: '',
  L3: 'sr^-2/3',
  below: '',
  albedo_error: '',
};
const metrics = Object.entries(metricUnits).map(([name, unit]) => ({
  name,
  unit,
  meaning: `What ${name} measures, in a sentence.`,
}));

function summary(values) {
  const sorted = values.filter((value) => value !== null).sort((a, b) => a - b);
  const at = (q) => sorted[Math.floor(q * (sorted.length - 1))] ?? null;
  return {
    mean: sorted.length > 0 ? sorted.reduce((a, b) => a + b, 0) / sorted.length : null,
    p50: at(0.5),
    p90: at(0.9),
    p99: at(0.99),
    max: at(1),
    count: sorted.length,
    non_finite: values.length - sorted.length,
  };
}

function axesOf(kind) {
  const even = (n, high) => Array.from({ length: n }, (_, i) => (high * i) / (n - 1));
  const alphas = (values) => values.map((value) => Math.max(1e-4, value));
  if (kind === 'isotropic') {
    return [
      { name: 'theta', unit: 'degrees', values: even(64, 1).map((x) => (180 / Math.PI) * Math.acos(1 - x * x)) },
      { name: 'alpha', unit: '', values: alphas(even(64, 1).map((x) => x * x)) },
    ];
  }
  return [
    { name: 'alpha', unit: '', values: alphas(even(8, 1)) },
    { name: 'lambda', unit: '', values: even(8, 1) },
    { name: 'theta', unit: 'degrees', values: even(8, 90) },
    { name: 'phi', unit: 'degrees', values: even(8, 90) },
  ];
}

function nodeValues(axes, level, random, holes) {
  const count = axes.reduce((product, axis) => product * axis.values.length, 1);
  return Array.from({ length: count }, (_, node) => {
    let rest = node;
    let wave = 0;
    for (const axis of [...axes].reverse()) {
      const n = axis.values.length;
      const x = (rest % n) / (n - 1);
      rest = Math.floor(rest / n);
      wave += 1.7 * x * x - 0.6 * Math.cos(5 * x);
    }
    if (holes && node % 197 === 0) return null;
    return node === 5 ? 0 : level * Math.exp(wave + 0.2 * (random() - 0.5));
  });
}

function histogram(points, metric, tables, random) {
  const bins = 40;
  const edges = Array.from({ length: bins + 1 }, (_, i) => 10 ** (-5 + (4 * i) / bins));
  const series = tables.map((table, t) => ({
    table,
    zero: 3 * t,
    non_finite: t,
    counts: Array.from({ length: bins }, (_, i) =>
      Math.round(300 * Math.exp(-(((i - 18 - 7 * t) / (5 + 2 * t)) ** 2)) * (0.8 + 0.4 * random())),
    ),
  }));
  return { points, metric, edges, log: true, series };
}

function lobe(t, index, tables, images) {
  const id = (k) => `lobe-${t}-${index}-${k}`;
  const theta = [20, 60, 80, 87][index % 4];
  const list = [{ id: id(0), table: null, what: 'GGX', alt: 'the GGX lobe' }];
  tables.forEach((table, k) =>
    list.push(
      { id: id(2 * k + 1), table, what: 'LTC', alt: `the LTC of ${table}` },
      { id: id(2 * k + 2), table, what: 'difference', alt: `LTC minus GGX of ${table}` },
    ),
  );
  list.forEach((image, k) => {
    images[image.id] = `data:image/png;base64,${picture(k, index)}`;
  });
  const round = index % 2 === 0;
  return {
    title: `alpha 0.1, theta ${theta}\u00b0`,
    half_width_degrees: 20,
    peak: 12.3,
    difference: 0.050123,
    parameters: { alpha_x: 0.1, alpha_y: round ? 0.1 : 0.02, theta_degrees: theta, phi_degrees: round ? 0 : 30 },
    images: list,
    figures: tables.map((table, k) => ({
      table,
      metrics: {
        SW1rel: 0.00255 * (k + 1),
        TV: 0.00617,
        form: 0.00279,
        light_s: 2.88e-7,
        light_l: 8.42e-6,
        light_m: 2.2e-4,
        below: k > 0 ? null : 1e-6,
      },
    })),
  };
}

// options: name, against, holes, lobes
export function sampleTable(kind, index, images, { name, against, holes = false, lobes = 4 }) {
  const random = generator(index + 1);
  const axes = axesOf(kind);
  const tables = [name, ...against];
  const values = (level) => nodeValues(axes, level, random, holes);
  const level = (t) => 1e-3 * (1 + 1.3 * t);
  const scores = (points) => ({
    points,
    count: 512,
    results: tables.map((table, t) => ({
      table,
      singular: t,
      singular_float32: 0,
      metrics: Object.fromEntries(
        metrics.map((metric, m) => [
          metric.name,
          summary(Array.from({ length: 64 }, () => level(t) * (m + 1) * Math.exp(3 * random()))),
        ]),
      ),
    })),
  });
  return {
    name,
    kind,
    nodes: axes.reduce((product, axis) => product * axis.values.length, 1),
    axes,
    stores: 'M',
    normalization: 'third-column-unit',
    channels: ['m00', 'm02', 'm11', 'm20', 'm22', 'norm', 'fresnel'],
    alpha_floor: 1e-4,
    provenance: {
      tool: 'ltcfit',
      tool_version: '0.1.0',
      command: `ltcfit fit ${kind} --fitter light`,
      seed: 1,
      options: { fitter: 'light', leak_weight: 0.02 },
    },
    against,
    verdicts: [
      {
        what: 'Entries are finite and invertible in float32',
        value: 0,
        limit: 0,
        relation: '<=',
        pass: true,
        detail: '',
      },
      {
        what: 'Mean light_m off-grid',
        value: 3.1e-3,
        limit: 2e-3,
        relation: '<=',
        pass: index === 0,
        detail: 'The mean over 512 points, fetched as a shader does.',
      },
    ],
    scores: ['nodes', 'off-grid', 'extreme'].map(scores),
    maps: metrics.flatMap((metric, m) =>
      tables.map((table, t) => ({ metric: metric.name, table, values: values(level(t) * (m + 1)) })),
    ),
    histograms: ['off-grid', 'extreme'].flatMap((points) =>
      ['SW1rel', 'light_m', 'TV'].map((metric) => histogram(points, metric, tables, random)),
    ),
    smoothness: {
      meaning: 'How far the lobe moves from a node to the next.',
      unit: 'rad',
      axes: axes.map((axis) => ({
        axis: axis.name,
        results: tables.map((table, t) => ({ table, summary: summary(values(0.01 * (t + 1))) })),
      })),
      maps: axes.flatMap((axis) =>
        tables.map((table, t) => ({ axis: axis.name, table, values: values(0.01 * (t + 1)) })),
      ),
    },
    lobes: Array.from({ length: lobes }, (_, i) => lobe(index, i, tables, images)),
  };
}

export function samplePareto(table) {
  const random = generator(table === 'iso' ? 11 : 12);
  const names = ['SW1', 'SW1rel', 'light_m', 'light', 'L3'];
  const fitters = {
    light: ['lights', 0.004],
    sw: ['samples', 0.05],
    'sw-sgd': ['steps', 0.4],
    l3: ['samples', 0.02],
    moments: ['none', 2e-5],
  };
  const settings = Object.entries(fitters).flatMap(([fitter, [what, start]], f) =>
    Array.from({ length: fitter === 'moments' ? 1 : 6 }, (_, i) => {
      const seconds = start * 2.6 ** i;
      const errors = Object.fromEntries(
        names.map((name, n) => {
          const ratio = 1 + (fitter === 'moments' ? 3 : 0.9 / 2 ** i) * (1 + ((n + f) % 3)) * (0.7 + 0.6 * random());
          return [name, { ratio, low: 0.97 * ratio, high: 1.04 * ratio, value: 0.012 * ratio, front: false }];
        }),
      );
      return {
        fitter,
        name: `${256 * 2 ** i} ${what}`,
        effort: { [what]: 256 * 2 ** i },
        preset: i === 2 ? 'standard' : '',
        default_of:
          fitter === 'light' && i === 2
            ? [`fit ${table}`]
            : fitter === 'sw' && i === 2
              ? [`fit ${table} --fitter sw`]
              : [],
        entries: i < 4 ? 12 : 4,
        runs: i < 4 ? 36 : 12,
        cpu_seconds: { median: seconds, low: 0.9 * seconds, high: 1.2 * seconds },
        errors,
        not_converged: fitter === 'l3' ? 2 : 0,
        non_finite: 0,
      };
    }),
  );
  // as for lobes: the width cancels in ratios to the best; but not in the second file, made so to be told apart
  if (table === 'iso') for (const { errors } of settings) errors.SW1rel = { ...errors.SW1, value: 2 * errors.SW1.value };
  for (const name of names) {
    for (const setting of settings) {
      setting.errors[name].front = !settings.some(
        (other) =>
          other !== setting &&
          other.cpu_seconds.median <= setting.cpu_seconds.median &&
          other.errors[name].ratio <= setting.errors[name].ratio,
      );
    }
  }
  return {
    format: 'ltcfit-pareto',
    version: 1,
    table,
    command: `ltcfit pareto ${table}`,
    tool_version: '0.1.0',
    options: { entries: 12, repeats: 3, seed: 1, samples: 4096, directions: 32, quads: 64, lights: 64 },
    entries: Array.from({ length: 12 }, (_, i) => ({
      alpha_x: 0.05 * (i + 1),
      alpha_y: 0.05 * (i + 1),
      theta_degrees: 7 * i,
      phi_degrees: 0,
    })),
    metrics: names.map(
      (name) => metrics.find((metric) => metric.name === name) ?? { name, unit: '', meaning: `What ${name} measures.` },
    ),
    settings,
    defaults: settings.flatMap((setting, i) =>
      setting.default_of.map((command) => ({
        command,
        setting: i,
        why: `${setting.name} reach ${setting.errors.SW1.ratio.toFixed(2)} of the best error; twice as many cost 2.6 times the time.`,
      })),
    ),
  };
}

export function sampleStability(perFitter = 144) {
  const random = generator(21);
  const fitters = ['light', 'sw', 'sw-sgd', 'l3', 'moments'];
  const limits = [
    { id: 'spread_starts', text: 'Results from different starts differ by less than this.', limit: 0.01 },
    { id: 'sw1_over_best', text: 'No run is farther above the best.', limit: 2 },
    { id: 'half_shift', text: 'Where alpha_y is large enough.', limit: 5e-4 },
  ];
  const rows = fitters.flatMap((fitter, f) =>
    Array.from({ length: perFitter }, (_, i) => {
      const spread = 1e-4 * Math.exp(6 * random() * (fitter === 'l3' ? 1 : 0.7));
      const pass = spread <= 0.01;
      return {
        alpha_x: [1e-3, 0.01, 0.1, 0.5, 0.9, 1][i % 6],
        alpha_y: [1e-3, 0.01, 0.1][i % 3],
        theta_degrees: 5 * (i % 19),
        phi_degrees: 30 * (i % 4),
        fitter,
        default: f === 0,
        runs: 12,
        outcomes: pass ? { converged: 12 } : { converged: 9, 'no-overlap': 3 },
        restarted: i % 7,
        handed_over: i % 3,
        start_kept: i % 2,
        non_finite: 0,
        det_negative: 0,
        sw1: 0.01 * random(),
        sw1_over_best: 1 + random(),
        tv: 0.1 * random(),
        spread_starts: spread,
        spread_seeds: spread / 3,
        condition_m: 10 ** (5 * random()),
        condition_raw: 10 ** (8 * random()),
        condition_scaled: 10 ** (3 * random()),
        gradient_error: fitter === 'l3' ? null : 1e-7 * random(),
        float32_shift: 1e-6 * random(),
        half_shift: 1e-3 * random(),
        interpolation: i % 5 === 0 ? null : 1 + random(),
        pass: f === 0 ? pass : null,
        broken: pass || f > 0 ? [] : ['spread_starts'],
      };
    }),
  );
  return {
    format: 'ltcfit-stability',
    version: 1,
    command: 'ltcfit stability',
    tool_version: '0.1.0',
    set: 'corners',
    limits,
    starts: ['moments', 'identity', 'neighbour', 'no-overlap'],
    seeds: [1, 2, 3],
    summary:
      perFitter === 0
        ? []
        : fitters.map((fitter, f) => {
            const own = rows.filter((row) => row.fitter === fitter);
            const failed = own.filter((row) => row.outcomes['no-overlap']).length;
            return {
              fitter,
              default: f === 0,
              rows: own.length,
              failed: f === 0 ? failed : null,
              non_finite: 0,
              runs: 12 * own.length,
              outcomes: { converged: 12 * own.length - 3 * failed, 'no-overlap': 3 * failed },
            };
          }),
    rows,
    findings: [
      {
        title: 'Nelder-Mead on L3 from a start that does not overlap',
        text: 'The cost is flat there.',
        seen: true,
        rows: 120,
        of: 144,
      },
    ],
  };
}

const strangeName = `${'very_long_name_of_a_table_'.repeat(4)}.json`;
const markupName = '</script><script>window.hurt = 1</script> & "a" <b>.npy';

function report(tables, more = {}) {
  return {
    format: 'ltcfit-report',
    version: 1,
    command: 'ltcfit report ...',
    tool_version: '0.1.0',
    options: { seed: 1, samples: 4096, directions: 32, quads: 64, lights: 64, points: 512 },
    metrics,
    tables,
    shading: [],
    pareto: [],
    stability: null,
    ...more,
  };
}

// name -> () => { report, images }
export const samples = {
  full: () => {
    const images = {};
    const tables = [
      sampleTable('isotropic', 0, images, { name: 'ltc_iso.json', against: ['ltc2017-1.npy'] }),
      sampleTable('anisotropic', 1, images, {
        name: 'ltc_aniso.json',
        against: ['kt2022-alpha-lambda-theta-phi.npy'],
      }),
    ];
    return {
      report: report(tables, {
        shading: [sampleShading('isotropic'), sampleShading('anisotropic')],
        pareto: [samplePareto('iso'), samplePareto('aniso')],
        stability: sampleStability(),
      }),
      images,
    };
  },
  bare: () => {
    const images = {};
    const table = sampleTable('isotropic', 0, images, { name: 'alone.json', against: [], lobes: 1 });
    return { report: report([table]), images };
  },
  strange: () => {
    const images = {};
    const table = sampleTable('anisotropic', 1, images, {
      name: strangeName,
      against: [markupName, 'b.npy'],
      holes: true,
      lobes: 2,
    });
    Object.assign(table, {
      provenance: { tool: '', tool_version: '', command: '', seed: null, options: {} },
      verdicts: [],
    });
    for (const result of table.scores[0].results) result.metrics.SW1 = summary([null, null]);
    table.maps[table.maps.length - 3].values.fill(null);
    return {
      report: report([table], {
        shading: plainShading([strangeName, markupName]),
        pareto: [samplePareto('aniso')],
        stability: sampleStability(0),
      }),
      images,
    };
  },
};
