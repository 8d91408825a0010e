// Draws every plot of the page with Chart.js: zoom by dragging, a cursor shared within a group,
// sharp pictures in print. Runs in one function with page_series.js, page_marks.js, page_axes.js.

const PRINT_PX = {full: [690, 160], half: [334, 170]};
const charts = [];

function draw(canvas, plot) {
  const chart = new Chart(canvas, {
    data: {labels: plot.categories, datasets: plot.series.map((s, i) => dataset(plot, s, i))},
    options: {
      plot, animation: false, parsing: plot.categories ? undefined : false, normalized: true,
      maintainAspectRatio: false, indexAxis: plot.horizontal ? 'y' : 'x', scales: scales(plot),
      layout: {padding: {top: plot.categories && !plot.horizontal ? 14 : 4, right: 10}},
      interaction: hover(plot),
      plugins: {
        legend: {display: false},
        tooltip: tooltip(plot),
      },
    },
    plugins: [bands, lines, numbers, empty],
  });
  charts.push(chart);
  chart.keys = [];
  chart.home = {};
  for (const axis of ['x', 'y']) {
    const {min, max} = chart.config.options.scales[axis];
    chart.home[axis] = [min, max];
  }
  legend(chart, plot);
  if (!plot.categories) follow(chart, plot);
}

// Names beside the title: a click hides a series. A lone series is named by the axis already.
function legend(chart, plot) {
  const list = document.createElement('ul');
  const add = (tag, look, colour, text) => {
    const item = list.appendChild(document.createElement('li'));
    const name = item.appendChild(document.createElement(tag));
    const key = name.appendChild(document.createElement('i'));
    key.className = look;
    key.style.color = colour;
    chart.keys.push(key);
    name.append(text);
    return name;
  };
  if (plot.series.length > 1) {
    plot.series.forEach((series, i) => {
      const look = series.dashed ? 'dashed' : series.kind === 'steps' ? 'line' : series.kind;
      const button = add('button', look, chart.data.datasets[i].borderColor, series.name);
      button.setAttribute('aria-pressed', 'true');
      button.addEventListener('click', () => {
        const visible = !chart.isDatasetVisible(i);
        chart.setDatasetVisibility(i, visible);
        chart.update('none');
        button.setAttribute('aria-pressed', String(visible));
      });
    });
  }
  plot.lines.filter((line) => line.label).forEach((line, i) => {
    const small = plot.y.unit === 'mm' && Math.abs(line.value) < .01;
    const value = small ? number(1000 * line.value, 3) + ' µm'
                        : number(line.value, 3) + (plot.y.unit ? ' ' + plot.y.unit : '');
    add('span', i % 3 === 1 ? 'dotted' : 'dashed', theme.floor, line.label + ' ' + value);
  });
  if (list.children.length) chart.canvas.closest('figure').querySelector('.head').append(list);
}

const members = (chart, plot) =>
    plot.group ? charts.filter((c) => c.options.plot.group === plot.group) : [chart];

function child(chart, tag, name) {
  const element = document.createElement(tag);
  element.className = name;
  chart.canvas.parentNode.appendChild(element);
  return element;
}

function set_range(chart, axis, range) {
  const options = chart.options.scales[axis];
  [options.min, options.max] = range || chart.home[axis];
}

function apply(chart, x, y) {
  set_range(chart, 'x', x);
  set_range(chart, 'y', y);
  chart.update('none');
  chart.reset_button.style.display = x || y ? 'block' : 'none';
  chart.reset_button.style.top = chart.chartArea.top + 6 + 'px';
}

function show_cursor(chart, value) {
  const at = value === null ? NaN : chart.scales.x.getPixelForValue(value);
  const area = chart.chartArea, style = chart.cursor_line.style;
  const inside = at >= area.left && at <= area.right;
  style.display = inside ? 'block' : 'none';
  if (inside) {
    style.left = at + 'px';
    style.top = area.top + 'px';
    style.height = area.bottom - area.top + 'px';
  }
}

// Cursor, zoom by dragging (x, and y too where points are scattered), reset by double click.
function follow(chart, plot) {
  const canvas = chart.canvas, both = plot.kind === 'scatter';
  chart.cursor_line = child(chart, 'div', 'cursor');
  const box = child(chart, 'div', 'zoom').style;
  chart.reset_button = child(chart, 'button', 'reset');
  chart.reset_button.textContent = 'Show all';
  let start = null;
  const place = (event) => {
    const rect = canvas.getBoundingClientRect(), area = chart.chartArea;
    return {x: Math.min(Math.max(event.clientX - rect.left, area.left), area.right),
            y: Math.min(Math.max(event.clientY - rect.top, area.top), area.bottom)};
  };
  const reset = () => members(chart, plot).forEach((c) => apply(c));
  canvas.style.cursor = 'crosshair';
  canvas.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || event.offsetY < chart.chartArea.top) return;
    start = place(event);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', (event) => {
    const here = place(event);
    const value = chart.scales.x.getValueForPixel(here.x);
    if (!both) members(chart, plot).forEach((c) => show_cursor(c, value));
    if (!start) return;
    const area = chart.chartArea;
    const top = both ? Math.min(start.y, here.y) : area.top;
    const height = both ? Math.abs(here.y - start.y) : area.bottom - area.top;
    Object.assign(box, {display: 'block', left: Math.min(start.x, here.x) + 'px', top: top + 'px',
                        width: Math.abs(here.x - start.x) + 'px', height: height + 'px'});
  });
  const end = (event) => {
    if (!start) return;
    const from = start, to = place(event), drawn = event.type === 'pointerup';
    start = null;
    box.display = 'none';
    if (!drawn || Math.abs(to.x - from.x) < 6 || (both && Math.abs(to.y - from.y) < 6)) return;
    const range = (axis) => [from[axis], to[axis]]
        .map((pixel) => chart.scales[axis].getValueForPixel(pixel)).sort((a, b) => a - b);
    const x = range('x'), y = both ? range('y') : undefined;
    members(chart, plot).forEach((c) => apply(c, x, y));
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('pointerleave',
                          () => members(chart, plot).forEach((c) => show_cursor(c, null)));
  canvas.addEventListener('dblclick', reset);
  chart.reset_button.addEventListener('click', reset);
}

// Another theme: colours alone change, zoom and hidden series stay.
function repaint(name) {
  theme = THEMES[name];
  for (const chart of charts) {
    const plot = chart.options.plot, before = chart.options.scales;
    const ranges = ['x', 'y'].map((axis) => [before[axis].min, before[axis].max]);
    plot.series.forEach((series, i) => {
      const {data, ...look} = dataset(plot, series, i);
      Object.assign(chart.data.datasets[i], look);
    });
    const after = scales(plot);
    ['x', 'y'].forEach((axis, i) => [after[axis].min, after[axis].max] = ranges[i]);
    chart.options.scales = after;
    chart.options.plugins.tooltip = tooltip(plot);
    const named = plot.series.length > 1 ? plot.series.length : 0;
    chart.keys.forEach((key, i) => {
      key.style.color = i < named ? chart.data.datasets[i].borderColor : theme.floor;
    });
    chart.update('none');
  }
}
const repaint_screen = () => repaint(screen_is_dark.matches ? 'dark' : 'light');
screen_is_dark.addEventListener('change', repaint_screen);

// Print: black on white, the column of an A4 page, and more pixels.
addEventListener('beforeprint', () => {
  repaint('light');
  for (const chart of charts) {
    const half = chart.canvas.closest('figure').classList.contains('half');
    const [width, height] = PRINT_PX[half ? 'half' : 'full'];
    chart.options.devicePixelRatio = 2.5;
    const plot = chart.options.plot;
    const bars = plot.horizontal ? 70 + 18 * plot.categories.length : height;
    chart.resize(width, Math.min(bars, 880));
  }
});
addEventListener('afterprint', () => {
  repaint_screen();
  for (const chart of charts) {
    delete chart.options.devicePixelRatio;
    chart.resize();
  }
});

Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.font.size = 12;
JSON.parse(document.getElementById('data').textContent).forEach((plot, i) => {
  const canvas = document.getElementById('plot-' + i);
  try {
    draw(canvas, plot);
  } catch (error) {
    console.error(error);
    const failed = document.createElement('p');
    failed.className = 'failed';
    failed.textContent = 'This plot could not be drawn: ' + error.message;
    canvas.replaceWith(failed);
  }
});
document.body.dataset.drawn = charts.length;
