// A model from the numbers of data sheets: what `spoolwatch new` asks.
import {html, useState} from './preact.js';
import {kinds, post} from './server.js';

export function MakeModel({act}) {
  const [all, setAll] = useState(null);
  const [name, choose] = useState('');
  const [texts, setTexts] = useState({});
  const begin = (e) => {
    if (e.target.open && !all) act(async () => setAll(await kinds()));
  };
  const kind = (all || []).find((one) => one.name === name);
  const make = (e) => {
    e.preventDefault();
    act(async () => {
      const values = {};
      for (const q of kind.questions) {
        const text = (texts[q.flag] || '').trim().replace(',', '.');
        if (text === '') continue;
        if (!Number.isFinite(Number(text))) throw new Error(q.what + ': is no number');
        values[q.flag] = Number(text);
      }
      await post('new', {kind: name, values});
      e.target.closest('details').open = false;
    });
  };
  return html`
    <details class="make" onToggle=${begin}>
      <summary>Make a model from data sheets</summary>
      <label>Kind of rig
        <select id="kind" value=${name} onChange=${(e) => choose(e.target.value)}>
          <option value="">choose</option>
          ${(all || []).map((one) => html`<option value=${one.name}>${one.name}: ${one.what}</option>`)}
        </select></label>
      ${kind && html`<p class="hint">${kind.what}</p><form onSubmit=${make}>
        ${kind.questions.map((q) => html`
          <label key=${q.flag}>${q.what} <code>--${q.flag}</code>
            <input id=${'new-' + q.flag} inputmode="decimal" required=${q.usual === null} title=${q.where}
              placeholder=${q.usual === null ? q.allowed : String(q.usual)} value=${texts[q.flag] || ''}
              onInput=${(e) => setTexts({...texts, [q.flag]: e.target.value})} />
            <small>${q.where}</small></label>`)}
        <p class="row"><button class="main">Make ${name}.toml</button></p>
      </form>`}
    </details>`;
}
