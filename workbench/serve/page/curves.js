// The way of a pen along samples, with no more strokes than can be seen: of each column of pixels the
// first, lowest, highest and last sample, and of these none that the line without it misses by less than
// TOLERANCE_PX. Strokes are what a live picture costs.

export const TOLERANCE_PX = 0.3;

/// Samples from one index to the other; null is a gap. across, up: from a value to pixels; move, line:
/// where the pen is set down, and where it draws to.
export function trace(xs, ys, from, to, across, up, move, line) {
  let down = false, dot = false;  // dot: nothing drawn since the pen was set down
  let x0 = 0, y0 = 0, low = 0, high = 0, x1 = 0, y1 = 0;  // begin of the line, slopes that it may have, its end so far
  const begin = (x, y) => { x0 = x1 = x; y0 = y1 = y; low = -Infinity; high = Infinity; };
  const draw = (x, y) => { line(x, y); dot = false; };
  const take = (x, y) => {
    if (!down) {
      move(x, y);
      begin(x, y);
      down = dot = true;
      return;
    }
    const slope = (y - y0) / (x - x0);
    if (!(slope >= low && slope <= high)) {
      draw(x1, y1);
      begin(x1, y1);
    }
    x1 = x;
    y1 = y;
    const dx = x - x0;
    low = Math.max(low, (y - TOLERANCE_PX - y0) / dx);
    high = Math.min(high, (y + TOLERANCE_PX - y0) / dx);
  };
  const lift = () => {
    if (!down) return;
    if (dot && x1 === x0) draw(x1 + 1, y1); else draw(x1, y1);
    down = false;
  };
  // One column: the samples first to last, of which these are the lowest and the highest.
  let column = NaN, first = 0, last = 0, least = 0, most = 0;
  const flush = () => {
    if (Number.isNaN(column)) return;
    let done = -1;
    for (const i of least < most ? [first, least, most, last] : [first, most, least, last]) {
      if (i <= done) continue;
      take(across(xs[i]), up(ys[i]));
      done = i;
    }
    column = NaN;
  };
  for (let i = from; i <= to; ++i) {
    if (ys[i] == null) {
      flush();
      lift();
      continue;
    }
    const here = Math.floor(across(xs[i]));
    if (here !== column) {
      flush();
      column = here;
      first = least = most = i;
    }
    last = i;
    if (ys[i] < ys[least]) least = i;
    if (ys[i] > ys[most]) most = i;
  }
  flush();
  lift();
}
