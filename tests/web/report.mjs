// The page of `ltcfit report` in headless Chromium, from disk: a real one and made-up ones, or broken ones.
//   node report.mjs glance|pages|broken REPORT_HTML SOURCE_DIR BUILD_WEB CHARTS CHROMIUM PICTURES
import { mkdir, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { load } from './packages.mjs';
import { captions } from './report_captions.mjs';
import {
  keyboard,
  layout,
  print,
  rows,
  schemes,
  selectors,
  settled,
  sliders,
  standing,
  tooltips,
} from './report_checks.mjs';
import { fillPage } from './report_fill.mjs';
import { samples } from './report_sample.mjs';
import { shading } from './report_shading_checks.mjs';

const [part, reportPath, sourceDir, buildWeb, chartsPath, chromiumPath, pictures] = process.argv.slice(2);

let failures = 0;
function fail(text) {
  console.log(`FAILED: ${text}`);
  failures++;
}

// A page with all that it complains about or asks for besides its own file.
async function open(browser, path, width) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, reducedMotion: 'reduce' });
  const page = await context.newPage();
  const noises = [];
  const url = pathToFileURL(path).href;
  page.on('console', (message) => {
    if (['error', 'warning', 'assert'].includes(message.type())) noises.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => noises.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (request.url() !== url && !request.url().startsWith('data:')) noises.push(`a request to ${request.url()}`);
  });
  await page.goto(url);
  await page
    .waitForFunction(() => document.documentElement.dataset.ready === 'yes', null, { timeout: 20000 })
    .catch(() => noises.push('the page does not get ready'));
  return { page, noises };
}

// Runs the checks on the page, at a width.
async function inspect(browser, path, width, checks) {
  const { page, noises } = await open(browser, path, width);
  const found = [];
  if (!noises.includes('the page does not get ready')) {
    for (const check of checks) found.push(...(await check(page)));
  }
  await page.context().close();
  return [...noises, ...found].map((text) => `${width} px: ${text}`);
}

async function photograph(browser, path, name) {
  for (const width of [1280, 390]) {
    for (const colorScheme of ['light', 'dark']) {
      const { page } = await open(browser, path, width);
      await page.emulateMedia({ colorScheme });
      await settled(page);
      await page.screenshot({ path: join(pictures, `${name}-${width}-${colorScheme}.png`), fullPage: true });
      if (width === 1280 && colorScheme === 'light') {
        await page.pdf({ path: join(pictures, `${name}.pdf`), preferCSSPageSize: true, printBackground: true });
      }
      await page.context().close();
    }
  }
}

// What is broken, the text that is replaced in a good page (its first occurrence), and the check that must notice.
const damages = [
  ['a figure that is not a number', "if (value === 0) return '0';", "if (value > 0.5) return 'NaN';", standing],
  ['a section left out', 'stabilitySection(report.stability),', '', standing],
  ['an empty map', 'if (!isNumber(value)) return null;', 'return null;', standing],
  ['a chart that is not drawn', 'instance.setOption(', 'void (', standing],
  ['pictures left out', "const images = readJson('images')", 'const images = {}', standing],
  ['a failed check that looks passed', 'if (!verdict.pass) made', 'if (false) made', standing],
  [
    'labels over one another',
    'axisLabel: { ...style.axisLabel, interval }',
    'axisLabel: { ...style.axisLabel, hideOverlap: false, interval: () => true }',
    standing,
  ],
  ['a wide element', '<footer', '<div style="width: 2000px">wide</div><footer', layout],
  ['a table that does not scroll', '.scroll { overflow: auto;', '.scroll {', layout],
  ['a picture from elsewhere', '<footer', '<img alt="" src="https://example.org/picture.png"><footer', () => []],
  [
    'a picture from elsewhere, policy removed',
    /<meta http-equiv="Content-Security-Policy"[^>]*>([^]*)<footer/,
    '$1<img alt="" src="https://example.org/picture.png"><footer',
    () => [],
  ],
  ['an error', '\nbuild();', "\nbuild();\nthrow new Error('late');", () => []],
  ['a warning', '\nbuild();', "\nbuild();\nconsole.warn('late');", () => []],
  ['no tooltips', 'tooltipOf(...describe(cells[item.dataIndex]))', "''", tooltips],
  ['a slider without effect', 'changed(Number(input.value));', '', sliders],
  ['a slider without text', 'show();\n    changed(Number', 'changed(Number', sliders],
  [
    'a selector without effect',
    "addEventListener('change', () => changed(select.value))",
    "addEventListener('change', () => 0)",
    selectors,
  ],
  [
    'a selector that names another metric than the chart',
    'metricSelect.select.value = metric;\n  show();',
    'show();',
    captions,
  ],
  [
    'a selector that names another map',
    'viewSelect.select.value = kept.key;',
    'viewSelect.select.selectedIndex = 1;',
    captions,
  ],
  ['a metric to choose that shows nothing new', "!(same && name === 'SW1rel')", 'true', captions],
  [
    'the name of a default over a point',
    'taken.push(best);',
    'best = { ...best, x: x - width / 2, y: y - height / 2 };',
    standing,
  ],
  [
    'rows of odd heights',
    'if (row.default && !row.pass) body',
    "body.rows[1].style.height = '60px';\n      if (row.default && !row.pass) body",
    rows,
  ],
  ['rows not by their nearness to a limit', 'const all = worstFirst(stability);', 'const all = stability.rows;', rows],
  ['columns that do not sort', 'const sign = descending ? -1 : 1;', 'const sign = 0;', rows],
  ['a filter without effect', 'row.fitter === state.fitter)', 'true)', rows],
  ['rendered scenes left out', 'shadingSection(report.shading),', '', standing],
  ['pictures of the reference only', 'base64,${scene.pictures[key]}', 'base64,${scene.pictures.reference}', shading],
  ['a title that is markup', "element('h5', {}, title)", "Object.assign(element('h5'), { innerHTML: title })", shading],
  ['a failed scene that looks passed', 'if (!scene.passed) made', 'if (false) made', shading],
  ['a ratio the wrong way round', 'ratioCell(error.rmse, against?.rmse)', 'ratioCell(against?.rmse, error.rmse)', shading],
  ['a scene not resolved, unmarked', "reference.resolved ? '' : ' *'", "''", shading],
  ['scenes left out where the other table is closer', 'const lost = scenes.filter(isCloser)', 'const lost = []', shading],
  ['points drawn alike', 'holds: (scene) => isCloser(scene) === lost &&', 'holds: (scene) => lost &&', shading],
  ['points that do not say why', '...(isCloser(scene) ? [', '...(false ? [', shading],
  ['axes of different range', 'narrow ? 46 : 52, low, high', 'narrow ? 46 : 52, 0.9 * low, high', shading],
  ['a picture that does not get larger', "button.addEventListener('click', () => open(0));", '', shading],
  ['arrow keys that change no picture', 'show(current + step)', 'void step', shading],
  ['arrow keys without effect', 'readout.textContent = describe', 'void describe', keyboard],
  ['no dark colours', '@media screen and (prefers-color-scheme: dark) {', '@media (width: 1px) {', schemes],
  ['charts that keep their colours', "darkness.addEventListener('change', redrawSoon);", '', schemes],
  ['controls in print', '.slider input, details', 'details', print],
];

async function glance(browser) {
  for (const width of [1280, 390]) {
    for (const text of await inspect(browser, reportPath, width, [captions, standing, layout])) fail(text);
  }
}

async function goodPages(browser, work) {
  const pages = { report: reportPath };
  for (const [name, make] of Object.entries(samples)) {
    pages[name] = join(work, `${name}.html`);
    await writeFile(pages[name], await fillPage(sourceDir, chartsPath, make()));
  }
  const all = [captions, standing, layout, keyboard, tooltips, selectors, captions, sliders, rows, shading, schemes, print, standing, layout];
  for (const [name, path] of Object.entries(pages)) {
    const found = [
      ...(await inspect(browser, path, 1280, all)),
      ...(await inspect(browser, path, 390, [captions, standing, layout, tooltips, sliders, shading, layout])),
    ];
    for (const text of found) fail(`${name}: ${text}`);
    console.log(`${name}: ${found.length === 0 ? 'good' : `${found.length} problems`}`);
    if (pictures && name !== 'bare') await photograph(browser, path, `report-${name}`);
  }
}

// The made-up report has all that is broken here, whatever a real one holds.
async function brokenPages(browser, work) {
  const good = await fillPage(sourceDir, chartsPath, samples.full());
  for (const [what, text, other, check] of damages) {
    const broken = typeof text === 'string' ? good.replace(text, () => other) : good.replace(text, other);
    if (broken === good) {
      fail(`nothing to replace for: ${what}`);
      continue;
    }
    const path = join(work, 'broken.html');
    await writeFile(path, broken);
    const found = await inspect(browser, path, 1280, [check]);
    if (found.length === 0) fail(`nobody notices: ${what}`);
    else console.log(`  caught: ${what}: ${found[0]}${found.length > 1 ? ` and ${found.length - 1} more` : ''}`);
  }
}

if (pictures) await mkdir(pictures, { recursive: true });
const work = await mkdtemp(join(tmpdir(), 'ltcfit-report-'));
const { chromium } = (await load(buildWeb, 'playwright-core')).default;
const browser = await chromium.launch({
  executablePath: chromiumPath,
  args: [
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    '--host-resolver-rules=MAP * ~NOTFOUND',
  ],
});
try {
  if (part === 'glance') await glance(browser);
  else if (part === 'pages') await goodPages(browser, work);
  else await brokenPages(browser, work);
} finally {
  await browser.close();
  await rm(work, { recursive: true });
}
if (failures > 0) console.log(`${failures} failed`);
process.exitCode = failures > 0 ? 1 : 0;
