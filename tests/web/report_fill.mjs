// Fills the page of report/page as `ltcfit report` does, with a report given: for samples.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

// JSON inside of an element: no name in it can end the element
const jsonText = (value) => JSON.stringify(value).replaceAll('<', '\\u003c');
const markupText = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

// chartsPath: the charting library.
export async function fillPage(sourceDir, chartsPath, { report, images }) {
  const page = join(sourceDir, 'report', 'page');
  const text = (name) => readFile(join(page, name), 'utf8');
  const scripts = (await text('scripts.txt')).split('\n').filter(Boolean);
  const parts = {
    '<!--LTCFIT-TITLE-->': markupText(report.tables.map((table) => table.name).join(', ')),
    '/*LTCFIT-CSS*/': await text('page.css'),
    '/*LTCFIT-CHARTS*/': await readFile(chartsPath, 'utf8'),
    '/*LTCFIT-SCRIPT*/': (await Promise.all(scripts.map(text))).join('\n'),
    '/*LTCFIT-REPORT*/': jsonText(report),
    '/*LTCFIT-IMAGES*/': jsonText(images),
  };
  let filled = await text('page.html');
  for (const [placeholder, content] of Object.entries(parts)) {
    const pieces = filled.split(placeholder);
    if (pieces.length !== 2) throw new Error(`page.html has ${placeholder} ${pieces.length - 1} times`);
    filled = pieces.join(content);
  }
  return filled;
}
