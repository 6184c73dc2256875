// The three files of a 64 x 64 table, read and written independently of ltcfit: 8 numbers a texel, t1 rgba then t2 rgba.
import { readFile } from 'node:fs/promises';

const texels = 64 * 64;

// An ES module from any file: as data, for node takes a .js for a module only where a package.json says so.
export async function importModule(file) {
  return import(`data:text/javascript;base64,${(await readFile(file)).toString('base64')}`);
}

export const lanes = 8;

export function fromHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -14 * (fraction / 1024));
}

// Round to nearest, ties to even, as IEEE 754 asks. The product with a power of two is exact.
export function toHalf(value) {
  if (Number.isNaN(value)) return 0x7e00;
  const sign = value < 0 || Object.is(value, -0) ? 0x8000 : 0;
  const size = Math.abs(value);
  if (size >= 65520) return sign | 0x7c00;
  const exponent = Math.max(Math.floor(Math.log2(size)), -14);
  const steps = size / 2 ** (exponent - 10);
  const floor = Math.floor(steps);
  const up = steps - floor > 0.5 || (steps - floor === 0.5 && floor % 2 === 1);
  // a carry out of the fraction lands in the exponent, where it belongs
  return sign | (((exponent + 14) << 10) + floor + (up ? 1 : 0));
}

// Between the halves next to a number.
export function spacingOfHalves(value) {
  return 2 ** (Math.max(Math.floor(Math.log2(Math.abs(value))), -14) - 10);
}

function fromPair(t1, t2) {
  const table = new Float64Array(texels * lanes);
  for (let i = 0; i < texels; i++) {
    for (let c = 0; c < 4; c++) {
      table[i * lanes + c] = t1[4 * i + c];
      table[i * lanes + 4 + c] = t2[4 * i + c];
    }
  }
  return table;
}

function quad(table, first) {
  return Array.from({ length: 4 * texels }, (_, i) => table[(i >> 2) * lanes + first + (i & 3)]);
}

function expectSize(bytes, size) {
  if (bytes.length !== size) throw new Error(`${bytes.length} bytes, not ${size}`);
}

export const formats = {
  three: {
    path: 'three.js',
    async read(file) {
      const { LTC_MAT_1, LTC_MAT_2 } = await importModule(file);
      for (const array of [LTC_MAT_1, LTC_MAT_2]) expectSize(array, 4 * texels);
      return fromPair(LTC_MAT_1, LTC_MAT_2);
    },
    write(table) {
      return Buffer.from(`export const LTC_MAT_1 = [${quad(table, 0)}];\nexport const LTC_MAT_2 = [${quad(table, 4)}];\n`);
    },
  },
  babylon: {
    path: 'areaLights/areaLightsLTC.bin',
    async read(file) {
      const bytes = await readFile(file);
      expectSize(bytes, 2 * lanes * texels);
      return Float64Array.from({ length: lanes * texels }, (_, i) => fromHalf(bytes.readUInt16LE(2 * i)));
    },
    write(table) {
      const bytes = Buffer.alloc(2 * lanes * texels);
      table.forEach((value, i) => bytes.writeUInt16LE(toHalf(value), 2 * i));
      return bytes;
    },
  },
  playcanvas: {
    path: 'area-light-luts.bin',
    async read(file) {
      const bytes = await readFile(file);
      expectSize(bytes, 4 + 4 * lanes * texels);
      if (bytes.readInt16LE(0) !== 0 || bytes.readInt16LE(2) !== 1) throw new Error('the version is not 0.1');
      const at = (from) => Array.from({ length: 4 * texels }, (_, i) => bytes.readFloatLE(from + 4 * i));
      return fromPair(at(4), at(4 + 16 * texels));
    },
    write(table) {
      const bytes = Buffer.alloc(4 + 4 * lanes * texels);
      bytes.writeInt16LE(1, 2);
      [...quad(table, 0), ...quad(table, 4)].forEach((value, i) => bytes.writeFloatLE(value, 4 + 4 * i));
      return bytes;
    },
  },
};

// Tables that the checks of a picture must catch. The NaN lies where the middle of the floor is looked up.
const moved = (table, from) => table.map((_, i) => table[from(Math.floor(i / lanes), i % lanes)]);
const transposed = [0, 2, 1, 3, 4, 5, 6, 7];
export const damages = {
  'one NaN texel': (table) => table.map((value, i) => (Math.floor(i / lanes) === 55 * 64 + 23 ? NaN : value)),
  'all zeros': (table) => table.map(() => 0),
  'matrices transposed': (table) => moved(table, (texel, lane) => texel * lanes + transposed[lane]),
  'axes exchanged': (table) =>
    moved(table, (texel, lane) => ((texel % 64) * 64 + Math.floor(texel / 64)) * lanes + lane),
  't1 and t2 exchanged': (table) => moved(table, (texel, lane) => texel * lanes + (lane ^ 4)),
};
