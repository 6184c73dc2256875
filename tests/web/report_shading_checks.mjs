// What a reader would call wrong with the section about rendered scenes; each check gives a list of texts.

// Summaries, tables, points and cards say what the file says.
async function figures(page) {
  return page.evaluate(() => {
    const found = [];
    const { shading: shadings } = JSON.parse(document.getElementById('report').textContent);
    if (window.hurt) found.push('a name of the file is run as a script');
    if (document.querySelector('#shading b')) found.push('a name of the file is markup');
    const expect = (what, is, wanted) => {
      if (is !== wanted) found.push(`${what}: ${is}, not ${wanted}`);
    };
    const three = (value) => Number(value.toPrecision(3));
    const isCloser = ({ error, against }) => against !== null && against.rmse < error.rmse;
    shadings.forEach((shading, i) => {
      const own = document.getElementById(`shading-${i}`);
      if (!own) {
        found.push(`no section for ${shading.table.name}`);
        return;
      }
      const what = `shading-${i}`;
      const named = shading.scenes.filter(({ random }) => !random);
      const random = shading.scenes.filter((scene) => scene.random);
      const lost = shading.against ? random.filter(isCloser) : [];
      const passed = shading.scenes.filter((scene) => scene.passed).length;
      const words = own.querySelector('.findings').textContent;
      const says = (text) => {
        if (!words.includes(text)) found.push(`${what}: the summary does not say "${text}"`);
      };
      says(`${passed} of ${shading.scenes.length} scenes`);
      says(shading.renderer);
      const line = [...document.querySelectorAll('#top li')].find((e) => e.textContent.startsWith(`${shading.table.name}, rendered`));
      if (!line?.querySelector(shading.passed ? '.pass' : '.fail')) found.push(`${what}: no word on it, or a wrong one, on top`);
      if (shading.against) {
        says(`own error in ${shading.random.closer} of ${shading.random.scenes} random scenes`);
        says(`${shading.against.name} is closer in ${lost.length}`);
      }
      if (shading.random) says(String(three(shading.random.rmse)));

      const table = [...own.querySelectorAll('table')].find((one) => one.caption.textContent.startsWith('Errors'));
      const column = (title) => {
        const at = [...table.tHead.rows[0].cells].findIndex((cell) => cell.textContent === title);
        return [...table.tBodies[0].rows].map((row) => row.cells[at].textContent);
      };
      expect(`${what}: named scenes`, table.tBodies[0].rows.length, named.length);
      expect(`${what}: RMSE`, column('RMSE').join(), named.map(({ error }) => three(error.rmse)).join());
      if (shading.against) {
        const ratios = named.map(({ error, against }) =>
          against.rmse > 0 ? `${three(error.rmse / against.rmse)} \u00d7` : '\u2013',
        );
        expect(`${what}: ratios`, column('RMSE / other').map((text) => text.replace(/ [\u25bc\u25b2=]$/, '')).join(), ratios.join());
      }
      expect(
        `${what}: scenes whose reference is not exact enough`,
        column('Own error of the reference').filter((text) => text.endsWith('*')).length,
        named.filter(({ reference }) => !reference.resolved).length,
      );
      expect(
        `${what}: failed scenes`,
        table.querySelectorAll('tr.failed').length,
        named.filter((scene) => !scene.passed).length,
      );

      const cards = [...own.querySelectorAll('.scene')];
      const shown = [...named, ...lost.sort((a, b) => b.error.rmse / b.against.rmse - a.error.rmse / a.against.rmse)];
      expect(
        `${what}: scenes with pictures`,
        cards.map((card) => card.querySelector('h5').textContent).join(' | '),
        shown.map(({ name, title, random: drawn }) => (drawn ? name : `${name}: ${title}`)).join(' | '),
      );
      cards.forEach((card, k) => {
        const scene = shown[k];
        if (!scene) return;
        const keys = ['ltc', 'reference', 'difference', 'against', 'against_difference'];
        const wanted = keys.map((key) => scene.pictures?.[key]).filter(Boolean);
        const images = [...card.querySelectorAll('img')];
        expect(
          `${scene.name}: pictures that are those of the file`,
          images.filter((image, n) => image.src === `data:image/png;base64,${wanted[n]}`).length,
          wanted.length,
        );
        expect(`${scene.name}: texts for pictures`, new Set(images.map((image) => image.alt)).size, wanted.length);
        if (!scene.passed && !card.textContent.includes('GL fails')) found.push(`${scene.name}: no word on why it fails`);
        if (isCloser(scene) && !card.textContent.includes(scene.explanation))
          found.push(`${scene.name}: no word on why the other table is closer`);
      });

      const box = document.getElementById(`${what}-scatter`);
      const drawn = random.filter(({ error, against }) => error.rmse > 0 && against?.rmse > 0);
      expect(`${what}: a chart`, box !== null, drawn.length > 0);
      if (box) {
        const option = echarts.getInstanceByDom(box).getOption();
        const points = option.series.filter(({ type }) => type === 'scatter').map(({ data }) => data);
        expect(`${what}: points`, points.flat().length, drawn.length);
        expect(
          `${what}: points above the diagonal, drawn apart`,
          points.filter((data) => data.every(([x, y]) => y > x)).flat().length,
          drawn.filter(isCloser).length,
        );
        expect(
          `${what}: kinds of points`,
          points.length,
          new Set(drawn.map((scene) => `${isCloser(scene)} ${scene.reference.resolved}`)).size,
        );
        const [x, y] = [option.xAxis[0], option.yAxis[0]];
        expect(`${what}: range of the axes`, `${x.min} ${x.max}`, `${y.min} ${y.max}`);
      }
    });
    return found;
  });
}

// Every kind of point says what it is; those where the other table is closer, why.
async function points(page) {
  const found = [];
  const { shading: shadings } = JSON.parse(await page.$eval('#report', (e) => e.textContent));
  for (const [i, shading] of shadings.entries()) {
    const box = await page.$(`#shading-${i}-scatter`);
    if (!box) continue;
    await box.scrollIntoViewIfNeeded();
    // the last point of each kind
    const places = await box.evaluate((e) => {
      const instance = echarts.getInstanceByDom(e);
      return instance
        .getOption()
        .series.filter(({ type }) => type === 'scatter')
        .map(({ data }) => data[data.length - 1])
        .map((at) => ({ at, pixel: instance.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, at) }));
    });
    for (const { at, pixel } of places) {
      const near = (a, b) => Math.abs(Math.log10(a) - b) < 1e-9;
      const scene = shading.scenes.find(
        ({ random, error, against }) => random && near(against.rmse, at[0]) && near(error.rmse, at[1]),
      );
      const rect = await box.boundingBox();
      await page.mouse.move(rect.x + pixel[0], rect.y + pixel[1]);
      const wanted = [scene.name, scene.explanation, scene.reference.resolved ? '' : 'not exact enough'].filter(Boolean);
      const there = await page
        .waitForFunction(
          ([e, texts]) =>
            [...e.children].some(
              (child) => getComputedStyle(child).opacity > 0.9 && texts.every((text) => child.innerText?.includes(text)),
            ),
          [box, wanted],
          { timeout: 3000 },
        )
        .catch(() => null);
      if (!there) found.push(`shading-${i}: the point of ${scene.name} does not say ${wanted.join(', ')}`);
      await page.mouse.move(1, 1);
    }
  }
  return found;
}

// Pictures get larger by the keyboard and by the mouse, change in place, and go again.
async function viewer(page) {
  const found = [];
  const card = page.locator('.scene:has(img)').first();
  if ((await card.count()) === 0) return found;
  const button = card.locator('button');
  const state = () =>
    page.evaluate(() => {
      const dialog = document.querySelector('dialog.viewer[open]');
      if (!dialog) return null;
      const image = dialog.querySelector('img');
      const { left, right, top, bottom } = dialog.getBoundingClientRect();
      const parts = [...dialog.querySelectorAll('*')].map((e) => e.getBoundingClientRect());
      return {
        alt: image.alt,
        source: image.src,
        there: image.complete && image.naturalWidth > 0,
        width: image.getBoundingClientRect().width,
        pressed: dialog.querySelectorAll('[aria-pressed="true"]').length,
        inside: left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight,
        wide: parts.some((part) => part.right > right + 1),
      };
    });
  const decoded = () =>
    page.waitForFunction(() => document.querySelector('dialog.viewer img')?.naturalWidth > 0, null, { timeout: 3000 });
  // a dialog's close event is a task of its own, some time after the key or the click
  const gone = () =>
    page.waitForFunction(() => !document.querySelector('dialog'), null, { timeout: 3000 }).then(
      () => true,
      () => false,
    );
  await button.focus();
  await page.keyboard.press('Enter');
  await decoded().catch(() => null);
  const first = await state();
  if (!first) return ['the button does not enlarge a picture'];
  const small = await card.locator('img').first().boundingBox();
  if (!first.there || first.pressed !== 1) found.push('the enlarged picture is not there, or none is chosen');
  if (first.width < 1.2 * small.width) found.push(`enlarged, a picture is ${first.width} pixels, ${small.width} before`);
  if (!first.inside || first.wide) found.push('the enlarged picture leaves the window');
  await page.keyboard.press('ArrowRight');
  const second = await state();
  if (second?.source === first.source || second?.alt === first.alt) found.push('an arrow key changes no picture');
  await page.keyboard.press('ArrowLeft');
  if ((await state())?.source !== first.source) found.push('the other arrow key does not lead back');
  await page.keyboard.press('Escape');
  if (!(await gone())) found.push('Escape leaves the picture open');
  if (!(await button.evaluate((e) => e === document.activeElement))) found.push('the focus is lost after the picture');
  const image = card.locator('img').nth(1);
  await image.click();
  await decoded().catch(() => null);
  if ((await state())?.source !== (await image.getAttribute('src'))) found.push('a click enlarges another picture');
  await page.locator('dialog .close').click();
  if (!(await gone())) found.push('the button does not close the picture');
  await page.evaluate(() => document.activeElement.blur());
  return found;
}

export async function shading(page) {
  return [...(await figures(page)), ...(await points(page)), ...(await viewer(page))];
}
