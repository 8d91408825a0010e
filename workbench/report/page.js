// Draws every plot of the page with Chart.js: zoom by dragging, a cursor shared within a group,
// reading by hovering, sharp pictures in print.
'use strict';
(() => {
  const INK = '#16202b', SOFT = '#55616e', GRID = '#e8ecf1', FLOOR = '#b3261e';
  // Okabe and Ito's colours, told apart with any colour vision.
  const TONES = {
    measured: '#16202b', model: '#0072b2', residual: '#d55e00', improved: '#009e73',
    accent: '#b0578d', muted: '#9aa5b1',
  };
  const CYCLE = ['model', 'residual', 'improved', 'accent', 'measured', 'muted'];
  const DASHES = [[7, 4], [2, 3], [12, 4, 2, 4]];
  const PRINT_PX = {full: [690, 225], half: [334, 225]};
  const charts = [];

  // The digits that carry something: no float noise, no trailing zeros, a real minus sign.
  const number = (v, digits) => {
    if (!Number.isFinite(v)) return '–';
    const size = Math.abs(v), value = +v.toPrecision(digits);
    const far = size !== 0 && (size < 1e-4 || size >= 1e7);
    return (far ? value.toExponential() : String(value)).replace(/-/g, '−');
  };
  const with_unit = (v, axis) => number(v, 5) + (axis.unit ? ' ' + axis.unit : '');
  const heading = (axis) => axis.label + (axis.unit ? ' (' + axis.unit + ')' : '');
  const tint = (colour, alpha) => colour + Math.round(alpha * 255).toString(16).padStart(2, '0');

  // A value that the axis cannot show is a gap.
  const shown = (v, axis) => (v === null || (axis.log && v <= 0) ? NaN : v);
  const points = (plot, series) => {
    const x = series.x || plot.xs;
    return series.y.map((y, i) => ({x: shown(x[i], plot.x), y: shown(y, plot.y)}));
  };

  // Curves lie above bars, bars above clouds, later series above earlier ones.
  function dataset(plot, series, index) {
    const tone = series.tone === 'automatic' ? CYCLE[index % CYCLE.length] : series.tone;
    const colour = TONES[tone];
    const base = {label: series.name, borderColor: colour, backgroundColor: colour};
    const count = series.y.length;
    if (plot.categories) base.data = series.y.map((y) => shown(y, plot.y));
    else base.data = points(plot, series);
    if (series.kind === 'bars') {
      return {...base, type: 'bar', backgroundColor: tint(colour, .8), borderWidth: 0,
              maxBarThickness: plot.horizontal ? 16 : 46, categoryPercentage: .8,
              barPercentage: plot.categories ? .9 : 1, minBarLength: 2, order: 200};
    }
    if (series.kind === 'scatter') {
      return {...base, type: 'scatter', showLine: false, borderWidth: 0, order: 300 - index,
              backgroundColor: tint(colour, count > 1000 ? .28 : count > 200 ? .5 : .85),
              radius: count > 1000 ? 1.6 : count > 200 ? 2.2 : 3.5, pointStyle: 'circle'};
    }
    return {...base, type: 'line', borderWidth: count > 60 ? (tone === 'measured' ? 2.2 : 1.3) : 2,
            stepped: series.kind === 'steps' ? 'before' : false,
            borderDash: series.dashed ? [6, 4] : [], tension: 0,
            pointRadius: count > 60 ? 0 : plot.categories ? 3.5 : 2,
            pointHoverRadius: 4, pointHitRadius: 6, spanGaps: false, order: 100 - index};
  }

  // The axis of values: y, or x where bars lie.
  const value_axis = (plot) => (plot.horizontal ? 'x' : 'y');

  const lines = {
    id: 'lines',
    afterDatasetsDraw(chart) {
      const plot = chart.options.plot;
      const area = chart.chartArea, ctx = chart.ctx, axis = value_axis(plot);
      ctx.save();
      ctx.strokeStyle = FLOOR;
      ctx.lineWidth = 1.5;
      plot.lines.forEach((line, i) => {
        const at = chart.scales[axis].getPixelForValue(line.value);
        const [low, high] = axis === 'x' ? [area.left, area.right] : [area.top, area.bottom];
        if (!(at >= low - 1 && at <= high + 1)) return;
        ctx.setLineDash(DASHES[i % DASHES.length]);
        ctx.beginPath();
        if (axis === 'x') {
          ctx.moveTo(at, area.top);
          ctx.lineTo(at, area.bottom);
        } else {
          ctx.moveTo(area.left, at);
          ctx.lineTo(area.right, at);
        }
        ctx.stroke();
      });
      ctx.restore();
    },
  };

  const empty = {
    id: 'empty',
    afterDraw(chart) {
      if (chart.options.plot.series.some((s) => s.y.some((v) => v !== null))) return;
      const area = chart.chartArea, ctx = chart.ctx;
      ctx.save();
      ctx.textAlign = 'center';
      ctx.fillStyle = SOFT;
      ctx.fillText('No values to draw', (area.left + area.right) / 2, (area.top + area.bottom) / 2);
      ctx.restore();
    },
  };

  // Few named values carry their number.
  const numbers = {
    id: 'numbers',
    afterDatasetsDraw(chart) {
      const plot = chart.options.plot;
      if (!plot.categories || plot.categories.length > 24 || plot.series.length > 1) return;
      const ctx = chart.ctx, area = chart.chartArea;
      ctx.save();
      ctx.font = '12px ' + Chart.defaults.font.family;
      chart.getDatasetMeta(0).data.forEach((element, i) => {
        const value = plot.series[0].y[i];
        if (value === null) return;
        const text = number(value, 3);
        const half = ctx.measureText(text).width / 2;
        const x = plot.horizontal ? element.x + half + 6
                                  : Math.min(element.x, area.right - half - 2);
        const y = plot.horizontal ? element.y + 4 : element.y - 9;
        ctx.lineWidth = 4;
        ctx.lineJoin = 'round';
        ctx.strokeStyle = '#fff';
        ctx.strokeText(text, x - half, y);
        ctx.fillStyle = INK;
        ctx.fillText(text, x - half, y);
      });
      ctx.restore();
    },
  };

  // A name in lines of about so many letters, broken at blanks and behind underscores.
  function wrapped(name, letters) {
    const rows = [''];
    for (const part of name.match(/[^ _]*[ _]?/g)) {
      const row = rows[rows.length - 1];
      if (row.length > 1 && row.trim() !== '+' && (row + part).trim().length > letters) {
        rows.push(part);
      } else {
        rows[rows.length - 1] = row + part;
      }
    }
    return rows.map((row) => row.trim()).filter(Boolean);
  }

  function scale(plot, which) {
    const axis = (which === value_axis(plot)) ? plot.y : plot.x;
    const common = {
      title: {display: Boolean(axis.label), text: heading(axis), color: SOFT},
      grid: {color: GRID, borderColor: '#b6c0cb', tickColor: '#b6c0cb', tickLength: 5},
      ticks: {color: SOFT, maxRotation: 0, autoSkipPadding: 16},
    };
    if (plot.categories && which !== value_axis(plot)) {
      common.ticks.autoSkip = !plot.horizontal && plot.categories.length > 12;
      if (!plot.horizontal) {
        common.ticks.callback = function(i) {
          return wrapped(plot.categories[i], this.width / plot.categories.length / 7);
        };
      }
      return {...common, type: 'category', grid: {...common.grid, display: false}, offset: true};
    }
    const text = (v) => number(v, 10);
    if (axis.log) {
      common.ticks.callback = function(v) {
        const few = this.max / this.min < 300;
        const lead = +(v / 10 ** Math.floor(Math.log10(v) + 1e-9)).toFixed(6);
        return lead === 1 || (few && (lead === 2 || lead === 5)) ? text(v) : null;
      };
      common.ticks.autoSkip = false;
      return {...common, type: 'logarithmic', grace: 0};
    }
    common.ticks.callback = text;
    common.ticks.includeBounds = false;
    common.ticks.maxTicksLimit = which === 'y' ? 7 : 13;
    return {...common, type: 'linear', beginAtZero: plot.kind === 'bars'};
  }

  function scales(plot) {
    const both = {x: scale(plot, 'x'), y: scale(plot, 'y')};
    const values = both[value_axis(plot)];
    const data = plot.series.flatMap((s) => s.y)
                     .filter((v) => Number.isFinite(v) && !(plot.y.log && v <= 0));
    const levels = plot.lines.map((l) => l.value).filter((v) => !plot.y.log || v > 0);
    const low = Math.min(...extent(data, levels)), high = Math.max(...extent(data, levels));
    if (plot.y.log && Number.isFinite(low)) {
      values.suggestedMin = low / 1.5;
      values.suggestedMax = high * (plot.categories ? 1.9 : 1.2);
    } else if (levels.length) {
      values.suggestedMin = Math.min(...levels);
      values.suggestedMax = Math.max(...levels);
    }
    if (plot.categories && !plot.y.log) values.grace = '12%';
    return both;
  }

  const extent = (data, more) => {
    let low = Infinity, high = -Infinity;
    for (const v of data) {
      if (v < low) low = v;
      if (v > high) high = v;
    }
    return [low, high, ...more];
  };

  function hover(plot) {
    const shared = !plot.categories && plot.series.every((s) => !s.x) && plot.kind !== 'scatter';
    return plot.categories || shared ? {mode: 'index', intersect: false}
                                     : {mode: 'nearest', intersect: false, axis: 'xy'};
  }

  function tooltip(plot) {
    return {
      backgroundColor: 'rgba(255,255,255,.96)', titleColor: INK, bodyColor: INK,
      borderColor: '#c5ced8', borderWidth: 1, padding: 9, boxPadding: 4, usePointStyle: false,
      boxWidth: 10, boxHeight: 10,
      itemSort: (a, b) => a.datasetIndex - b.datasetIndex,
      callbacks: {
        title: (items) => {
          if (!items.length) return '';
          if (plot.categories) return plot.categories[items[0].dataIndex];
          return plot.x.label + ' ' + with_unit(items[0].parsed.x, plot.x);
        },
        label: (item) => (item.dataset.label || plot.y.label) + ': ' +
            with_unit(item.parsed[value_axis(plot)], plot.y),
      },
    };
  }

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
      plugins: [lines, numbers, empty],
    });
    charts.push(chart);
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
    plot.lines.forEach((line, i) => add('span', i % 3 === 1 ? 'dotted' : 'dashed', FLOOR,
                                        line.label + ' ' + with_unit(line.value, plot.y)));
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
    [options.min, options.max] = range || [undefined, undefined];
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

  // Print: the column of an A4 page, and more pixels.
  addEventListener('beforeprint', () => {
    for (const chart of charts) {
      const half = chart.canvas.closest('figure').classList.contains('half');
      const [width, height] = PRINT_PX[half ? 'half' : 'full'];
      chart.options.devicePixelRatio = 2.5;
      const plot = chart.options.plot;
      chart.resize(width, plot.horizontal ? Math.min(70 + 18 * plot.categories.length, 880) : height);
    }
  });
  addEventListener('afterprint', () => {
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
})();
