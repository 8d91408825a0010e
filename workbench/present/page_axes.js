// Axes and reading: scales, the names below a ladder, what hovering shows.

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
    title: {display: Boolean(axis.label), text: heading(axis), color: theme.soft},
    grid: {color: theme.grid, borderColor: theme.frame, tickColor: theme.frame, tickLength: 5},
    ticks: {color: theme.soft, maxRotation: 0, autoSkipPadding: 16},
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
    if (which !== value_axis(plot)) {  // frequencies end where their values do
      const known = plot.series.flatMap((one) => one.x || plot.xs || []).filter((v) => v > 0);
      [common.min, common.max] = [Math.min(...known), Math.max(...known)];
    }
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
  const data = plot.series.flatMap((s) => [...s.y, ...(s.low || []), ...(s.high || [])])
                   .filter((v) => Number.isFinite(v) && !(plot.y.log && v <= 0));
  const levels = plot.lines.map((l) => l.value).filter((v) => !plot.y.log || v > 0);
  const low = Math.min(...extent(data, levels)), high = Math.max(...extent(data, levels));
  if (plot.y.log && Number.isFinite(low)) {
    values.suggestedMin = low / 1.5;
    values.suggestedMax = high * (plot.categories ? 1.9 : 1.2);
  } else if (levels.length || plot.series.some((s) => s.low)) {
    values.suggestedMin = low;
    values.suggestedMax = high;
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
    backgroundColor: tint(theme.paper, .96), titleColor: theme.ink, bodyColor: theme.ink,
    borderColor: theme.frame, borderWidth: 1, padding: 9, boxPadding: 4, usePointStyle: false,
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
