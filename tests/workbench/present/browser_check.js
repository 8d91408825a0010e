// Added to a report by the browser test: looks at every canvas, zooms, hovers and prints, and leaves
// what it saw as JSON in <pre id="check">.
'use strict';
const seen = {errors: [], plots: [], cut: []};
addEventListener('unhandledrejection', (event) => seen.errors.push(String(event.reason)));
addEventListener('error', (event) => seen.errors.push(event.message));
addEventListener('securitypolicyviolation', (event) => seen.errors.push(event.violatedDirective));

// Pixels in the colour of the series, whatever their opacity.
function inked(canvas, colour) {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] > 20 && Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) +
        Math.abs(data[i + 2] - b) < 40) ++count;
  }
  return count;
}

const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const canvases = [...document.querySelectorAll('canvas')];
const chart = (i) => Chart.getChart(canvases[i]);
const range = (i) => [chart(i).scales.x.min, chart(i).scales.x.max];

function send(i, type, x, y, Kind) {
  const box = canvases[i].getBoundingClientRect();
  canvases[i].dispatchEvent(new Kind(type, {clientX: box.left + x, clientY: box.top + y, button: 0,
                                            pointerId: 1, bubbles: true}));
}

function drag(i, from, to) {
  const scales = chart(i).scales;
  const place = ([x, y]) => [scales.x.getPixelForValue(x), scales.y.getPixelForValue(y)];
  HTMLCanvasElement.prototype.setPointerCapture = () => {};  // no real pointer is down
  send(i, 'pointerdown', ...place(from), PointerEvent);
  send(i, 'pointermove', ...place(to), PointerEvent);
  send(i, 'pointerup', ...place(to), PointerEvent);
}

// Names the plots whose axes end before their values do.
function cut(chart) {
  const plot = chart.options.plot;
  const outside = (value, scale) => Number.isFinite(value) &&
      !(scale.type === 'logarithmic' && value <= 0) &&
      (value < scale.min - 1e-9 || value > scale.max + 1e-9);
  for (const series of plot.series) {
    const values = plot.horizontal ? chart.scales.x : chart.scales.y;
    const xs = plot.categories ? [] : series.x || plot.xs;
    if (series.y.some((v) => v !== null && outside(v, values)) ||
        xs.some((v, i) => v !== null && series.y[i] !== null && outside(v, chart.scales.x))) {
      seen.cut.push(plot.title + ': ' + series.name);
    }
  }
}

async function look() {
  for (const canvas of canvases) {
    const sets = Chart.getChart(canvas).data.datasets;
    seen.plots.push(sets.map((set) => inked(canvas, set.borderColor)));
    cut(Chart.getChart(canvas));
  }
  seen.declared = +document.body.dataset.plots;
  seen.drawn = +document.body.dataset.drawn;
  seen.width = document.documentElement.scrollWidth;
}

async function use() {
  seen.before = [range(0), range(1)];
  drag(0, [12, 0], [18, 0]);
  seen.zoomed = [range(0), range(1), range(2)];
  canvases[1].dispatchEvent(new MouseEvent('dblclick', {bubbles: true}));
  seen.reset = [range(0), range(1)];
  drag(3, [-50, -10], [50, 10]);
  seen.cloud = [...range(3), chart(3).scales.y.min, chart(3).scales.y.max];
  send(1, 'mousemove', chart(1).scales.x.getPixelForValue(15), 100, MouseEvent);
  await wait(300);
  const tooltip = chart(1).tooltip;
  seen.tooltip = [...tooltip.title, ...tooltip.body.flatMap((part) => part.lines)];
  const name = canvases[0].closest('figure').querySelector('button');
  name.click();
  seen.hidden = [chart(0).isDatasetVisible(0), chart(0).isDatasetVisible(1)];
  name.click();
  const widths = () => canvases.map((canvas) => parseInt(canvas.style.width, 10));
  seen.shown = widths();
  dispatchEvent(new Event('beforeprint'));
  seen.printed = widths();
  dispatchEvent(new Event('afterprint'));
  seen.again = widths();
}

addEventListener('load', async () => {
  await wait(100);
  await look().then(USE ? use : () => 0).catch((error) => seen.errors.push(String(error)));
  const result = document.body.appendChild(document.createElement('pre'));
  result.id = 'check';
  result.textContent = JSON.stringify(seen);
});
