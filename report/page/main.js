// The page, made of the report in its two JSON elements.

function readJson(id) {
  return JSON.parse(document.getElementById(id).textContent);
}

function tableSection(table, images, metrics, id) {
  return section(
    id,
    2,
    tableTitle(table),
    scoreSection(table, metrics, id),
    mapSection(table, metrics, id),
    table.smoothness ? smoothnessSection(table, id) : null,
    histogramSection(table, metrics, id),
    lobeSection(table, images, metrics, id),
  );
}

function build() {
  const report = readJson('report');
  const images = readJson('images');
  const main = document.getElementById('content');
  fillHeader(report);
  const parts = [
    verdictSection(report),
    ...report.tables.map((table, i) => tableSection(table, images, report.metrics, `table-${i}`)),
    shadingSection(report.shading),
    paretoSection(report.pareto),
    stabilitySection(report.stability),
    metricSection(report.metrics),
    provenanceSection(report),
  ];
  const heading = (part) => part.querySelector('h2, h3').textContent;
  main.replaceChildren(...parts);
  fillContents(
    parts.map((part) => [
      part.id,
      heading(part),
      [...part.querySelectorAll(':scope > section')].map((inner) => [inner.id, heading(inner)]),
    ]),
  );
  fillFooter(report);
  // only now do the boxes have a width
  redrawNow();
  watchSurroundings();
  document.documentElement.dataset.ready = 'yes';
}

build();
