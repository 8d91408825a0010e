// How values read and how series look: numbers, colours, the sets that Chart.js draws.

// Okabe and Ito's colours, told apart with any colour vision; lighter ones of the same hues on a
// dark screen. Paper is white.
const THEMES = {
  light: {
    ink: '#16202b', soft: '#55616e', grid: '#e8ecf1', frame: '#b6c0cb', floor: '#b3261e',
    paper: '#ffffff',
    tones: {measured: '#16202b', model: '#0072b2', residual: '#d55e00', improved: '#009e73',
            accent: '#b0578d', muted: '#9aa5b1'},
  },
  dark: {
    ink: '#e3e8ee', soft: '#a4b0bd', grid: '#26303b', frame: '#55616e', floor: '#ff8a80',
    paper: '#11171d',
    tones: {measured: '#f2f5f8', model: '#56b4e9', residual: '#ff9d4d', improved: '#2fcf9f',
            accent: '#e08fc0', muted: '#7d8a98'},
  },
};
const screen_is_dark = matchMedia('(prefers-color-scheme: dark)');
let theme = THEMES[screen_is_dark.matches ? 'dark' : 'light'];
const CYCLE = ['model', 'residual', 'improved', 'accent', 'measured', 'muted'];
const DASHES = [[7, 4], [2, 3], [12, 4, 2, 4]];

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
  const all = series.y.map((y, i) => ({x: shown(x[i], plot.x), y: shown(y, plot.y)}));
  if (series.kind !== 'scatter') return all;
  // Chart.js takes the first and the last point for the ends of the axis.
  return all.filter((p) => !isNaN(p.x) && !isNaN(p.y)).sort((a, b) => a.x - b.x);
};

// Curves lie above bars, bars above clouds, later series above earlier ones.
function dataset(plot, series, index) {
  const tone = series.tone === 'automatic' ? CYCLE[index % CYCLE.length] : series.tone;
  const colour = theme.tones[tone];
  const base = {label: series.name, borderColor: colour, backgroundColor: colour};
  const count = series.y.length;
  if (plot.categories) base.data = series.y.map((y) => shown(y, plot.y));
  else base.data = points(plot, series);
  if (series.kind === 'bars') {
    return {...base, type: 'bar', backgroundColor: tint(colour, .8), borderWidth: 0,
            grouped: false, skipNull: true, maxBarThickness: plot.horizontal ? 16 : 46, categoryPercentage: .8,
            barPercentage: plot.categories ? .9 : 1, minBarLength: 5, order: 200};
  }
  if (series.kind === 'scatter') {
    return {...base, type: 'scatter', showLine: false, borderWidth: 0, order: 300 - index,
            backgroundColor: tint(colour, count > 1000 ? .28 : count > 200 ? .5 : .85),
            radius: count > 1000 ? 1.6 : count > 200 ? 2.2 : 3.5, pointStyle: 'circle'};
  }
  return {...base, type: 'line', borderWidth: count > 60 ? (tone === 'measured' ? 2.6 : 1.3) : 2,
          stepped: series.kind === 'steps' ? 'before' : false,
          borderDash: series.dashed ? [6, 4] : [], tension: 0,
          pointRadius: count > 60 ? 0 : plot.categories ? 3.5 : 2,
          pointHoverRadius: 4, pointHitRadius: 6, spanGaps: false, order: 100 - index};
}

// The axis of values: y, or x where bars lie.
const value_axis = (plot) => (plot.horizontal ? 'x' : 'y');
