// How curves are drawn: node curves_test.mjs PATH/curves.js
import assert from 'node:assert';
import {readFileSync} from 'node:fs';

const text = readFileSync(process.argv[2], 'utf8');
const {TOLERANCE_PX, trace} = await import('data:text/javascript,' + encodeURIComponent(text));

/// The lines that are drawn, of samples `width` pixels wide.
function drawn(ys, width) {
  const lines = [];
  trace(ys.map((y, i) => i), ys, 0, ys.length - 1, (x) => x * width / ys.length, (y) => y,
        (x, y) => lines.push([[x, y]]), (x, y) => lines.at(-1).push([x, y]));
  return lines;
}
/// The line's height at x.
function at(line, x) {
  const i = Math.max(1, line.findIndex(([end]) => end >= x));
  const [[x0, y0], [x1, y1]] = [line[i - 1], line[i]];
  return x1 === x0 ? y1 : y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}
const wave = (n, noise) => Array.from({length: n}, (_, i) => 80 * Math.sin(31.4 * i / n) + noise * ((i * 7919) % 13 - 6));

const tests = {
  'a smooth curve needs few strokes and lies where it lay': () => {
    const ys = wave(2000, 0), [line, ...more] = drawn(ys, 850);
    assert.equal(more.length, 0);
    assert(line.length < 250, line.length);
    for (let i = 0; i < 2000; ++i) {
      // One column of the steepest part: 3 pixels.
      assert(Math.abs(at(line, i * 850 / 2000) - ys[i]) < 2 * TOLERANCE_PX + 1e-9, i);
    }
  },
  'noise of many samples to a column keeps its peaks': () => {
    const ys = wave(12000, 1);
    ys[6001] = 300;
    const [line] = drawn(ys, 850);
    assert(line.length < 4 * 850);
    assert(line.some(([, y]) => y === 300));
    assert.deepEqual([line[0], line.at(-1)], [[0, ys[0]], [11999 * 850 / 12000, ys[11999]]]);
  },
  'a gap stays a gap, and a sample between two is seen': () => {
    const lines = drawn([1, 2, null, 5, null, null, 3, 3, 3], 90);
    assert.deepEqual(lines, [[[0, 1], [10, 2]], [[30, 5], [31, 5]], [[60, 3], [80, 3]]]);
    assert.deepEqual(drawn([null, null], 10), []);
  },
};
for (const [name, test] of Object.entries(tests)) {
  test();
  console.log('ok', name);
}
