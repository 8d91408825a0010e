// The event stream of the server, one for all pages of this browser: a browser opens six connections to
// a server, so with a stream for each the seventh page would never be answered. It runs as a shared
// worker, or within the page where the browser has none.
//
// A page sends {seen, live}, or null when it goes, and receives {name, data}. Without a page that is
// seen there is no stream. A page that begins to watch begins the stream again, so that it gets the
// last minute; the others keep what they have, and of the new stream they get what they lack. Pages that
// watch the stand learn how many do ("watching"), and draw less often where they are many.

const EVENTS = ['hello', 'beat', 'state', 'progress', 'history', 'samples', 'status', 'alarms', 'dropped', 'capture'];
const OF_THE_STAND = new Set(['history', 'samples', 'status', 'alarms', 'capture']);
const STALLED_MS = 9000;
const JOIN_MS = 20;  // pages that come together share a beginning

export class Stream {
  constructor() {
    this.pages = new Map();
    this.source = this.next = null;
    this.t0 = -Infinity;
    this.heard = 0;
    this.pause = 500;
    setInterval(() => {
      // A stalled connection gives no error: begin again.
      if ((this.source || this.next) && Date.now() - this.heard > STALLED_MS) {
        this.close();
        this.open();
      }
    }, 500);
  }

  set(page, wish) {
    const before = this.pages.get(page) || {};
    if (wish) {
      const stays = before.seen && before.live === wish.live;
      this.pages.set(page, {...wish, met: stays && before.met, lacks: stays && before.lacks});
    } else {
      this.pages.delete(page);
    }
    const seen = [...this.pages.values()].filter((one) => one.seen);
    if (seen.length === 0) return this.close();
    const watching = seen.filter((one) => one.live).length, live = watching > 0;
    for (const [one, {seen: is_seen, live: watches}] of this.pages) {
      if (is_seen && watches) one.postMessage({name: 'watching', data: String(watching)});
    }
    const joins = wish && wish.seen && (!before.seen || (wish.live && !before.live));
    if (joins || live !== this.live) this.later(JOIN_MS);
    this.live = live;
  }

  close() {
    clearTimeout(this.again);
    for (const source of [this.source, this.next]) if (source) source.close();
    this.source = this.next = null;
    for (const wish of this.pages.values()) wish.met = false;
  }

  later(pause) {
    clearTimeout(this.again);
    this.again = setTimeout(() => this.open(), pause);
  }

  /// The stream before goes on until the new one has begun.
  open() {
    clearTimeout(this.again);
    if (this.next) this.next.close();
    this.heard = Date.now();
    const source = this.next = new EventSource('/api/events' + (this.live ? '?live' : ''));
    let t0 = this.t0;  // of the newest samples that the others have
    for (const name of EVENTS) {
      source.addEventListener(name, ({data}) => {
        this.heard = Date.now();
        this.pause = 500;
        if (name === 'hello' && this.next === source) {
          if (this.source) this.source.close();
          [this.source, this.next] = [source, null];
          t0 = this.t0;
          this.greet();
          return;
        }
        if (this.source !== source) return;
        const known = name === 'history' && number(data, 'to') < t0;
        if (name === 'samples') {
          this.t0 = number(data, 't0');
          t0 = -Infinity;
        }
        for (const [page, wish] of this.pages) {
          if (!wish.seen || !wish.met || (!wish.live && OF_THE_STAND.has(name))) continue;
          if (known && !wish.lacks) continue;
          if (name === 'samples') wish.lacks = false;
          page.postMessage({name, data});
        }
      });
    }
    source.onerror = () => {
      if (this.source !== source && this.next !== source) return source.close();
      this.close();
      this.later(this.pause);
      this.pause = Math.min(2 * this.pause, 10000);
    };
  }

  /// Pages that have not been on the stream learn that they are, and get all of the last minute.
  greet() {
    for (const [page, wish] of this.pages) {
      if (!wish.seen || wish.met) continue;
      wish.met = wish.lacks = true;
      page.postMessage({name: 'hello', data: ''});
    }
  }
}

/// A number of JSON text, by its name, without reading all of it.
function number(data, name) {
  const found = data.slice(0, 200).match('"' + name + '":([-0-9.e+]+)');
  return found ? Number(found[1]) : Infinity;
}

if (typeof SharedWorkerGlobalScope !== 'undefined' && self instanceof SharedWorkerGlobalScope) {
  const stream = new Stream();
  self.onconnect = ({ports: [page]}) => {
    page.onmessage = ({data}) => stream.set(page, data);
  };
}
