// The samples of the live page: node ring_test.mjs PATH/ring.js
import assert from 'node:assert';
import {readFileSync} from 'node:fs';

const text = readFileSync(process.argv[2], 'utf8');
const {Ring} = await import('data:text/javascript,' + encodeURIComponent(text));

// Points at these times after t0, y the time itself.
const batch = (t0, t, more = {}) => ({t0, t, y: t.map((v) => t0 + v), ...more});
const history = (t0, t, begins, newest) => batch(t0, t, {begins, newest});

const all = (ring) => ring.part(-Infinity, Infinity, ['y']);

const tests = {
  'what comes is appended': () => {
    const ring = new Ring();
    assert(ring.samples(batch(10, [0, 1])));
    assert(ring.samples(batch(10, [2, 3])));
    assert.deepEqual(all(ring).t, [10, 11, 12, 13]);
    assert.deepEqual(all(ring).y, all(ring).t);
  },
  'history fills what was missed, once': () => {
    const ring = new Ring();
    ring.samples(batch(10, [0, 1, 2]));
    assert(ring.history(history(8, [0, 1, 2, 3, 4, 5], true, 15)));
    assert(ring.history(history(14, [0, 1], false, 15)));
    assert.deepEqual(all(ring).t, [10, 11, 12, 13, 14, 15]);
  },
  'a gap that history does not reach over stays a gap': () => {
    const ring = new Ring();
    ring.samples(batch(10, [0, 1]));
    ring.history(history(20, [0, 1], true, 21));
    assert.equal(ring.length, 5);
    assert.equal(all(ring).y[2], null);
  },
  'a clock that went back begins again with the whole history': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 1, 2]));
    assert.equal(ring.history(history(10, [0, 1], true, 14)), false);
    assert(ring.history(history(12, [0, 1, 2], false, 14)));
    assert.deepEqual(all(ring).t, [10, 11, 12, 13, 14]);
  },
  'samples of a clock that went back begin again': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 1, 2]));
    assert.equal(ring.samples(batch(10, [0, 1])), false);
    assert.deepEqual(all(ring).t, [10, 11]);
  },
  'a channel that comes later is missing before, and one that goes is missing after': () => {
    const ring = new Ring();
    ring.samples(batch(10, [0, 1]));
    ring.samples(batch(12, [0, 1], {supply: [70, null]}));
    ring.samples(batch(14, [0], {y: undefined}));
    assert.deepEqual(ring.part(-Infinity, Infinity, ['supply', 'y', 'none']),
      {t: [10, 11, 12, 13, 14], supply: [null, null, 70, null, null], y: [10, 11, 12, 13, null],
       none: [null, null, null, null, null]});
  },
  'a rounded time is no clock that went back': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 0.0050003]));
    assert(ring.samples(batch(1000.005, [0, 0.005])));
    assert(ring.history(history(1000, [0, 0.005, 0.01], true, 1000.0099999)));
    assert.equal(ring.length, 4);
  },
  'the arrays keep the last minutes and no longer grow': () => {
    const ring = new Ring(), sizes = new Set();
    for (let k = 0; k < 20000; ++k) {
      ring.samples(batch(k / 10, [0, 0.005, 0.01, 0.015, 0.02]));
      assert(ring.newest - ring.oldest >= Math.min(119.9, k / 10));
      if (k > 3000) sizes.add(ring.kept.t.length);
    }
    assert.equal(ring.newest, 1999.92);
    assert.equal(sizes.size, 1);
    assert([...sizes][0] <= 4 * 120 * 50, [...sizes]);
    const {t, y} = ring.part(1990, 1991, ['y']);
    assert.deepEqual(y, t);
    assert(t[0] < 1990 && t[1] === 1990 && t[t.length - 1] === 1991, t);
  },
};
for (const [name, test] of Object.entries(tests)) {
  test();
  console.log('ok', name);
}
