// The texels of a DDS file as Babylon.js' loader sees them, as JSON on standard output: size, type and the numbers of every
// layer or slice behind the header.
//   node dds.mjs FILE.dds LAYERS BUILD_WEB
import { readFile } from 'node:fs/promises';
import { pathToFileURL } from 'node:url';
import { resolve } from 'node:path';

const [file, layers, buildWeb] = process.argv.slice(2);
const { DDSTools } = await import(pathToFileURL(resolve(buildWeb, 'node_modules/@babylonjs/core/Misc/dds.js')));
const bytes = new Uint8Array(await readFile(file));
const info = DDSTools.GetDDSInfo(bytes);
const half = info.textureType === 2;
if (!half && info.textureType !== 1) throw new Error(`neither a half nor a float texture: ${JSON.stringify(info)}`);
// where the loader begins to read: the header's own length and magic, and the extension of DX10
const header = new Int32Array(bytes.buffer, 0, 32)[1] + 4 + (info.dxgiFormat ? 20 : 0);
const count = info.width * info.height * 4;
const floats = [];
for (let layer = 0; layer < Number(layers); ++layer) {
  const at = header + layer * count * (half ? 2 : 4);
  const texels = half
    ? DDSTools._GetHalfFloatAsFloatRGBAArrayBuffer(info.width, info.height, at, count, bytes.buffer, 0)
    : DDSTools._GetFloatRGBAArrayBuffer(info.width, info.height, at, count, bytes.buffer, 0);
  for (const v of texels) floats.push(v);
}
const rest = bytes.length - header - floats.length * (half ? 2 : 4);
process.stdout.write(JSON.stringify({ width: info.width, height: info.height, half, rest, floats }));
