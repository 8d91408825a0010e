// Talk with the process that serves this page: requests, uploads, events.

let change = '';  // what every change must carry

async function answer(response) {
  const body = await response.json().catch(() => ({error: 'the answer makes no sense'}));
  if (!response.ok) throw new Error(body.error || 'refused: ' + response.status);
  return body;
}

/// Exchanges the token of the address for a cookie, takes it off the address, and returns the state.
export async function enter() {
  const token = location.hash.slice(1);
  if (/^[0-9a-f]{64}$/.test(token)) {
    history.replaceState(null, '', '/');
    await answer(await fetch('/api/login', {
      method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({token})}));
  }
  const state = await answer(await fetch('/api/state'));
  change = state.change;
  return state;
}

export async function post(path, body = {}) {
  return answer(await fetch('/api/' + path, {
    method: 'POST',
    headers: {'Content-Type': 'application/json', 'X-Spoolwatch-Change': change},
    body: JSON.stringify(body)}));
}

export async function upload(file) {
  return answer(await fetch('/api/upload?name=' + encodeURIComponent(file.name), {
    method: 'POST',
    headers: {'Content-Type': 'application/octet-stream', 'X-Spoolwatch-Change': change},
    body: file}));
}

/// Calls `run` for the newest argument only: while one runs, later ones replace each other.
export function latest(run) {
  let running = false, next = null;
  return async (argument) => {
    next = {argument};
    if (running) return;
    running = true;
    while (next) {
      const now = next.argument;
      next = null;
      try {
        await run(now);
      } catch (error) {
        console.warn(error.message);
      }
    }
    running = false;
  };
}

const SILENT_MS = 3000;

/// Events while the page is seen: a hidden page closes its stream and begins again when it is seen.
/// handlers: {name: (data) => ...}, among them `link({alive, since})`. Returns a function that ends it.
export function listen(live, handlers) {
  let source = null, heard = Date.now(), alive = null, again = null, pause = 500;
  const link = (now) => {
    if (now === alive) return;
    alive = now;
    handlers.link({alive, since: new Date(heard)});
  };
  const take = (name) => (event) => {
    heard = Date.now();
    pause = 500;
    link(true);
    if (handlers[name]) handlers[name](event.data ? JSON.parse(event.data) : null);
  };
  const close = () => {
    clearTimeout(again);
    if (source) source.close();
    source = null;
  };
  const open = () => {
    close();
    if (document.hidden) return;
    source = new EventSource('/api/events' + (live ? '?live' : ''));
    for (const name of ['hello', 'beat', 'state', 'progress', 'history', 'samples', 'status', 'alarms',
                        'dropped', 'capture']) {
      source.addEventListener(name, take(name));
    }
    source.onerror = () => {
      close();
      again = setTimeout(open, pause);
      pause = Math.min(2 * pause, 10000);
    };
  };
  const watch = setInterval(() => {
    if (document.hidden || Date.now() - heard <= SILENT_MS) return;
    link(false);
    // A stalled connection gives no error: begin again.
    if (source && Date.now() - heard > 3 * SILENT_MS) {
      close();
      again = setTimeout(open, pause);
    }
  }, 250);
  const seen = () => (document.hidden ? close() : open());
  document.addEventListener('visibilitychange', seen);
  open();
  return () => {
    clearInterval(watch);
    document.removeEventListener('visibilitychange', seen);
    close();
  };
}
