// The samples of the last minutes as the live page keeps them. A server's batch is {t0, t, KEY: [...]},
// times in s after t0; one of its history also says whether it begins one, and how far that reaches.

export const KEYS = ['reference', 'y', 'u', 'error'];
const KEPT_S = 120;
const SAME_S = 1e-4;  // times of two batches differ by their rounding

/// Samples of the last KEPT_S seconds, oldest first.
export class Ring {
  constructor() { this.clear(); }
  clear() {
    this.t = [];
    for (const key of KEYS) this[key] = [];
  }
  get newest() { return this.t.length ? this.t[this.t.length - 1] : -Infinity; }

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
    if (batch.begins && batch.t.length && this.t.length && batch.t0 + batch.t[0] > this.newest) this.gap();
    const newest = this.newest;
    const from = batch.t.findIndex((t) => batch.t0 + t > newest);
    if (from >= 0) this.add(batch, from);
    return goes_on;
  }
  add(batch, from) {
    for (let i = from; i < batch.t.length; ++i) {
      this.t.push(batch.t0 + batch.t[i]);
      for (const key of KEYS) this[key].push(batch[key][i]);
    }
    // Cut rarely: moving the arrays costs.
    if (this.t.length && this.newest - this.t[0] > 1.25 * KEPT_S) {
      const cut = this.first(this.newest - KEPT_S);
      for (const key of ['t', ...KEYS]) this[key] = this[key].slice(cut);
    }
  }
  /// A missing sample: the curves have a gap here.
  gap() {
    if (!this.t.length) return;
    this.t.push(this.newest + 1e-6);
    for (const key of KEYS) this[key].push(null);
  }
  /// The first sample not before `t`.
  first(t) {
    let low = 0, high = this.t.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle] < t) low = middle + 1; else high = middle;
    }
    return low;
  }
  part(from, to) {
    const a = Math.max(0, this.first(from) - 1), b = this.first(to) + 1;
    const out = {t: this.t.slice(a, b)};
    for (const key of KEYS) out[key] = this[key].slice(a, b);
    return out;
  }
}
