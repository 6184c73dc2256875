// An exported ES module against the numbers it should hold, as float32: node three_module.mjs MODULE.js EXPECTED.json
// EXPECTED: { LTC_MAT_1: [...], LTC_MAT_2: [...] }. Exit code 1 and a line for each thing that differs.
import { readFile } from 'node:fs/promises';
import { importModule } from './tables.mjs';

const [file, expectedFile] = process.argv.slice(2);
const module = await importModule(file);
const expected = JSON.parse(await readFile(expectedFile, 'utf8'));
const failures = [];
for (const name of Object.keys(expected)) {
  const found = module[name];
  if (!Array.isArray(found) || found.length !== expected[name].length) {
    failures.push(`${name}: ${found?.length} numbers, not ${expected[name].length}`);
    continue;
  }
  const i = found.findIndex((value, k) => !Object.is(Math.fround(value), Math.fround(expected[name][k])));
  if (i >= 0) failures.push(`${name}[${i}]: ${found[i]}, not ${expected[name][i]}`);
}
for (const failure of failures) console.log(`FAILED: ${failure}`);
if (failures.length === 0) console.log(`${Object.keys(expected).join(', ')} as expected`);
process.exitCode = failures.length > 0 ? 1 : 0;
