// The event stream that pages share: node stream_test.mjs PATH/stream.js
import assert from 'node:assert';
import {readFileSync} from 'node:fs';

const sources = [];
globalThis.EventSource = class {
  constructor(address) {
    Object.assign(this, {address, take: {}, open: true});
    sources.push(this);
  }
  addEventListener(name, take) { this.take[name] = take; }
  send(name, data = '') { if (this.open) this.take[name]({data}); }
  close() { this.open = false; }
};
const {Stream} = await import('data:text/javascript,' + encodeURIComponent(readFileSync(process.argv[2], 'utf8')));
const soon = () => new Promise((done) => setTimeout(done, 40));
const page = () => ({got: [], postMessage({name, data}) {
  if (name === 'watching') this.watching = data;
  else this.got.push(name + (data && ' ' + JSON.parse(data).to));
}});
const history = (to) => ['history', JSON.stringify({to, begins: true, newest: 9, t0: 0, t: []})];
const samples = (t0) => ['samples', JSON.stringify({t0, t: []})];

const stream = new Stream(), first = page(), second = page();
stream.set(first, {seen: true, live: true});
await soon();
assert.equal(sources.length, 1);
assert.equal(sources[0].address, '/api/events?live');
sources[0].send('hello');
sources[0].send(...history(5));
sources[0].send(...samples(6));
assert.deepEqual(first.got, ['hello', 'history 5', 'samples undefined']);

// Another page joins: what the first one has is not sent to it again, and nothing of it is lost.
stream.set(second, {seen: true, live: true});
stream.set(second, {seen: true, live: true});  // as pageshow says once more
await soon();
assert.equal(sources.length, 2);
assert.deepEqual([first.watching, second.watching], ['2', '2']);
first.got.length = 0;
sources[0].send(...samples(7));
sources[1].send('hello');
assert(!sources[0].open && sources[1].open);
for (const to of [5, 6.9, 7.2]) sources[1].send(...history(to));
sources[1].send(...samples(7.2));
assert.deepEqual(first.got, ['samples undefined', 'history 7.2', 'samples undefined']);
assert.deepEqual(second.got, ['hello', 'history 5', 'history 6.9', 'history 7.2', 'samples undefined']);
// A daemon that begins again, with a clock that went back.
sources[1].send(...history(1));
assert.equal(first.got.at(-1), 'history 1');

// A broken stream begins again for both, with everything.
for (const one of [first, second]) one.got.length = 0;
sources[1].onerror();
await new Promise((done) => setTimeout(done, 600));
assert.equal(sources.length, 3);
sources[2].send('hello');
sources[2].send(...history(5));
for (const one of [first, second]) assert.deepEqual(one.got, ['hello', 'history 5']);

// Without a page that is seen there is none.
stream.set(first, null);
stream.set(second, {seen: false, live: true});
assert(!sources[2].open);
console.log('ok');
process.exit(0);
