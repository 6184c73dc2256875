// A KTX2 file read by ktx-parse and zstddec against the values it should hold, exactly; prints its key-values.
//   node ktx.mjs FILE.ktx2 EXPECTED.json BUILD_WEB
// EXPECTED: { vkFormat, width, height, depth, layers, floats }: sizes as in the header, 0 where the header has 0;
// "supercompression" and "keys" (key-values that must be there) if wanted. floats run as in the file: layer, slice, row,
// column, channel, and with "levels" (their number) from the finest level on; a file of halves must hold the nearest half of each. Exit code 1 and a line for each thing that differs.
import { readFile } from 'node:fs/promises';
import { load } from './packages.mjs';
import { fromHalf, toHalf } from './tables.mjs';

const [file, expectedFile, buildWeb] = process.argv.slice(2);
const { read, ...ktx } = await load(buildWeb, 'ktx-parse');

const formats = {};
for (const [bits, name] of [[16, '16'], [32, '32']]) {
  ['R', 'G', 'B', 'A'].reduce((channels, letter, i) => {
    formats[ktx[`VK_FORMAT_${channels}${letter}${name}_SFLOAT`]] = { bits, channels: i + 1 };
    return `${channels}${letter}${name}`;
  }, '');
}

let failures = 0;
function expect(what, found, wanted) {
  if (JSON.stringify(found) === JSON.stringify(wanted)) return;
  console.log(`FAILED: ${what}: ${JSON.stringify(found)}, not ${JSON.stringify(wanted)}`);
  failures++;
}

function checkDescriptor([block, ...more], { bits, channels }, isPacked) {
  expect('descriptor blocks', 1 + more.length, 1);
  expect('descriptor version', block.versionNumber, ktx.KHR_DF_VERSION);
  expect('colour model', block.colorModel, ktx.KHR_DF_MODEL_RGBSDA);
  expect('transfer function', block.transferFunction, ktx.KHR_DF_TRANSFER_LINEAR);
  expect('descriptor flags', block.flags, ktx.KHR_DF_FLAG_ALPHA_STRAIGHT);
  expect('texel block', block.texelBlockDimension, [0, 0, 0, 0]);
  // earlier revisions of the format want 0 under supercompression
  const plane = isPacked && block.bytesPlane[0] === 0 ? 0 : channels * bits / 8;
  expect('bytes of the planes', block.bytesPlane, [plane, 0, 0, 0, 0, 0, 0, 0]);
  const [minusOne, one] = new Int32Array(Float32Array.of(-1, 1).buffer);
  const ids = [ktx.KHR_DF_CHANNEL_RGBSDA_RED, ktx.KHR_DF_CHANNEL_RGBSDA_GREEN, ktx.KHR_DF_CHANNEL_RGBSDA_BLUE,
    ktx.KHR_DF_CHANNEL_RGBSDA_ALPHA];
  expect('samples', block.samples, ids.slice(0, channels).map((id, i) => ({
    bitOffset: i * bits,
    bitLength: bits - 1,
    channelType: id | ktx.KHR_DF_SAMPLE_DATATYPE_FLOAT | ktx.KHR_DF_SAMPLE_DATATYPE_SIGNED,
    samplePosition: [0, 0, 0, 0],
    sampleLower: minusOne,
    sampleUpper: one,
  })));
}

function text(value) {
  return typeof value === 'string' ? value : Buffer.from(value).toString('utf8').replace(/\0$/, '');
}

function checkKeys(keyValue, wanted) {
  const keys = Object.keys(keyValue);
  for (const key of keys) console.log(`${key}: ${text(keyValue[key])}`);
  expect('order of keys', keys, [...keys].sort());
  for (const [key, value] of Object.entries(wanted)) {
    expect(`key ${key}`, key in keyValue ? text(keyValue[key]) : null, value);
  }
}

async function inflate(level, scheme) {
  if (scheme === ktx.KHR_SUPERCOMPRESSION_NONE) return level.levelData;
  if (scheme !== ktx.KHR_SUPERCOMPRESSION_ZSTD) throw new Error(`supercompression ${scheme}`);
  const { ZSTDDecoder } = await load(buildWeb, 'zstddec');
  const decoder = new ZSTDDecoder();
  await decoder.init();
  return decoder.decode(level.levelData, level.uncompressedByteLength);
}

function checkValues(bytes, { bits }, floats) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  expect('values', bytes.byteLength * 8 / bits, floats.length);
  if (bytes.byteLength * 8 / bits !== floats.length) return;
  const different = floats.findIndex((value, i) => (bits === 32
    ? !Object.is(view.getFloat32(4 * i, true), Math.fround(value))
    : !Object.is(fromHalf(view.getUint16(2 * i, true)), fromHalf(toHalf(value)))));
  if (different < 0) return;
  const at = different * bits / 8;
  const found = bits === 32 ? view.getFloat32(at, true) : fromHalf(view.getUint16(at, true));
  // as text of their own: JSON has no -0
  expect(`value ${different}`, Object.is(found, -0) ? '-0' : String(found), `${floats[different]} or the nearest`);
}

const bytes = await readFile(file);
const wanted = JSON.parse(await readFile(expectedFile, 'utf8'));
const container = read(new Uint8Array(bytes));
const isPacked = container.supercompressionScheme !== ktx.KHR_SUPERCOMPRESSION_NONE;
for (const [field, name] of Object.entries({ vkFormat: 'vkFormat', width: 'pixelWidth', height: 'pixelHeight',
  depth: 'pixelDepth', layers: 'layerCount', supercompression: 'supercompressionScheme' })) {
  if (field in wanted) expect(name, container[name], wanted[field]);
}
expect('faceCount', container.faceCount, 1);
expect('levelCount', container.levelCount, wanted.levels ?? 1);
const format = formats[container.vkFormat];
if (!format) throw new Error(`vkFormat ${container.vkFormat} is not one of halves or floats`);
expect('typeSize', container.typeSize, format.bits / 8);
checkDescriptor(container.dataFormatDescriptor, format, isPacked);
checkKeys(container.keyValue, wanted.keys ?? {});
// a packed level may start anywhere, another at a multiple of the texel and of 4; the finest level lies last
const texelBytes = format.channels * format.bits / 8;
const starts = container.levels.map(({ levelData }) => levelData.byteOffset);
if (!isPacked) expect('offsets of the levels', starts.map((at) => at % Math.max(4, texelBytes)), starts.map(() => 0));
expect('order of the levels', starts, [...starts].sort((a, b) => b - a));
const inflated = [];
for (const level of container.levels) inflated.push(Buffer.from(await inflate(level, container.supercompressionScheme)));
checkValues(new Uint8Array(Buffer.concat(inflated)), format, wanted.floats);
if (failures === 0) console.log(`${wanted.floats.length} values as expected`);
process.exitCode = failures > 0 ? 1 : 0;
