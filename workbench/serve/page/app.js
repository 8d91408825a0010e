// The page: entry, the two views, and whether the server is heard.
import {html, render, useEffect, useState} from './preact.js';
import {Live} from './live.js';
import {enter, listen} from './server.js';
import {Workbench} from './workbench.js';

const clock = (date) => date.toTimeString().slice(0, 8);

function Header({view, show, link, folder}) {
  const tab = (name, text) => html`
    <a href=${'#' + name} aria-current=${view === name ? 'page' : null}
       onClick=${(e) => { e.preventDefault(); show(name); }}>${text}</a>`;
  return html`
    <header>
      <h1>Spoolwatch</h1>
      <nav>${tab('workbench', 'Workbench')}${tab('live', 'Live stand')}</nav>
      <span class="folder" title="the session's files">${folder}</span>
      <span class=${'link ' + (link.alive ? 'good' : 'bad')} role="status">
        ${link.alive ? 'connected' : 'no server since ' + clock(link.since)}</span>
    </header>`;
}

function App({first}) {
  const [state, setState] = useState(first);
  const [progress, setProgress] = useState(null);
  const [view, setView] = useState(location.hash === '#live' ? 'live' : 'workbench');
  const [link, setLink] = useState({alive: true, since: new Date()});
  const [feed] = useState(() => new EventTarget());
  const show = (name) => {
    history.replaceState(null, '', '#' + name);
    setView(name);
  };
  useEffect(() => {
    let newest = 0;
    const pass = (name) => (data) => feed.dispatchEvent(new CustomEvent(name, {detail: data}));
    return listen(view === 'live', {
      link: setLink,
      // Whatever happened before the stream began is in the state; an event that overtakes the answer
      // is newer than it.
      hello: () => {
        const asked = ++newest;
        enter().then((now) => { if (asked === newest) setState(now); }).catch(() => {});
        pass('hello')(null);
      },
      state: (data) => {
        ++newest;
        setState(data);
        if (!data.running) setProgress(null);
      },
      progress: setProgress,
      history: pass('history'), samples: pass('samples'), status: pass('status'),
      alarms: pass('alarms'), dropped: pass('dropped'), capture: pass('capture'),
      watching: pass('watching'),
    });
  }, [view]);
  return html`
    <${Header} view=${view} show=${show} link=${link} folder=${state.folder} />
    ${state.trouble && html`<p class="trouble" role="alert"><b>Nothing can be saved.</b> ${state.trouble}.
      What was accepted is kept: it is written again when this is mended. What you change now is refused.</p>`}
    ${view === 'live' ? html`<${Live} feed=${feed} link=${link} state=${state}
                                     openWorkbench=${() => show('workbench')} />`
                      : html`<${Workbench} state=${state} progress=${progress} />`}`;
}

// A file dropped where nothing takes it must not replace the page.
for (const name of ['dragover', 'drop']) addEventListener(name, (e) => e.preventDefault());

const root = document.getElementById('app');
enter().then((first) => {
  root.replaceChildren();
  render(html`<${App} first=${first} />`, root);
  document.body.dataset.ready = 'yes';
}).catch((error) => {
  root.textContent = error.message;
  root.className = 'starting';
});
