// Engines draw a scene in headless Chromium, with the table they come with and with ltcfit's in its place.
//   node clients.mjs TABLES BUILD_WEB CHROMIUM PICTURES
// TABLES: ours/three.js, ours/areaLightsLTC.bin and ours/area-light-luts.bin; theirs.bin, as the last of them.
import { mkdir, readFile } from 'node:fs/promises';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { load } from './packages.mjs';
import { measure, problems } from './picture.mjs';
import { serve } from './server.mjs';
import { damages, formats, fromHalf, lanes, spacingOfHalves, toHalf } from './tables.mjs';

const [tables, buildWeb, chromiumPath, pictures] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));

// Each client with the options of its page, and whether all damaged tables are tried on it or the NaN alone.
const clients = [
  { name: 'three', format: 'three', options: {}, all: true },
  { name: 'three-half', format: 'three', options: { half: true } },
  { name: 'babylon', format: 'babylon', options: {}, all: true },
  { name: 'playcanvas', format: 'playcanvas', options: {}, all: true },
  { name: 'playcanvas-disk', format: 'playcanvas', options: { disk: true } },
];
const exposure = 0.8;   // of the pictures for people
const patience = 90;    // seconds for a picture, which takes two on two free cores

let failures = 0;
function fail(text) {
  console.log(`FAILED: ${text}`);
  failures++;
}

// A browser that reaches this server only; every request to another is counted.
async function openBrowser(url) {
  const { chromium } = (await load(buildWeb, 'playwright-core')).default;
  const browser = await chromium.launch({
    executablePath: chromiumPath,
    // WebGL2 on the processor; no name resolves; none of Chromium's own background traffic
    args: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
      '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
      '--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1'],
  });
  const context = await browser.newContext({ viewport: { width: 976, height: 600 } });
  const elsewhere = [];
  await context.route((to) => to.origin !== url && to.protocol.startsWith('http'), (route) => {
    elsewhere.push(route.request().url());
    return route.abort();
  });
  return { browser, context, elsewhere };
}

async function openPage(context, url) {
  const page = await context.newPage();
  page.on('pageerror', (error) => fail(`${url}: ${error.message}`));
  page.on('console', (message) => { if (message.type() === 'error') fail(`${url}: ${message.text()}`); });
  await page.goto(url);
  await page.waitForFunction('window.ready');
  return page;
}

// An engine that misses a file waits for it for ever.
async function withinTime(promise, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what}: no picture after ${patience} s`)), 1000 * patience);
  });
  await Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

async function drawClient(client, server, context) {
  const { name, format, options } = client;
  const page = await openPage(context, `${server.url}/pages/index.html`);
  const ourFile = join(tables, 'ours', basename(formats[format].path));
  const picture = async (label, bytes, more = {}) => {
    // every table under an address of its own: a browser keeps modules
    const unique = `${name}-${label.replace(/[^a-z0-9]+/gi, '-')}`;
    const tablePath = `/tables/${unique}/${formats[format].path}`;
    if (bytes) server.memory.set(tablePath, bytes);
    const path = `/pictures/${unique}`;
    const tableUrl = bytes && server.url + tablePath;
    const drawn = page.evaluate((a) => window.draw(...a),
      [name.split('-')[0], tableUrl, { ...options, ...more }, server.url + path]);
    await withinTime(drawn, `${name}, ${label}`);
    const { buffer, byteOffset, length } = server.memory.get(path);
    return new Float32Array(buffer.slice(byteOffset, byteOffset + length));
  };

  // three brings its table along; the others' comes from three's, in the file that they load, as the nearest numbers
  const theirFloats = await formats.playcanvas.read(join(tables, 'theirs.bin'));
  const theirTable = format === 'three' ? null : formats[format].write(theirFloats);
  const ours = await readFile(ourFile);
  const dark = await picture('off', theirTable, { off: true });
  const theirs = await picture('theirs', theirTable);
  const figures = measure(await picture('ours', ours), theirs, dark);
  const percent = (100 * figures.meanDifference).toFixed(2);
  console.log(`${name}: mean difference ${percent} %, largest ${(100 * figures.maxDifference).toFixed(0)} % ` +
              `of the mean reflected light; lit ${(100 * figures.lit).toFixed(1)} %, ` +
              `${(100 * figures.strange).toFixed(3)} % strange, ${figures.notFinite} pixels not finite`);
  for (const problem of problems(figures)) fail(`${name}: ${problem}`);

  const decoded = await formats[format].read(ourFile);
  const controls = Object.entries(damages).filter(([damage]) => client.all || damage === 'one NaN texel')
    .map(([damage, apply]) => [damage, formats[format].write(apply(decoded))]);
  if (format === 'three') controls.push(['its own table, by way of ltcfit', formats.three.write(theirFloats)]);
  for (const [damage, bytes] of controls) {
    const found = problems(measure(await picture(damage, bytes), theirs, dark));
    if (found.length === 0) fail(`${name}: nobody notices: ${damage}`);
    else console.log(`  caught: ${damage}: ${found.join('; ')}`);
  }
  await page.close();
}

async function showPictures(name, server, context) {
  const page = await openPage(context, `${server.url}/pages/sheet.html`);
  const at = (label) => `${server.url}/pictures/${name}-${label}`;
  await page.evaluate((a) => window.sheet(...a), [name, at('theirs'), at('ours'), exposure]);
  await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });
  await page.close();
}

// The three files say the same: floats equal to the bit; t2 as the nearest halves; t1 as halves that keep the matrix
// good, so next to the nearest but for few texels (12 of the 16,384 numbers in data/ltc_iso.json are farther).
async function compareFiles() {
  const [three, babylon, playcanvas] = await Promise.all(['three', 'babylon', 'playcanvas']
    .map((format) => formats[format].read(join(tables, 'ours', basename(formats[format].path)))));
  const count = (isWrong) => babylon.reduce((sum, value, i) => sum + (isWrong(value, i) ? 1 : 0), 0);
  const others = count((_, i) => Math.fround(three[i]) !== playcanvas[i]);
  if (others > 0) fail(`three.js and PlayCanvas: ${others} other floats`);
  const amplitudes = count((value, i) => i % lanes >= 4 && value !== fromHalf(toHalf(playcanvas[i])));
  if (amplitudes > 0) fail(`Babylon: ${amplitudes} halves of t2 are not the nearest to the floats`);
  const far = count((value, i) => i % lanes < 4 && Math.abs(value - playcanvas[i]) > spacingOfHalves(playcanvas[i]));
  if (far > 32) fail(`Babylon: ${far} halves of t1 are far from the floats`);
}

await mkdir(pictures, { recursive: true });
await compareFiles();
const server = await serve({ '/pages/': join(here, 'pages'), '/node_modules/': join(buildWeb, 'node_modules') });
const { browser, context, elsewhere } = await openBrowser(server.url);
try {
  const probe = await context.newPage();
  await probe.goto(`${server.url}/pages/sheet.html`);
  const reached = await probe.evaluate(
    () => fetch('https://example.org/', { mode: 'no-cors' }).then(() => true, () => false));
  if (reached || elsewhere.splice(0).length !== 1) fail('a request elsewhere was not stopped');
  await probe.close();
  for (const client of clients) {
    try {
      await drawClient(client, server, context);
      await showPictures(client.name, server, context);
    } catch (error) {
      fail(`${client.name}: ${error.message}`);
    }
  }
  for (const url of elsewhere) fail(`a request to ${url}`);
  for (const path of server.missing) fail(`nothing at ${path}`);
} finally {
  await browser.close();
  await server.close();
}
console.log(`pictures in ${pictures}`);
if (failures > 0) console.log(`${failures} failed`);
process.exitCode = failures > 0 ? 1 : 0;
