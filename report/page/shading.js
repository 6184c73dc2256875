// What `ltcfit check-gl` measured: rendered scenes against their twin and the reference, and what shading costs.

const shadingKind = (shading) => (shading.table.isotropic ? 'isotropic' : 'anisotropic');
const decibels = (value) => numberText(value, 4);

// Ways of horizon clipping by their names in the file.
const clippingTitles = {
  exact: 'exact',
  'proxy-sphere': 'proxy sphere, closed form',
  'proxy-sphere-table': 'proxy sphere by table',
};

const partText = (part, all) => `${countText(part)} of ${countText(all)}`;

const agreementText = ({ scenes }) =>
  `GL agrees with its double-precision twin in ${partText(scenes.filter(({ passed }) => passed).length, scenes.length)} scenes`;

function shadingSummary(shading, named, random) {
  const { scenes, table, against, random: means } = shading;
  const failed = scenes.filter((scene) => !scene.passed);
  const lowest = scenes.reduce((low, scene) => (scene.gl.psnr < low.gl.psnr ? scene : low));
  const resolved = (list) => partText(list.filter(({ reference }) => reference.resolved).length, list.length);
  const items = [
    [
      verdictMark(shading.passed),
      ` The shader in ${agreementText(shading)}; the smallest PSNR is ${decibels(lowest.gl.psnr)} dB (${lowest.name}, floor ${decibels(lowest.gl.floor)} dB).`,
      failed.length > 0 ? ` It does not in ${failed.map(({ name }) => name).join(', ')}.` : null,
    ],
    [`Rendered by ${shading.renderer}.`],
  ];
  if (means) {
    items.push([
      `Against the Monte Carlo reference, the mean RMSE of ${table.name} over ${countText(means.scenes)} random scenes is `,
      `${numberText(means.rmse)}`,
      against
        ? `; that of ${against.name} is ${numberText(means.against_rmse)}. The ratio is ${numberText(means.against_rmse > 0 ? means.rmse / means.against_rmse : null)}.`
        : '.',
    ]);
    if (against) {
      const lost = random.filter(isCloser).length;
      const between = means.scenes - means.closer - lost;
      items.push([
        `${table.name} is closer by more than the reference\u2019s own error in ${partText(means.closer, means.scenes)} `,
        `random scenes, ${against.name} is closer in ${countText(lost)}`,
        between > 0 ? `; in the other ${countText(between)} the lead of ${table.name} is within that error.` : '.',
      ]);
    }
  }
  const dull = shading.dielectric;
  if (dull) {
    items.push([
      `With F0 = ${numberText(dull.f0)} in ${countText(dull.scenes)} of these scenes the mean RMSE is ${numberText(dull.rmse)}`,
      against ? `, that of ${against.name} ${numberText(dull.against_rmse)}; closer in ${partText(dull.closer, dull.scenes)}` : '',
      '. There Fresnel tilts the true lobe, which a table of F = 1 does not follow, however well it is fitted.',
    ]);
  }
  items.push([
    'The reference\u2019s own error is at most a tenth of what it judges in ',
    means ? `${resolved(random)} random scenes, in the mean ${numberText(means.reference_rmse)}` : '',
    means && named.length > 0 ? ', and in ' : '',
    named.length > 0 ? `${resolved(named)} named ones` : '',
    '.',
  ]);
  return element(
    'ul',
    { class: 'findings' },
    items.map((item) => element('li', {}, item)),
  );
}

function sceneTable(shading, scenes) {
  const compared = shading.against !== null;
  const columns = [
    { title: 'Scene', head: true },
    { title: 'Alpha', number: true },
    { title: 'GL / twin: PSNR (dB)', number: true },
    { title: 'Floor (dB)', number: true },
    { title: 'Verdict' },
    { title: 'RMSE', number: true },
    { title: 'Relative MSE', number: true },
    { title: 'PSNR (dB)', number: true },
    ...(compared
      ? [
          { title: 'Other: RMSE', number: true },
          { title: 'Other: relative MSE', number: true },
          { title: 'Other: PSNR (dB)', number: true },
          { title: 'RMSE / other', number: true },
        ]
      : []),
    { title: 'Own error of the reference', number: true },
  ];
  const rows = scenes.map(({ name, alpha, gl, passed, error, against, reference }) => [
    name,
    alphaText(alpha),
    decibels(gl.psnr),
    decibels(gl.floor),
    verdictMark(passed),
    numberText(error.rmse),
    numberText(error.relative_mse),
    decibels(error.psnr),
    ...(compared
      ? [
          numberText(against?.rmse),
          numberText(against?.relative_mse),
          decibels(against?.psnr),
          ratioCell(error.rmse, against?.rmse),
        ]
      : []),
    `${numberText(reference.rmse)}${reference.resolved ? '' : ' *'}`,
  ]);
  const made = tableOf(
    `Errors against the reference${compared ? `; the other table is ${shading.against.name}` : ''}` +
      `${scenes.some(({ reference }) => !reference.resolved) ? '; * more than a tenth of what it judges' : ''}`,
    columns,
    rows,
  );
  scenes.forEach((scene, i) => {
    if (!scene.passed) made.tBodies[0].rows[i].classList.add('failed');
  });
  return scrolling(made, 'Named scenes');
}

// Why a scene fails that does.
function failureText({ passed, gl }) {
  if (passed) return null;
  const reasons = [
    gl.psnr < gl.floor ? 'the PSNR is below its floor' : null,
    gl.non_finite > 0 ? `${countText(gl.non_finite)} pixels are not finite` : null,
    gl.kinds_differ > 0 ? `${countText(gl.kinds_differ)} pixels show another kind of thing` : null,
    gl.pixels === 0 ? 'no pixel shows a surface in both' : null,
  ];
  return `GL fails against its twin: ${reasons.filter(Boolean).join(', ') || 'the PSNR is at its floor'}.`;
}

const closerText = (shading, scene) =>
  isCloser(scene) ? `${shading.against.name} is closer: ${scene.explanation || 'no explanation'}.` : null;

function namedScenes(shading, scenes) {
  if (scenes.length === 0) return [];
  return [
    element('h4', {}, 'Named scenes'),
    note(
      'Errors are those of radiance under lights of radiance 1. The PSNR of GL against its twin says that the shader does ' +
        'what it should; the one against the reference says how good the table is.',
    ),
    sceneTable(shading, scenes),
    element(
      'div',
      { class: 'scenes' },
      scenes.map((scene) =>
        sceneCard(
          shading,
          scene,
          `${scene.name}: ${scene.title}`,
          failureText(scene),
          scene.loss ? `GL against its twin: ${decibels(scene.gl.psnr)} dB; ${scene.loss}.` : null,
          closerText(shading, scene),
        ),
      ),
    ),
  ];
}

function randomScenes(shading, scenes, id) {
  if (scenes.length === 0) return [];
  const made = element('div', {}, element('h4', {}, 'Random scenes'));
  if (!shading.against) {
    made.append(note('No other table was rendered, so that there is nothing to hold the errors against.'));
    return [made];
  }
  const { table, against } = shading;
  made.append(
    note(`Each point is a scene: a random light, view and material. Below the diagonal ${table.name} is closer to the reference, above it ${against.name}.`),
  );
  addScatter(made, `${id}-scatter`, shading, scenes);
  const lost = scenes.filter(isCloser).sort((a, b) => b.error.rmse / b.against.rmse - a.error.rmse / a.against.rmse);
  made.append(
    element('h4', {}, `Where ${against.name} is closer: ${partText(lost.length, scenes.length)}`),
    lost.length > 0
      ? element(
          'div',
          { class: 'scenes small', tabindex: 0, role: 'region', 'aria-label': `Random scenes where ${against.name} is closer` },
          lost.map((scene) =>
            sceneCard(
              shading,
              scene,
              scene.name,
              `RMSE ${numberText(scene.error.rmse)}, of the other ${numberText(scene.against.rmse)}: ` +
                `${ratioText(scene.error.rmse / scene.against.rmse)}; alpha ${alphaText(scene.alpha)}.` +
                `${scene.reference.resolved ? '' : ` Own error of the reference ${numberText(scene.reference.rmse)} (${unresolvedText}).`}`,
              closerText(shading, scene),
            ),
          ),
        )
      : note('In none of the random scenes.'),
  );
  return [made];
}

function clippingPart(shading, named) {
  const rows = [
    ...(shading.random?.clipping ? [['mean over random scenes', shading.random.clipping]] : []),
    ...named.filter(({ clipping }) => clipping).map(({ name, clipping }) => [name, clipping]),
  ];
  if (rows.length === 0) return [];
  const ways = Object.keys(rows[0][1]);
  const cell = (clipping, way) => {
    const value = clipping[way];
    if (way === 'exact' || !isNumber(value) || !(clipping.exact > 0)) return numberText(value);
    return `${numberText(value)} (${ratioText(value / clipping.exact)})`;
  };
  return [
    element('h4', {}, 'Horizon clipping'),
    note(
      'RMSE against the reference of the double-precision twin, with lights cut at the horizon exactly or taken for a ' +
        'sphere of the same form factor; in brackets over the exact way.',
    ),
    scrolling(
      tableOf(
        'RMSE by way of horizon clipping',
        [
          { title: 'Scene', head: true },
          ...ways.map((way) => ({ title: clippingTitles[way] ?? way, number: true })),
        ],
        rows.map(([name, clipping]) => [name, ...ways.map((way) => cell(clipping, way))]),
      ),
      'Horizon clipping',
    ),
  ];
}

const specialText = (special) =>
  Object.entries(special)
    .map(([name, count]) => `${name} ${countText(count)}`)
    .join(', ');

function costPart({ cost, frames, renderer }) {
  if (cost.length === 0 && frames.length === 0) return [];
  const parts = [element('h4', {}, 'Cost')];
  const columns = [
    { title: 'Shader', head: true, class: 'name' },
    { title: 'Texture fetches', number: true },
    { title: 'Arithmetic', number: true },
    { title: 'Selects', number: true },
    { title: 'Branches', number: true },
    { title: 'Special functions', class: 'wide' },
    { title: 'Total', number: true },
  ];
  if (cost.length > 0)
    parts.push(
      note('Scalar operations in the compiled and optimised SPIR-V, all sides of branches together.'),
      scrolling(
        tableOf(
          'Operations of one pixel and light',
          columns,
          cost.map((entry) => [
            entry.name,
            countText(entry.fetches),
            countText(entry.arithmetic),
            countText(entry.selects),
            countText(entry.branches),
            specialText(entry.special),
            countText(entry.total),
          ]),
        ),
        'Cost',
      ),
    );
  if (frames.length > 0)
    parts.push(
      note(`Frame times on ${renderer}.`),
      scrolling(
        tableOf(
          'Frame times',
          [
            { title: 'Scene', head: true },
            { title: 'Pixels', number: true },
            { title: 'Time (ms)', number: true },
          ],
          frames.map(({ scene, seconds, width, height }) => [
            scene,
            `${width} \u00d7 ${height}`,
            milliseconds(seconds),
          ]),
        ),
        'Frame times',
      ),
    );
  return parts;
}

function shadingSection(shadings) {
  const made = section('shading', 2, 'Shading');
  if (shadings.length === 0) {
    made.append(absent('Rendered scenes against the reference', '--shading FILE'));
    return made;
  }
  shadings.forEach((shading, i) => {
    const id = `shading-${i}`;
    const named = shading.scenes.filter(({ random }) => !random);
    const random = shading.scenes.filter((scene) => scene.random);
    made.append(
      section(
        id,
        3,
        `${shading.table.name}, ${shadingKind(shading)}`,
        note(
          `${shading.table.source}.`,
          shading.against ? ` Held against ${shading.against.name}: ${shading.against.source}.` : null,
        ),
        shadingSummary(shading, named, random),
        namedScenes(shading, named),
        randomScenes(shading, random, id),
        clippingPart(shading, named),
        costPart(shading),
      ),
    );
  });
  return made;
}
