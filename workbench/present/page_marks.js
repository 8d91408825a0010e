// Chart.js draws besides the series: bands of uncertainty, levels across the plot, figures at
// bars and steps, and a word where there is nothing to draw. Series and colours: page_series.js.

// The band about a line: its uncertainty, below every series.
const bands = {
  id: 'bands',
  beforeDatasetsDraw(chart) {
    const plot = chart.options.plot, area = chart.chartArea, ctx = chart.ctx;
    const at = (scale, v) => chart.scales[scale].getPixelForValue(v);
    ctx.save();
    ctx.beginPath();
    ctx.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
    ctx.clip();
    plot.series.forEach((series, s) => {
      if (!series.low || !chart.isDatasetVisible(s)) return;
      ctx.fillStyle = tint(chart.data.datasets[s].borderColor, .22);
      const xs = series.x || plot.xs;
      const known = (i) => [series.low[i], series.high[i]]
          .every((v) => v !== null && !isNaN(shown(v, plot.y)));
      for (let i = 0; i < xs.length; ++i) {
        if (!known(i)) continue;
        let end = i;
        while (end + 1 < xs.length && known(end + 1)) ++end;
        ctx.beginPath();
        for (let k = i; k <= end; ++k) ctx.lineTo(at('x', xs[k]), at('y', series.high[k]));
        for (let k = end; k >= i; --k) ctx.lineTo(at('x', xs[k]), at('y', series.low[k]));
        ctx.fill();
        i = end;
      }
    });
    ctx.restore();
  },
};

const lines = {
  id: 'lines',
  afterDatasetsDraw(chart) {
    const plot = chart.options.plot;
    const area = chart.chartArea, ctx = chart.ctx, axis = value_axis(plot);
    ctx.save();
    ctx.strokeStyle = theme.floor;
    ctx.lineWidth = 1.5;
    let dash = -1;
    plot.lines.forEach((line) => {
      if (line.label || dash < 0) ++dash;
      const at = chart.scales[axis].getPixelForValue(line.value);
      const [low, high] = axis === 'x' ? [area.left, area.right] : [area.top, area.bottom];
      if (!(at >= low - 1 && at <= high + 1)) return;
      ctx.setLineDash(DASHES[dash % DASHES.length]);
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
    ctx.fillStyle = theme.soft;
    ctx.fillText('No values to draw', (area.left + area.right) / 2, (area.top + area.bottom) / 2);
    ctx.restore();
  },
};

// Few named values carry their number.
const numbers = {
  id: 'numbers',
  afterDatasetsDraw(chart) {
    const plot = chart.options.plot;
    if (!plot.categories || plot.categories.length > 24) return;
    if (plot.series.length > 1 && plot.kind !== 'bars') return;
    const ctx = chart.ctx, area = chart.chartArea;
    ctx.save();
    ctx.font = '12px ' + Chart.defaults.font.family;
    plot.series.forEach((series, s) => chart.getDatasetMeta(s).data.forEach((element, i) => {
      const value = series.y[i];
      if (value === null || value === undefined || !chart.isDatasetVisible(s)) return;
      const text = number(value, 3);
      const half = ctx.measureText(text).width / 2;
      const x = plot.horizontal ? element.x + half + 6
                                : Math.min(element.x, area.right - half - 2);
      const y = plot.horizontal ? element.y + 4 : element.y - 9;
      ctx.lineWidth = 4;
      ctx.lineJoin = 'round';
      ctx.strokeStyle = theme.paper;
      ctx.strokeText(text, x - half, y);
      ctx.fillStyle = theme.ink;
      ctx.fillText(text, x - half, y);
    }));
    ctx.restore();
  },
};
