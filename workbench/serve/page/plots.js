// Time plots that share zoom and cursor, drawn by uPlot in the colours of the style sheet.
import {trace} from './curves.js';
import {html} from './preact.js';
import {byFinger} from './touch.js';
import uPlot from './uplot.js';

export const colour = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();

const FONT = '12px system-ui, sans-serif';

function axis(label, extra = {}) {
  return {label, stroke: () => colour('soft'), font: FONT, labelFont: FONT, labelSize: 18, size: 58,
          grid: {stroke: () => colour('grid'), width: 1}, ticks: {show: false}, ...extra};
}

/// uPlot's way to draw a series.
function curve(plot, index, from, to) {
  const stroke = new Path2D();
  uPlot.orient(plot, index, (series, xs, ys, x, y, across, up, left, top, width, height) =>
    trace(xs, ys, from, to, (v) => across(v, x, width, left), (v) => up(v, y, height, top),
          (at, high) => stroke.moveTo(at, high), (at, high) => stroke.lineTo(at, high)));
  return {stroke, fill: null, clip: null, band: null, gaps: null, flags: 0};
}

/// Bands of time behind the curves: {spans: [[from, to]], tone, edge}.
function bands(stack) {
  return (plot) => {
    const {ctx, bbox} = plot;
    for (const {spans, tone} of stack.bands) {
      ctx.fillStyle = colour(tone);
      for (const [from, to] of spans) {
        const left = Math.max(plot.valToPos(from, 'x', true), bbox.left);
        const right = Math.min(plot.valToPos(to, 'x', true), bbox.left + bbox.width);
        if (right >= left) ctx.fillRect(left, bbox.top, Math.max(right - left, 1.5), bbox.height);
      }
    }
  };
}

/// Dashed lines at plus and minus a level.
function level(stack, key) {
  return (plot) => {
    const value = stack.levels[key];
    if (!(value > 0)) return;
    const {ctx, bbox} = plot;
    ctx.save();
    ctx.strokeStyle = colour('soft');
    ctx.setLineDash([6, 5]);
    ctx.beginPath();
    for (const at of [value, -value]) {
      const y = plot.valToPos(at, 'y', true);
      if (y < bbox.top || y > bbox.top + bbox.height) continue;
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
    }
    ctx.stroke();
    ctx.restore();
  };
}

/// A line at the level of a trigger, in the plot that has its channel.
function mark(stack, spec) {
  return (plot) => {
    const at = stack.mark;
    if (!at || !spec.series.some((s) => s.key === at.key)) return;
    const {ctx, bbox} = plot;
    const y = plot.valToPos(at.value, 'y', true);
    if (y < bbox.top || y > bbox.top + bbox.height) return;
    ctx.save();
    ctx.strokeStyle = colour('link');
    ctx.setLineDash([2, 4]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.restore();
  };
}

/// Buttons for what the keys do, where there is neither keyboard nor wheel.
export function ZoomButtons({turn, disabled}) {
  return html`<span class="zoom">${[['−', '-', 'zoom out'], ['+', '+', 'zoom in'], ['‹', 'ArrowLeft', 'earlier'],
    ['›', 'ArrowRight', 'later']].map(([sign, key, label]) => html`
      <button aria-label=${label} title=${label} disabled=${disabled} onClick=${() => turn(key)}>${sign}</button>`)}</span>`;
}

/// Plots below each other. specs: [{height, label, level, series: [{key, name, tone, dash, width}]}].
export class PlotStack {
  constructor(element, specs, {onZoom, onBand, xLabel = 'time, s'} = {}) {
    this.element = element;
    this.specs = specs;
    this.bands = [];
    this.levels = {};
    this.mark = null;  // {key, value}
    this.dragMeaning = 'zoom';
    this.shown = false;
    const key = 'stack-' + Math.random();
    this.plots = specs.map((spec, i) => {
      const last = i === specs.length - 1;
      const options = {
        width: element.clientWidth || 600, height: spec.height,
        scales: {x: {time: false}, y: {range: spec.range}},
        legend: {live: true},
        cursor: {sync: {key}, drag: {x: true, y: false, setScale: false}},
        axes: [axis(last ? xLabel : '', {size: 22, labelSize: last ? 16 : 0}),
               axis(spec.label)],
        series: [{label: 'time', value: (u, v) => (v == null ? '' : v.toFixed(3) + ' s')},
                 ...spec.series.map((s) => ({
                   label: s.name, stroke: () => colour(s.tone), width: s.width || 1.5, dash: s.dash, paths: curve,
                   points: {show: false}, spanGaps: false,
                   value: (u, v) => (v == null ? '' : String(+v.toPrecision(4)))}))],
        hooks: {
          drawAxes: [bands(this)],
          draw: [...(spec.level ? [level(this, spec.level)] : []), mark(this, spec)],
          setSelect: [(plot) => {
            if (plot.select.width < 5) return;
            const from = plot.posToVal(plot.select.left, 'x');
            const to = plot.posToVal(plot.select.left + plot.select.width, 'x');
            plot.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
            (this.dragMeaning === 'band' ? onBand : onZoom)(from, to);
          }]},
      };
      return new uPlot(options, [[0, 1], ...spec.series.map(() => [null, null])], element);
    });
    this.sizes = new ResizeObserver(() => {
      const width = element.clientWidth;
      if (width > 0) {
        this.plots.forEach((plot, i) => plot.setSize({width, height: specs[i].height}));
      }
    });
    this.sizes.observe(element);
    // A sheet of A4 between its margins.
    this.print = () => this.plots.forEach((plot, i) => plot.setSize({width: 680, height: specs[i].height}));
    this.printed = () => this.plots.forEach((plot, i) => plot.setSize({width: element.clientWidth || 600,
                                                                        height: specs[i].height}));
    addEventListener('beforeprint', this.print);
    addEventListener('afterprint', this.printed);
    this.theme = matchMedia('(prefers-color-scheme: dark)');
    this.repaint = () => {
      this.plots.forEach((plot, i) => {
        plot.root.querySelectorAll('.u-marker').forEach((marker, k) => {
          if (k > 0) marker.style.borderColor = colour(specs[i].series[k - 1].tone);
        });
        if (this.shown) plot.redraw();
      });
    };
    this.theme.addEventListener('change', this.repaint);
    this.range = null;  // shown, in s
    this.onZoom = onZoom;
    if (onZoom) {
      for (const plot of this.plots) {
        plot.over.addEventListener('dblclick', () => onZoom(null, null));
        byFinger(plot, {range: () => this.range, zoom: onZoom,
                        marks: () => this.dragMeaning === 'band', mark: onBand});
      }
      element.tabIndex = 0;
      element.setAttribute('role', 'group');
      element.setAttribute('aria-label', 'plots over time: arrows move, plus and minus zoom, 0 shows all');
      element.addEventListener('keydown', (e) => {
        if (!e.ctrlKey && !e.metaKey && !e.altKey && this.turn(e.key === '=' ? '+' : e.key)) e.preventDefault();
      });
    }
  }

  /// Moves what is shown as a key does; false: by no such key.
  turn(key) {
    if (!this.range) return false;
    const [from, to] = this.range, part = (to - from) / 4;
    const next = {ArrowLeft: [from - part, to - part], ArrowRight: [from + part, to + part],
                  '+': [from + part, to - part], '-': [from - 2 * part, to + 2 * part],
                  0: [null, null]}[key];
    if (next) this.onZoom(...next);
    return Boolean(next);
  }

  /// columns: {t, KEY: [...]}; a missing key is an empty curve. `count`: the first so many plots.
  show(columns, from, to, count = this.plots.length) {
    const empty = columns.t.map(() => null);
    this.shown = true;
    this.range = [from, to];
    this.element.dataset.shown = from + ':' + to;
    this.plots.slice(0, count).forEach((plot, i) => {
      const data = [columns.t, ...this.specs[i].series.map((s) => columns[s.key] || empty)];
      plot.batch(() => {
        plot.setData(data, false);
        this.specs[i].series.forEach((s, k) => {
          const there = Boolean(columns[s.key]);
          if (plot.series[k + 1].show !== there) plot.setSeries(k + 1, {show: there});
        });
        plot.setScale('x', {min: from, max: to});
      });
      // What the cursor points to has moved; uPlot looks only whether another sample is there.
      const {left, top} = plot.cursor;
      if (!(left >= 0)) return;
      plot.setCursor({left: -10, top: -10}, false, false);
      plot.setCursor({left, top}, true, false);
    });
  }

  /// Another name for a curve in the legend.
  rename(i, key, name) {
    const at = this.specs[i].series.findIndex((s) => s.key === key) + 1;
    const label = this.plots[i].root.querySelectorAll('.u-series')[at].querySelector('.u-label');
    if (label && label.textContent !== name) label.textContent = name;
  }

  label(i, text) {
    this.plots[i].axes[1].label = text;
  }

  end() {
    this.sizes.disconnect();
    removeEventListener('beforeprint', this.print);
    removeEventListener('afterprint', this.printed);
    this.theme.removeEventListener('change', this.repaint);
    this.plots.forEach((plot) => plot.destroy());
  }
}
