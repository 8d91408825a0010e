// Talk with the process that serves this page: requests, uploads, events.
import {Stream} from './stream.js';

let change = '';  // what every change must carry

/// fetch(), whose own words for a server that is gone differ from browser to browser.
const ask = (...request) => fetch(...request).catch(() => {
  throw new Error('The server does not answer. Is spoolwatch serve running?');
});

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
    await answer(await ask('/api/login', {
      method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({token})}));
  }
  const state = await answer(await ask('/api/state'));
  change = state.change;
  return state;
}

/// The kinds of models that can be made, with the questions of each.
export async function kinds() { return answer(await ask('/api/kinds')); }

export async function post(path, body = {}) {
  return answer(await ask('/api/' + path, {
    method: 'POST',
    headers: {'Content-Type': 'application/json', 'X-Spoolwatch-Change': change},
    body: JSON.stringify(body)}));
}

/// Throws where the record is refused. map: which columns are time, command and position; '': as understood.
export async function upload(file, map = '') {
  const query = '?name=' + encodeURIComponent(file.name) + (map && '&map=' + encodeURIComponent(map));
  return answer(await ask('/api/upload' + query, {
    method: 'POST',
    headers: {'Content-Type': 'application/octet-stream', 'X-Spoolwatch-Change': change},
    body: file}));
}

/// Calls `run` for the newest argument only: while one runs, later ones replace each other. What it
/// throws goes to `failed`.
export function latest(run, failed) {
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
        failed(error.message);
      }
    }
    running = false;
  };
}

const SILENT_MS = 3000;

/// The way to the stream: {postMessage}, and `take` for what comes.
function connect(take) {
  try {
    const {port} = new SharedWorker(new URL('./stream.js', import.meta.url), {type: 'module', name: 'spoolwatch'});
    port.onmessage = ({data}) => take(data);
    return port;
  } catch {
    const stream = new Stream(), page = {postMessage: take};
    return {postMessage: (wish) => stream.set(page, wish)};
  }
}

/// Events while the page is seen: a hidden page leaves the stream and comes back when it is seen.
/// handlers: {name: (data) => ...}, among them `link({alive, since})`. Returns a function that ends it.
export function listen(live, handlers) {
  let heard = Date.now(), alive = null;
  const link = (now) => {
    if (now === alive) return;
    alive = now;
    handlers.link({alive, since: new Date(heard)});
  };
  const stream = connect(({name, data}) => {
    heard = Date.now();
    link(true);
    if (handlers[name]) handlers[name](data ? JSON.parse(data) : null);
  });
  const watch = setInterval(() => {
    if (!document.hidden && Date.now() - heard > SILENT_MS) link(false);
  }, 250);
  const tell = () => {
    heard = Date.now();
    stream.postMessage({seen: !document.hidden, live});
  };
  const leave = () => stream.postMessage(null);
  document.addEventListener('visibilitychange', tell);
  addEventListener('pagehide', leave);
  addEventListener('pageshow', tell);
  tell();
  return () => {
    clearInterval(watch);
    document.removeEventListener('visibilitychange', tell);
    removeEventListener('pagehide', leave);
    removeEventListener('pageshow', tell);
    leave();
  };
}
