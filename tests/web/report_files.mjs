// Made-up results of `ltcfit check-gl`, `ltcfit pareto` and `ltcfit stability`, as files: node report_files.mjs DIRECTORY
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { samplePareto, sampleStability } from './report_sample.mjs';
import { sampleShading } from './report_shading_sample.mjs';

const [directory] = process.argv.slice(2);
const files = {
  'pareto_iso.json': samplePareto('iso'),
  'pareto_aniso.json': samplePareto('aniso'),
  'shading_iso.json': sampleShading('isotropic'),
  'shading_aniso.json': sampleShading('anisotropic'),
  'stability.json': sampleStability(),
};
for (const [name, content] of Object.entries(files)) await writeFile(join(directory, name), JSON.stringify(content));
