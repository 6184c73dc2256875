// ktx.mjs, three_module.mjs, the half conversion and the checks of a picture must pass good input and catch bad:
//   node checkers.mjs BUILD_WEB WORK
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { load } from './packages.mjs';
import { measure, problems } from './picture.mjs';
import { formats, fromHalf, toHalf } from './tables.mjs';

const [buildWeb, work] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const ktx = await load(buildWeb, 'ktx-parse');
let failures = 0;
function expect(what, holds) {
  if (holds) return;
  console.log(`FAILED: ${what}`);
  failures++;
}

function passes(script, file, content, expected, ...more) {
  writeFileSync(join(work, file), content);
  writeFileSync(join(work, 'expected.json'), JSON.stringify(expected));
  const run = spawnSync(process.execPath, [join(here, script), join(work, file), join(work, 'expected.json'), ...more]);
  const output = run.stdout.toString();
  const explained = output.includes('FAILED') || run.stderr.toString().includes('Error');
  if (run.status !== 0 && !explained) expect(`${script} says why`, false);
  return run.status === 0;
}

// A zstd frame of one raw block: an inflater has no choice but to give the bytes back.
function zstdFrame(bytes) {
  const header = Buffer.alloc(4 + 1 + 4 + 3);
  header.writeUInt32LE(0xfd2fb528, 0);
  header.writeUInt8(0xa0, 4);            // size of the content in 4 bytes, a single segment
  header.writeUInt32LE(bytes.length, 5);
  header.writeUIntLE(bytes.length << 3 | 1, 9, 3);   // raw, the last block
  return Buffer.concat([header, bytes]);
}

function ktxFile(values, { half = false, zstd = false, transfer = ktx.KHR_DF_TRANSFER_LINEAR } = {}) {
  const raw = Buffer.alloc(values.length * (half ? 2 : 4));
  values.forEach((v, i) => (half ? raw.writeUInt16LE(toHalf(v), 2 * i) : raw.writeFloatLE(v, 4 * i)));
  const bits = half ? 16 : 32;
  const [minusOne, one] = new Int32Array(Float32Array.of(-1, 1).buffer);
  const container = ktx.createDefaultContainer();
  Object.assign(container, { vkFormat: half ? ktx.VK_FORMAT_R16G16_SFLOAT : ktx.VK_FORMAT_R32G32_SFLOAT,
    typeSize: bits / 8, pixelWidth: 3, pixelHeight: 2, levelCount: 1, faceCount: 1, supercompressionScheme: zstd ? 2 : 0,
    keyValue: { 'ltcfit.note': Buffer.from('a test\0') },
    levels: [{ levelData: zstd ? zstdFrame(raw) : raw, uncompressedByteLength: raw.length }] });
  Object.assign(container.dataFormatDescriptor[0], { colorModel: ktx.KHR_DF_MODEL_RGBSDA,
    transferFunction: transfer, flags: 0, texelBlockDimension: [0, 0, 0, 0], bytesPlane: [bits / 4, 0, 0, 0, 0, 0, 0, 0],
    samples: [0, 1].map((id) => ({ bitOffset: id * bits, bitLength: bits - 1, channelType: id | 0xc0,
      samplePosition: [0, 0, 0, 0], sampleLower: minusOne, sampleUpper: one })) });
  return ktx.write(container, { keepWriter: true });
}

function checkKtx() {
  const values = Array.from({ length: 12 }, (_, i) => (i - 5) / 7);
  const keys = { 'ltcfit.note': 'a test' };
  const wanted = { vkFormat: 103, width: 3, height: 2, depth: 0, layers: 0, floats: values, keys };
  const run = (file, changes = {}) => passes('ktx.mjs', 't.ktx2', file, { ...wanted, ...changes }, buildWeb);
  expect('ktx.mjs takes floats', run(ktxFile(values)));
  expect('ktx.mjs takes zstd', run(ktxFile(values, { zstd: true }), { supercompression: 2 }));
  expect('ktx.mjs takes halves', run(ktxFile(values, { half: true }), { vkFormat: 83 }));
  expect('ktx.mjs: wrong value', !run(ktxFile(values.map((v, i) => (i === 7 ? 0.5 : v)))));
  expect('ktx.mjs: -0 for 0', !run(ktxFile(values.map((v) => (v === 0 ? -0 : v)))));
  expect('ktx.mjs: wrong size', !run(ktxFile(values), { width: 2 }));
  expect('ktx.mjs: wrong format', !run(ktxFile(values, { half: true })));
  expect('ktx.mjs: wrong transfer function', !run(ktxFile(values, { transfer: ktx.KHR_DF_TRANSFER_SRGB })));
  expect('ktx.mjs: missing key', !run(ktxFile(values), { keys: { another: 'x' } }));
  expect('ktx.mjs: too few values', !run(ktxFile(values), { floats: values.slice(1) }));
}

function checkModule() {
  const wanted = { LTC_MAT_1: [1, -0.1], LTC_MAT_2: [2] };
  const run = (first, second = '\nexport const LTC_MAT_2 = [2];\n') =>
    passes('three_module.mjs', 't.js', `export const LTC_MAT_1 = ${first};${second}`, wanted);
  expect('three_module.mjs takes a module', run('[1, -0.1]'));
  expect('three_module.mjs takes a float32', run(`[1, ${Math.fround(-0.1)}]`));
  expect('three_module.mjs: wrong number', !run('[1, -0.1000001]'));
  expect('three_module.mjs: array too long', !run('[1, -0.1, 0]'));
  expect('three_module.mjs: array missing', !run('[1, -0.1]', ''));
  expect('three_module.mjs: bad syntax', !run('[1, '));
}

async function checkHalves() {
  let wrong = 0;
  for (let bits = 0; bits < 0x10000; bits++) {
    const value = fromHalf(bits);
    if (!Number.isNaN(value) && toHalf(value) !== bits) wrong++;
  }
  expect(`${wrong} halves do not come back`, wrong === 0);
  expect('ties go to even', toHalf(1 + 2 ** -11) === 0x3c00 && toHalf(1 + 3 * 2 ** -11) === 0x3c02);
  expect('a carry reaches the exponent', toHalf(2 - 2 ** -12) === 0x4000);
  const table = Float64Array.from({ length: 8 * 64 * 64 }, (_, i) => fromHalf(i % 0x7c00));
  for (const name of ['babylon', 'playcanvas', 'three']) {
    const file = join(work, `${name}.mjs`);
    writeFileSync(file, formats[name].write(table));
    const back = await formats[name].read(file);
    expect(`${name}: write, then read`, back.every((v, i) => v === table[i]));
    expect(`${name}: read, then write`, readFileSync(file).equals(formats[name].write(back)));
  }
}

function checkPictures() {
  const dark = new Float32Array(4000);
  const theirs = dark.map((_, i) => 1 + (i % 7) / 10);
  const good = theirs.map((v) => v * 1.02);
  expect('a good picture', problems(measure(good, theirs, dark)).length === 0);
  const caught = (picture, word) => problems(measure(picture, theirs, dark)).some((p) => p.includes(word));
  expect('NaN', caught(good.map((v, i) => (i === 402 ? NaN : v)), 'not finite'));
  expect('Inf', caught(good.map((v, i) => (i === 401 ? Infinity : v)), 'not finite'));
  expect('darkness', caught(dark, 'lit'));
  expect('a black patch', caught(good.map((v, i) => (i < 400 ? 0 : v)), 'black or white'));
  expect('the same picture', caught(theirs, 'no difference'));
  expect('a brighter picture', caught(theirs.map((v) => 1.4 * v), 'mean difference'));
  expect('one white pixel', caught(good.map((v, i) => (i < 4 ? 20 : v)), 'largest difference'));
}

checkKtx();
checkModule();
await checkHalves();
checkPictures();
console.log(failures > 0 ? `${failures} failed` : 'all passed');
process.exitCode = failures > 0 ? 1 : 0;
