// Laws of the model as curves with the record's samples beside them: an SVG each, so that they print.
import {html, useEffect, useState} from './preact.js';
import {post} from './server.js';

const WIDE = 520, NARROW = 300, HEIGHT = 280, LEFT = 62, RIGHT = 10, TOP = 10, BOTTOM = 40;

/// Round numbers within the range, about `count` of them.
export function ticks(low, high, count = 6) {
  const rough = (high - low) / count;
  if (!(rough > 0) || !Number.isFinite(rough)) return [];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= rough);
  const out = [];
  for (let i = Math.ceil(low / step); i * step <= high * (1 + 1e-12); ++i) out.push(+(i * step).toPrecision(10));
  return out;
}

/// Least and greatest of the numbers with a margin; null without one.
export function range(...lists) {
  let low = Infinity, high = -Infinity;
  for (const list of lists) {
    for (const v of list) {
      if (v == null) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  }
  if (!(low <= high)) return null;
  const margin = 0.04 * (high - low) || Math.abs(high) || 1;
  return [low - margin, high + margin];
}

/// A path through the points; a missing one is a gap.
export function path({x, y}, across, up) {
  let text = '', pen = 'M';
  x.forEach((v, i) => {
    if (v == null || y[i] == null) { pen = 'M'; return; }
    text += pen + across(v).toFixed(1) + ' ' + up(y[i]).toFixed(1);
    pen = 'L';
  });
  return text;
}

/// The area between two curves; without one of them nothing.
function area(x, low, high, across, up) {
  const known = x.map((v, i) => i).filter((i) => low[i] != null && high[i] != null);
  if (known.length < 2) return '';
  const point = (i, list) => across(x[i]).toFixed(1) + ' ' + up(list[i]).toFixed(1);
  return 'M' + [...known.map((i) => point(i, high)), ...known.reverse().map((i) => point(i, low))].join('L') + 'Z';
}

/// law: {title, note, x, y, model} and where there are some samples, mean, before, low and high, a band
/// about the model. narrow: for a column at the side, whose text is then as large as elsewhere.
export function Law({law, beside, narrow}) {
  const WIDTH = narrow ? NARROW : WIDE;
  const lists = [law.model, law.mean, law.before, law.samples].filter(Boolean);
  const xs = range(...lists.map((one) => one.x));
  const ys = range(...lists.map((one) => one.y), law.low || [], law.high || []);
  if (!xs || !ys) return null;
  const across = (v) => LEFT + (v - xs[0]) / (xs[1] - xs[0]) * (WIDTH - LEFT - RIGHT);
  const up = (v) => HEIGHT - BOTTOM - (v - ys[0]) / (ys[1] - ys[0]) * (HEIGHT - TOP - BOTTOM);
  const none = {x: [], y: []}, samples = law.samples || none, mean = law.mean || none;
  const dots = samples.x.map((v, i) => (samples.y[i] == null ? ''
    : `M${across(v).toFixed(1)} ${up(samples.y[i]).toFixed(1)}h0`)).join('');
  const keys = [['dot', 'samples', samples.x.length], ['mean', 'their mean', mean.x.length],
                ['before', beside || 'model before', law.before], ['model', law.key || 'model', true],
                ['band', 'two standard errors', law.low]].filter((k) => k[2]);
  return html`
    <figure class="law-curve">
      <figcaption><b>${law.title}</b> <small>${law.note}</small></figcaption>
      <svg viewBox=${`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label=${law.title}>
        ${ticks(...xs, narrow ? 4 : 6).map((v) => html`
          <line class=${v === 0 ? 'zero' : 'grid'} x1=${across(v)} x2=${across(v)} y1=${TOP} y2=${HEIGHT - BOTTOM} />
          <text x=${across(v)} y=${HEIGHT - BOTTOM + 15} text-anchor="middle">${v}</text>`)}
        ${ticks(...ys).map((v) => html`
          <line class=${v === 0 ? 'zero' : 'grid'} x1=${LEFT} x2=${WIDTH - RIGHT} y1=${up(v)} y2=${up(v)} />
          <text x=${LEFT - 6} y=${up(v) + 4} text-anchor="end">${v}</text>`)}
        <text x=${(LEFT + WIDTH - RIGHT) / 2} y=${HEIGHT - 6} text-anchor="middle">${law.x}</text>
        <text transform=${`translate(13 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`}
              text-anchor="middle">${law.y}</text>
        ${law.low && html`<path class="band" d=${area(law.model.x, law.low, law.high, across, up)} />`}
        <path class="dots" d=${dots} />
        ${law.before && html`<path class="before" d=${path(law.before, across, up)} />`}
        <path class="mean" d=${path(mean, across, up)} />
        <path class="model" d=${path(law.model, across, up)} />
      </svg>
      <p class="keys">${keys.map(([kind, text]) => html`<span class=${kind}>${text}</span>`)}</p>
    </figure>`;
}

export function Laws({state}) {
  const [open, setOpen] = useState(false);
  const [got, set] = useState({laws: []});
  useEffect(() => {
    if (!open || !state.shown) return undefined;
    let newest = true;
    post('laws').then((answer) => { if (newest) set(answer); })
      .catch((error) => { if (newest) set({laws: [], error: error.message}); });
    return () => { newest = false; };
  }, [open, state]);
  if (!state.shown) return null;
  return html`
    <details class="laws" open=${open} onToggle=${(e) => setOpen(e.target.open)}>
      <summary>Laws of the model as curves</summary>
      ${got.error && html`<p class="warn">${got.error}</p>`}
      <div class="law-curves">${got.laws.map((law) => html`<${Law} key=${law.title} law=${law}
        beside=${state.beside && state.beside.model} />`)}</div>
    </details>`;
}
