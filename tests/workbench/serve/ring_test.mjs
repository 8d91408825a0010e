// The samples of the live page: node ring_test.mjs PATH/ring.js
import assert from 'node:assert';
import {readFileSync} from 'node:fs';

const text = readFileSync(process.argv[2], 'utf8');
const {KEYS, Ring} = await import('data:text/javascript,' + encodeURIComponent(text));

// Points at these times after t0, y the time itself.
const batch = (t0, t, more = {}) => ({t0, t, ...Object.fromEntries(KEYS.map((key) => [key, t.map((v) => t0 + v)])), ...more});
const history = (t0, t, begins, newest) => batch(t0, t, {begins, newest});

const tests = {
  'what comes is appended': () => {
    const ring = new Ring();
    assert(ring.samples(batch(10, [0, 1])));
    assert(ring.samples(batch(10, [2, 3])));
    assert.deepEqual(ring.t, [10, 11, 12, 13]);
    assert.deepEqual(ring.y, ring.t);
  },
  'history fills what was missed, once': () => {
    const ring = new Ring();
    ring.samples(batch(10, [0, 1, 2]));
    assert(ring.history(history(8, [0, 1, 2, 3, 4, 5], true, 15)));
    assert(ring.history(history(14, [0, 1], false, 15)));
    assert.deepEqual(ring.t, [10, 11, 12, 13, 14, 15]);
  },
  'a gap that history does not reach over stays a gap': () => {
    const ring = new Ring();
    ring.samples(batch(10, [0, 1]));
    ring.history(history(20, [0, 1], true, 21));
    assert.equal(ring.t.length, 5);
    assert.equal(ring.y[2], null);
  },
  'a clock that went back begins again with the whole history': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 1, 2]));
    assert.equal(ring.history(history(10, [0, 1], true, 14)), false);
    assert(ring.history(history(12, [0, 1, 2], false, 14)));
    assert.deepEqual(ring.t, [10, 11, 12, 13, 14]);
  },
  'samples of a clock that went back begin again': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 1, 2]));
    assert.equal(ring.samples(batch(10, [0, 1])), false);
    assert.deepEqual(ring.t, [10, 11]);
  },
  'a rounded time is no clock that went back': () => {
    const ring = new Ring();
    ring.samples(batch(1000, [0, 0.0050003]));
    assert(ring.samples(batch(1000.005, [0, 0.005])));
    assert(ring.history(history(1000, [0, 0.005, 0.01], true, 1000.0099999)));
    assert.equal(ring.t.length, 4);
  },
  'only the last minutes are kept': () => {
    const ring = new Ring();
    for (let k = 0; k < 400; ++k) ring.samples(batch(k, [0, 0.5]));
    assert(ring.newest - ring.t[0] <= 150);
    assert(ring.newest - ring.t[0] >= 120);
  },
};
for (const [name, test] of Object.entries(tests)) {
  test();
  console.log('ok', name);
}
