// The samples of the last minutes as the live page keeps them. A server's batch is {t0, t, KEY: [...]},
// times in s after t0; one of its history also says whether it begins one, and how far that reaches.
// A channel that a batch lacks is missing in its samples.

const KEPT_S = 120;
const SAME_S = 1e-4;  // times of two batches differ by their rounding

/// Samples of the last KEPT_S seconds, oldest first, in arrays that are as large as the rate needs and
/// then stay: a missing value is NaN in them, and null in what part() returns.
export class Ring {
  constructor() {
    this.kept = {t: new Float64Array(4096)};
    this.clear();
  }
  clear() { this.begin = this.end = 0; }
  get length() { return this.end - this.begin; }
  get newest() { return this.length ? this.kept.t[this.end - 1] : -Infinity; }
  get oldest() { return this.length ? this.kept.t[this.begin] : Infinity; }

  /// A batch that came as it was measured. False where the clock went back: what came before is gone.
  samples(batch) {
    const goes_on = !batch.t.length || batch.t0 + batch.t[0] > this.newest - SAME_S;
    if (!goes_on) this.clear();
    this.add(batch, 0);
    return goes_on;
  }
  /// A batch of what the server has kept: it fills what this page has missed, as far as it reaches.
  history(batch) {
    const goes_on = !batch.begins || batch.newest > this.newest - SAME_S;
    if (!goes_on) this.clear();
    if (batch.begins && batch.t.length && this.length && batch.t0 + batch.t[0] > this.newest) this.gap();
    const newest = this.newest;
    const from = batch.t.findIndex((t) => batch.t0 + t > newest);
    if (from >= 0) this.add(batch, from);
    return goes_on;
  }
  add(batch, from) {
    for (const key of Object.keys(batch)) {
      if (Array.isArray(batch[key]) && !this.kept[key]) {
        this.kept[key] = new Float64Array(this.kept.t.length).fill(NaN);
      }
    }
    for (let i = from; i < batch.t.length; ++i) this.push(batch.t0 + batch.t[i], batch, i);
  }
  push(t, batch, i) {
    if (this.end === this.kept.t.length) this.make_room();
    for (const key in this.kept) this.kept[key][this.end] = batch[key]?.[i] ?? NaN;
    this.kept.t[this.end] = t;
    ++this.end;
  }
  /// Moves what is kept to the front of the arrays, of larger ones where it fills most of them.
  make_room() {
    this.begin = this.first(this.newest - KEPT_S);
    const {begin, end, length} = this, larger = length > 0.7 * end;
    for (const [key, old] of Object.entries(this.kept)) {
      if (larger) {
        this.kept[key] = new Float64Array(2 * old.length);
        this.kept[key].set(old.subarray(begin, end));
      } else {
        old.copyWithin(0, begin, end);
      }
    }
    this.begin = 0;
    this.end = length;
  }
  /// A missing sample: the curves have a gap here.
  gap() {
    if (this.length) this.push(this.newest + 1e-6, {}, 0);
  }
  /// Place in the arrays of the first sample not before `t`.
  first(t) {
    let low = this.begin, high = this.end;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.kept.t[middle] < t) low = middle + 1; else high = middle;
    }
    return low;
  }
  /// Times and these channels from one to the other, and one more to either side, so that lines reach
  /// the edges.
  part(from, to, keys) {
    const a = Math.max(this.begin, this.first(from) - 1), b = Math.min(this.end, this.first(to) + 1);
    const out = {};
    for (const key of ['t', ...keys]) {
      const kept = this.kept[key], values = new Array(b - a);
      for (let i = a; i < b; ++i) values[i - a] = kept && kept[i] === kept[i] ? kept[i] : null;
      out[key] = values;
    }
    return out;
  }
}
