// The event stream of the server, one for all pages of this browser: a browser opens six connections to
// a server, so with a stream for each the seventh page would never be answered. It runs as a shared
// worker, or within the page where the browser has none.
//
// A page sends {seen, live}, or null when it goes, and receives {name, data}. Without a page that is
// seen there is no stream. A page that begins to watch begins the stream again, so that it gets the
// last minute; the others keep what they have.

const EVENTS = ['hello', 'beat', 'state', 'progress', 'history', 'samples', 'status', 'alarms', 'dropped', 'capture'];
const OF_THE_STAND = new Set(['history', 'samples', 'status', 'alarms', 'capture']);
const STALLED_MS = 9000;
const JOIN_MS = 20;  // pages that come together share a beginning

export class Stream {
  constructor() {
    this.pages = new Map();
    this.source = null;
    this.heard = 0;
    this.pause = 500;
    setInterval(() => {
      // A stalled connection gives no error: begin again.
      if (this.source && Date.now() - this.heard > STALLED_MS) this.open();
    }, 500);
  }

  set(page, wish) {
    const before = this.pages.get(page) || {};
    if (wish) this.pages.set(page, wish); else this.pages.delete(page);
    const seen = [...this.pages.values()].filter((one) => one.seen);
    if (seen.length === 0) return this.close();
    const live = seen.some((one) => one.live);
    const joins = wish && wish.seen && (!before.seen || (wish.live && !before.live));
    if (joins || live !== this.live) this.later(JOIN_MS);
    this.live = live;
  }

  close() {
    clearTimeout(this.again);
    if (this.source) this.source.close();
    this.source = null;
  }

  later(pause) {
    clearTimeout(this.again);
    this.again = setTimeout(() => this.open(), pause);
  }

  open() {
    this.close();
    this.heard = Date.now();
    this.source = new EventSource('/api/events' + (this.live ? '?live' : ''));
    for (const name of EVENTS) {
      this.source.addEventListener(name, ({data}) => {
        this.heard = Date.now();
        this.pause = 500;
        for (const [page, wish] of this.pages) {
          if (wish.seen && (wish.live || !OF_THE_STAND.has(name))) page.postMessage({name, data});
        }
      });
    }
    this.source.onerror = () => {
      this.close();
      this.later(this.pause);
      this.pause = Math.min(2 * this.pause, 10000);
    };
  }
}

if (typeof SharedWorkerGlobalScope !== 'undefined' && self instanceof SharedWorkerGlobalScope) {
  const stream = new Stream();
  self.onconnect = ({ports: [page]}) => {
    page.onmessage = ({data}) => stream.set(page, data);
  };
}
