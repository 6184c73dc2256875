// What a reader would call wrong with a report's page; each check gives a list of texts, empty if nothing is.

// Pixels with a colour, as parts of all: axes and texts have none. A map is cells for the most part; of other charts a
// few lines and symbols are enough.
const leastColored = { map: 0.3, other: 0.001 };

// Charts follow a change of the window or of the medium one frame after the page hears of it.
export const settled = (page) =>
  page.evaluate(async () => {
    for (let i = 0; i < 5; i++) await new Promise(requestAnimationFrame);
  });

// Sections, text, pictures and charts as they stand.
export async function standing(page) {
  return page.evaluate((least) => {
    const found = [];
    const report = JSON.parse(document.getElementById('report').textContent);
    const expectHeading = (heading, title, times) => {
      const there = [...document.querySelectorAll(heading)].filter((e) => e.textContent.includes(title)).length;
      if (there < times) found.push(`${heading} "${title}" ${there} times, not ${times}`);
    };
    const own = ['Verdicts', 'Shading', 'Error against run time', 'Stability', 'What the figures mean', 'Provenance'];
    for (const title of [...report.tables.map((table) => table.name), ...own]) expectHeading('h2', title, 1);
    for (const title of ['Scores', 'Error maps', 'Smoothness between neighbours', 'Histograms', 'Lobes']) {
      expectHeading('h3', title, report.tables.length);
    }
    for (const table of report.tables) expectHeading('h1', table.name, 1);
    const absent = [...document.querySelectorAll('.absent')].map((line) => line.textContent).join(' ');
    const missing = {
      '--shading': report.shading.length === 0,
      '--pareto': report.pareto.length === 0,
      '--stability': report.stability === null,
      '--against': report.tables.some((table) => table.against.length === 0),
    };
    for (const [option, expected] of Object.entries(missing)) {
      if (absent.includes(option) !== expected)
        found.push(`${option} ${expected ? 'is not' : 'is'} named as what is missing`);
    }
    const failed = report.tables.flatMap((table) => table.verdicts).filter((verdict) => !verdict.pass).length;
    const shownFailed = document.querySelectorAll('#verdicts tr.failed').length;
    if (shownFailed !== failed) found.push(`${shownFailed} failed checks shown, not ${failed}`);

    const texts = [
      ['the page', document.body.innerText],
      ...[...document.querySelectorAll('[aria-label]')].map((e) => [
        `the label of ${e.id || e.className}`,
        e.getAttribute('aria-label'),
      ]),
    ];
    for (const box of document.querySelectorAll('.chart')) {
      const instance = echarts.getInstanceByDom(box);
      if (!instance) {
        found.push(`${box.id}: no chart`);
        continue;
      }
      instance.getZr().flush();
      const { width, height } = box.getBoundingClientRect();
      const leaves = instance
        .getZr()
        .storage.getDisplayList(true)
        .filter((e) => e.type === 'tspan' && e.style.text && !e.invisible);
      const rects = leaves.map((leaf) => {
        const rect = leaf.getBoundingRect().clone();
        if (leaf.transform) rect.applyTransform(leaf.transform);
        return rect;
      });
      texts.push([box.id, leaves.map((leaf) => leaf.style.text).join(' ')]);
      rects.forEach((rect, i) => {
        const text = leaves[i].style.text;
        if (rect.x < -1 || rect.y < -1 || rect.x + rect.width > width + 1 || rect.y + rect.height > height + 1) {
          found.push(`${box.id}: "${text}" is cut`);
        }
        for (let k = 0; k < i; k++) {
          const overlap = Math.min(rect.x + rect.width, rects[k].x + rects[k].width) - Math.max(rect.x, rects[k].x);
          const depth = Math.min(rect.y + rect.height, rects[k].y + rects[k].height) - Math.max(rect.y, rects[k].y);
          // boxes are higher than their letters
          if (overlap > 1 && depth > 4) found.push(`${box.id}: "${text}" over "${leaves[k].style.text}"`);
        }
      });
      // the names of the defaults cover no point
      for (const { type, data } of instance.getOption()?.series ?? []) {
        if (type !== 'scatter') continue;
        const names = report.pareto.flatMap(({ settings }) => settings.map(({ default_of: of }) => of.join(', ')));
        for (const at of data) {
          const [x, y] = instance.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, at);
          const over = rects.findIndex(
            (rect, i) =>
              names.includes(leaves[i].style.text) &&
              x > rect.x - 5 &&
              x < rect.x + rect.width + 5 &&
              y > rect.y - 5 &&
              y < rect.y + rect.height + 5,
          );
          if (over >= 0) found.push(`${box.id}: "${leaves[over].style.text}" over a point`);
        }
      }
      const canvas = box.querySelector('canvas');
      if (!canvas) {
        found.push(`${box.id}: nothing drawn`);
        continue;
      }
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d', { willReadFrequently: true });
      copy.drawImage(canvas, 0, 0);
      const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
      let colored = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 60) colored++;
      }
      const part = colored / (canvas.width * canvas.height);
      if (part < (box.classList.contains('square') ? least.map : least.other))
        found.push(`${box.id}: blank, ${part} of it coloured`);
      const drawn = instance.getOption().series.some((series) => series.data.length > 0);
      if (!drawn) found.push(`${box.id}: no data in it`);
      if (!box.getAttribute('aria-label')) found.push(`${box.id}: no text stands for it`);
    }
    for (const [where, text] of texts) {
      const bad = text.match(/.{0,20}(\bNaN|undefined|\[object|Infinity).{0,20}/);
      if (bad) found.push(`${where} says "${bad[0]}"`);
    }
    for (const image of document.images) {
      if (!image.complete || image.naturalWidth === 0) found.push(`picture "${image.alt}" is not there`);
    }
    // of random scenes those where the other table is closer
    const rendered = report.shading
      .flatMap(({ scenes }) => scenes)
      .filter(({ random, error, against }) => !random || (against && against.rmse < error.rmse))
      .flatMap((scene) => Object.keys(scene.pictures ?? {}));
    const pictures =
      report.tables.flatMap((table) => table.lobes).flatMap((lobe) => lobe.images).length + rendered.length;
    if (document.images.length !== pictures) found.push(`${document.images.length} pictures, not ${pictures}`);
    for (const control of document.querySelectorAll('select, input')) {
      if (control.labels.length === 0 || !control.labels[0].textContent) found.push(`${control.id} has no label`);
    }
    const ids = [...document.querySelectorAll('[id]')].map((e) => e.id);
    for (const id of new Set(ids)) if (ids.filter((other) => other === id).length > 1) found.push(`id ${id} twice`);
    for (const link of document.querySelectorAll('a[href^="#"]')) {
      if (!document.getElementById(decodeURIComponent(link.hash.slice(1)))) found.push(`nothing at ${link.hash}`);
    }
    return found;
  }, leastColored);
}

// Nothing outside of the window, no text of a legend and no control over another.
export async function layout(page) {
  return page.evaluate(() => {
    const found = [];
    const name = (e) =>
      `${e.tagName.toLowerCase()}${e.id ? `#${e.id}` : ''}${e.className ? `.${e.className}` : ''} "${e.textContent.slice(0, 30)}"`;
    if (document.documentElement.scrollWidth > innerWidth)
      found.push(`the page is ${document.documentElement.scrollWidth} wide`);
    for (const e of document.body.querySelectorAll('*')) {
      if (
        e.closest('.skip') ||
        e.closest('script') ||
        (e.parentElement.closest('.scroll') && !matchMedia('print').matches)
      )
        continue;
      const rect = e.getBoundingClientRect();
      if (rect.width > 0 && (rect.right > innerWidth + 1 || rect.left < -1))
        found.push(`${name(e)} ends at ${Math.round(rect.right)}`);
    }
    // what a list that scrolls hides is not there
    const shownPart = (e) => {
      const own = e.getBoundingClientRect();
      const list = e.closest('.scenes.small')?.getBoundingClientRect() ?? own;
      const edges = { left: own.left, right: own.right, top: Math.max(own.top, list.top) };
      return { ...edges, width: own.width, bottom: Math.min(own.bottom, list.bottom) };
    };
    const apart = (elements) =>
      elements.forEach((e, i) =>
        elements.slice(0, i).forEach((other) => {
          const [a, b] = [shownPart(e), shownPart(other)];
          if (
            a.width > 0 &&
            Math.min(a.right, b.right) - Math.max(a.left, b.left) > 0.5 &&
            Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.5
          )
            found.push(`${name(e)} over ${name(other)}`);
        }),
      );
    document.querySelectorAll('.ticks').forEach((ticks) => apart([...ticks.children]));
    document.querySelectorAll('.legend').forEach((legend) => apart([...legend.children]));
    apart([...document.querySelectorAll('.control, .chart, .legend, .colorbar, .pager, .scene, h2, h3, h4')]);
    return found;
  });
}

// Tooltips show where the mouse is on a chart, and stay within the window.
export async function tooltips(page) {
  const found = [];
  for (const box of await page.$$('.chart')) {
    const id = await box.getAttribute('id');
    await box.scrollIntoViewIfNeeded();
    const rect = await box.boundingBox();
    // the symbol of a setting, or the middle of the other charts
    const [x, y] = await box.evaluate((e) => {
      const instance = echarts.getInstanceByDom(e);
      const scatter = instance.getOption().series.find((series) => series.type === 'scatter');
      if (!scatter) return [0.6 * e.clientWidth, 0.4 * e.clientHeight];
      return instance.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, scatter.data[0]);
    });
    await page.mouse.move(rect.x + x, rect.y + y);
    const shown = await page
      .waitForFunction(
        (e) => [...e.children].find((child) => child.innerText && getComputedStyle(child).opacity > 0.9),
        box,
        { timeout: 3000 },
      )
      .catch(() => null);
    if (!shown) {
      found.push(`${id}: no tooltip`);
      continue;
    }
    const text = await shown.evaluate((e) => e.innerText);
    if (/NaN|undefined|\[object/.test(text)) found.push(`${id}: tooltip "${text}"`);
    const wide = await shown.evaluate((e) => {
      const { left, right } = e.getBoundingClientRect();
      return left < -1 || right > innerWidth + 1 || document.documentElement.scrollWidth > innerWidth;
    });
    if (wide) found.push(`${id}: the tooltip leaves the window`);
    await page.mouse.move(1, 1);
  }
  return found;
}

// What a section shows: its charts' pixels, or its text where it has none.
const signature = (handle) =>
  handle.evaluate((e) => {
    const boxes = [...e.closest('section').querySelectorAll('.chart')];
    if (boxes.length === 0) return e.closest('section').innerText;
    return boxes
      .map((box) => {
        echarts.getInstanceByDom(box).getZr().flush();
        const copy = new OffscreenCanvas(300, 200).getContext('2d', { willReadFrequently: true });
        copy.drawImage(box.querySelector('canvas'), 0, 0, 300, 200);
        return copy.getImageData(0, 0, 300, 200).data.reduce((hash, byte) => (Math.imul(hash, 31) + byte) | 0, 7);
      })
      .join(' ');
  });

export async function selectors(page) {
  const found = [];
  for (const select of await page.$$('main section:not(#stability) select')) {
    const what = await select.evaluate((e) => `${e.closest('section').id}, ${e.labels[0].textContent}`);
    const start = await select.inputValue();
    const values = await select.evaluate((e) => [...e.options].map((option) => option.value));
    let last = await signature(select);
    for (const value of [
      ...values.filter((other) => other !== start).slice(-3),
      ...(values.length > 1 ? [start] : []),
    ]) {
      await select.selectOption(value);
      const now = await signature(select);
      if (now === last) found.push(`${what}: nothing changes with "${value}"`);
      last = now;
    }
  }
  return found;
}

export async function sliders(page) {
  const found = [];
  for (const slider of await page.$$('input[type=range]')) {
    const what = await slider.evaluate((e) => `${e.closest('section').id}, ${e.labels[0].textContent}`);
    const state = async () => [
      await signature(slider),
      await slider.evaluate((e) => e.closest('.control').querySelector('output').textContent),
      await slider.getAttribute('aria-valuetext'),
    ];
    const moved = async (how, move) => {
      const before = await state();
      await move();
      const after = await state();
      ['the map', 'the text', 'the spoken text'].forEach((part, i) => {
        if (before[i] === after[i]) found.push(`${what}: ${part} stays when moved by ${how}`);
      });
    };
    const start = await slider.inputValue();
    await slider.focus();
    await moved('the keyboard', () => page.keyboard.press('ArrowRight'));
    await moved('the mouse', async () => {
      await slider.scrollIntoViewIfNeeded();
      const box = await slider.boundingBox();
      await page.mouse.click(box.x + 0.1 * box.width, box.y + box.height / 2);
    });
    await slider.fill(start);
  }
  return found;
}

// Arrow keys read nodes of the maps.
export async function keyboard(page) {
  const found = [];
  await page.keyboard.press('Tab');
  const first = await page.evaluate(() => document.activeElement.className);
  if (first !== 'skip') found.push(`the first stop is "${first}", not the skip link`);
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
  if (outline === 'none') found.push('the focus cannot be seen');
  for (const map of await page.$$('.chart.square')) {
    const readout = await map.evaluateHandle((e) => e.parentElement.querySelector('output'));
    const texts = [];
    await map.focus();
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowUp']) {
      await page.keyboard.press(key);
      texts.push(await readout.evaluate((e) => e.textContent));
    }
    const id = await map.getAttribute('id');
    if (new Set(texts).size !== 3) found.push(`${id}: arrow keys read ${texts.join(' | ')}`);
    if (texts.some((text) => /NaN|undefined/.test(text))) found.push(`${id}: reads ${texts.join(' | ')}`);
    await map.evaluate((e) => e.blur());
  }
  return found;
}

// The table of all rows: filters, order, pages.
export async function rows(page) {
  const report = await page.evaluate(() => JSON.parse(document.getElementById('report').textContent));
  if (!report.stability || report.stability.rows.length === 0) return [];
  const found = [];
  const all = report.stability.rows;
  const browser = '#stability .screen-only';
  const [fitter, verdict] = await page.$$(`${browser} select`);
  const column = async (title) =>
    page.$$eval(
      `${browser} table`,
      ([table], wanted) => {
        const i = [...table.tHead.rows[0].cells].findIndex((cell) => cell.textContent === wanted);
        return [...table.tBodies[0].rows].map((row) => row.cells[i].textContent);
      },
      title,
    );
  const expect = async (count, what) => {
    const position = await page.$eval(`${browser} .position`, (e) => e.textContent);
    const shown =
      count === 0 ? 'no such row' : `rows 1 to ${Math.min(50, count)} of ${count.toLocaleString('en-US')}`;
    if (position !== shown) found.push(`${what}: "${position}", not "${shown}"`);
  };
  await expect(all.length, 'all rows');
  // judged rows first, those nearest to a limit on top; all of one height
  const near = (row) =>
    Math.max(
      0,
      ...report.stability.limits
        .filter(({ id, limit }) => limit > 0 && row[id] && !(row.pass && row[id] > limit))
        .map(({ id, limit }) => row[id] / limit),
    );
  const judged = all.filter((row) => row.default);
  const wanted = [false, true]
    .flatMap((pass) => judged.filter((row) => row.pass === pass).sort((a, b) => near(b) - near(a)))
    .slice(0, 20)
    .map((row) => Number(row.sw1.toPrecision(3)));
  if ((await column('SW1')).slice(0, 20).some((text, i) => i < wanted.length && Number(text) !== wanted[i]))
    found.push('rows do not begin with those nearest to a limit');
  const heights = await page.$$eval(`${browser} tbody tr`, (lines) => lines.map((line) => line.offsetHeight));
  if (Math.max(...heights) > Math.min(...heights) + 1)
    found.push(`rows of ${Math.min(...heights)} to ${Math.max(...heights)} pixels`);
  for (const [name, wanted] of [
    ['fail', false],
    ['pass', true],
  ]) {
    await verdict.selectOption(name);
    await expect(all.filter((row) => row.default && row.pass === wanted).length, name);
    if ((await column('verdict')).some((text) => !text.includes(name)))
      found.push(`other rows than those that ${name}`);
  }
  await verdict.selectOption('');
  const last = all[all.length - 1].fitter;
  await fitter.selectOption(last);
  await expect(all.filter((row) => row.fitter === last).length, last);
  if ((await column('fitter')).some((text) => text.replace(' *', '') !== last))
    found.push(`other fitters than ${last}`);
  await fitter.selectOption('');

  const titles = await page.$$eval(`${browser} th .sort`, (buttons) => buttons.map((button) => button.textContent));
  for (const title of titles) {
    const button = page.locator(`${browser} th .sort`, {
      hasText: new RegExp(`^${title.replace(/[/()\s]/g, '\\$&')}$`),
    });
    const orders = [];
    for (const press of [() => button.click(), () => button.press('Enter')]) {
      await press();
      const texts = await column(title);
      const values = texts.map((text) => (text === '' ? NaN : Number(text)));
      const numbers = values.filter(Number.isFinite);
      const order = await button.evaluate((e) => e.closest('th').getAttribute('aria-sort'));
      orders.push(order);
      const sign = order === 'descending' ? -1 : 1;
      if (numbers.some((value, i) => i > 0 && sign * (value - numbers[i - 1]) < 0))
        found.push(`${title}: not ${order}`);
      // rows without a value stand last
      if (numbers.length > 0 && values.slice(0, numbers.length).some((value) => !Number.isFinite(value))) {
        found.push(`${title}: empty rows are not last`);
      }
    }
    if (new Set(orders).size !== 2) found.push(`${title}: orders ${orders.join(', ')}`);
  }
  if (all.length > 50) {
    await page.click(`${browser} .pager button:nth-child(2)`);
    const position = await page.$eval(`${browser} .position`, (e) => e.textContent);
    if (!position.startsWith('rows 51 to ')) found.push(`after Next: "${position}"`);
    await page.click(`${browser} .pager button:nth-child(1)`);
  }
  return found;
}

const luminances = (page) =>
  page.evaluate(() => {
    const luminance = (color) => {
      const [r, g, b] = color.match(/[\d.]+/g).map((c) => Number(c) / 255);
      return 0.2126 * r ** 2.2 + 0.7152 * g ** 2.2 + 0.0722 * b ** 2.2;
    };
    const style = getComputedStyle(document.body);
    const probe = document.createElement('span');
    document.body.append(probe);
    const charts = [...document.querySelectorAll('.chart')].map((box) => {
      const zr = echarts.getInstanceByDom(box).getZr();
      zr.flush();
      const label = zr.storage.getDisplayList(true).find((e) => e.type === 'tspan' && e.style.fill);
      probe.style.color = label.style.fill;
      return luminance(getComputedStyle(probe).color);
    });
    probe.remove();
    return { text: luminance(style.color), paper: luminance(style.backgroundColor), charts };
  });

// Colours of page and charts, and that they follow when the reader's choice changes.
export async function schemes(page) {
  const found = [];
  const expect = async (dark, what) => {
    await settled(page);
    const { text, paper, charts } = await luminances(page);
    const [high, low] = [Math.max(text, paper), Math.min(text, paper)];
    if (dark !== text > paper) found.push(`${what}: the page is ${dark ? 'light' : 'dark'}`);
    if ((high + 0.05) / (low + 0.05) < 7) found.push(`${what}: text and page are too alike`);
    if (charts.some((chart) => dark !== chart > 0.4)) found.push(`${what}: charts are ${dark ? 'light' : 'dark'}`);
  };
  await page.emulateMedia({ colorScheme: 'light' });
  await expect(false, 'light scheme');
  await page.emulateMedia({ colorScheme: 'dark' });
  await expect(true, 'dark scheme');
  await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
  await expect(false, 'print from the dark scheme');
  await page.emulateMedia({ media: 'screen', colorScheme: 'dark' });
  await expect(true, 'dark scheme after print');
  await page.emulateMedia({ media: null, colorScheme: null });
  await settled(page);
  return found;
}

// On A4: light, everything within the paper's width, no controls, the rows that matter.
export async function print(page) {
  const before = page.viewportSize();
  await page.setViewportSize({ width: 680, height: 970 }); // A4 less margins of 15 and 14 mm
  await page.emulateMedia({ media: 'print' });
  await settled(page);
  const found = [
    ...(await standing(page)),
    ...(await layout(page)),
    ...(await page.evaluate(() => {
      const wrong = [];
      const seen = (e) => e.getBoundingClientRect().height > 0;
      if ([...document.querySelectorAll('input, button, nav')].some(seen)) wrong.push('controls are printed');
      const { stability } = JSON.parse(document.getElementById('report').textContent);
      if (stability && stability.rows.length > 0) {
        const failed = stability.rows.filter((row) => row.default && !row.pass).length;
        const wanted = failed + Math.min(30, stability.rows.length - failed);
        const there = document.querySelectorAll('#stability .print-only tbody tr').length;
        if (there !== wanted) wrong.push(`${there} rows are printed, not ${wanted}`);
      }
      return wrong;
    })),
  ].map((text) => `print: ${text}`);
  await page.emulateMedia({ media: null });
  await page.setViewportSize(before);
  await settled(page);
  return found;
}
