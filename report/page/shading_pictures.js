// Pictures of rendered scenes in rows, and one of them larger.

// key, caption, and the text for those who do not see it, of each picture that a scene may have
function pictureTexts(shading) {
  const own = shading.table.name;
  const other = shading.against?.name;
  return [
    ['ltc', own, `with the LTCs of ${own}`],
    ['reference', 'reference', 'by Monte Carlo'],
    ['difference', `difference \u00d7 5, ${own}`, `difference of ${own} to the reference, times 5`],
    ['against', other, `with the LTCs of ${other}`],
    ['against_difference', `difference \u00d7 5, ${other}`, `difference of ${other} to the reference, times 5`],
  ];
}

function picturesOf(shading, scene) {
  return pictureTexts(shading)
    .filter(([key]) => scene.pictures?.[key])
    .map(([key, caption, text]) => ({
      source: `data:image/png;base64,${scene.pictures[key]}`,
      caption,
      alt: `${scene.name}, ${text}`,
    }));
}

// One picture at a time, as large as the window allows, all in the same place: what differs then moves.
function openViewer(title, pictures, first) {
  const image = element('img', {});
  const buttons = pictures.map(({ alt }, i) => {
    const button = element('button', { type: 'button', title: alt }, pictures[i].caption);
    button.addEventListener('click', () => show(i));
    return button;
  });
  const close = element('button', { type: 'button', class: 'close' }, 'Close');
  const dialog = element(
    'dialog',
    { class: 'viewer', 'aria-label': title },
    element('p', { class: 'viewer-title' }, title),
    image,
    element('div', { class: 'controls' }, buttons, close),
  );
  let current = first;
  const show = (i) => {
    current = (i + pictures.length) % pictures.length;
    image.src = pictures[current].source;
    image.alt = pictures[current].alt;
    buttons.forEach((button, k) => button.setAttribute('aria-pressed', k === current));
    buttons[current].focus();
  };
  dialog.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    show(current + step);
  });
  // the page behind the dialog is no part of it
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  close.addEventListener('click', () => dialog.close());
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  show(first);
}

// A scene: its pictures in a row, and what is to be said about it.
function sceneCard(shading, scene, title, ...texts) {
  const pictures = picturesOf(shading, scene);
  const open = (i) => openViewer(title, pictures, i);
  const figures = pictures.map(({ source, caption, alt }, i) => {
    const image = element('img', { src: source, alt, loading: 'eager' });
    image.addEventListener('click', () => open(i));
    return element('figure', {}, image, element('figcaption', {}, caption));
  });
  const button = element(
    'button',
    { type: 'button', class: 'screen-only enlarge', 'aria-label': `Enlarge the pictures of ${scene.name}` },
    'Enlarge',
  );
  button.addEventListener('click', () => open(0));
  return element(
    'article',
    { class: 'scene' },
    element('div', { class: 'scene-head' }, element('h5', {}, title), pictures.length > 0 ? button : null),
    pictures.length > 0
      ? element('div', { class: `scene-pictures of-${pictures.length}` }, figures)
      : element('p', { class: 'no-picture' }, 'no pictures'),
    texts.filter(Boolean).map((text) => note(text)),
  );
}
