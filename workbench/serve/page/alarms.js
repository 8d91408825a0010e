// Alarms of the daemon: acknowledge, put aside, never more.
import {html, useState} from './preact.js';
import {post} from './server.js';

/// The alarms that stand, and whether they are all. alarms: the newest answer of the control socket;
/// known: the newest that had a list; status: what came over LCM, which leaves out what is shelved.
export function standing(alarms, known, status, stale) {
  const reached = Boolean(alarms) && !alarms.control;
  if (known && (reached || stale)) {
    return {whole: true, reached, list: known.alarms.filter((a) => a.life !== 'NORMAL').map((a) => ({
      name: a.source + '.' + a.name, life: a.life, severity: a.severity, came: a.came,
      reason: a.reason, guidance: a.guidance, shelved_s: a.shelved_for_s}))};
  }
  return {whole: false, reached, list: ((status && status.alarms) || []).filter((a) => a.active).map((a) => ({
    name: a.source + '.' + a.name, life: 'ACTIVE', severity: a.severity, came: a.time, reason: a.reason,
    guidance: a.guidance, shelved_s: 0}))};
}

const clock = (text) => {
  const time = new Date(text);
  return text && !isNaN(time) ? ', came ' + time.toTimeString().slice(0, 8) : '';
};

const left = (s) => (s > 0 ? ', ' + (s < 90 ? Math.ceil(s) + ' s' : Math.ceil(s / 60) + ' min') + ' left' : '');

/// How many stand, beside the state of the stand: the list may be below what is seen.
export function AlarmCount({list, stale}) {
  const open = list.filter((a) => !(a.shelved_s > 0));
  if (open.length === 0) return null;
  const bad = open.some((a) => a.severity === 'MAJOR' || a.severity === 'INVALID');
  return html`<button class=${'count ' + (stale ? '' : bad ? 'bad' : 'warn')}
    onClick=${() => document.querySelector('.alarms').scrollIntoView({block: 'center'})}>
    ${open.length === 1 ? '1 alarm' : open.length + ' alarms'}</button>`;
}

export function Alarms({alarms, now: {list, whole, reached}, orders, stale}) {
  const [said, say] = useState('');
  const order = async (body) => {
    try {
      say('');
      await post('alarm', body);
    } catch (error) {
      say(error.message);
    }
  };
  const may = orders && reached && !stale;
  return html`
    <section class="alarms">
      <h2>Alarms</h2>
      ${said && html`<p class="warn" role="alert">${said}</p>`}
      ${list.length === 0 && html`<p class=${whole && !stale ? 'hint' : 'warn'}>
        ${stale ? 'not known: nothing is heard' : whole ? 'none' : 'none heard of; those from before are not known'}</p>`}
      ${list.length > 0 && stale && html`<p class="warn">as they were last heard</p>`}
      ${list.length > 0 && !whole && html`<p class="warn">those heard of; what is shelved is not known</p>`}
      <ul>${list.map((a) => html`
        <li key=${a.name} class=${a.severity}>
          <b>${a.name}</b> <small>${a.life.toLowerCase()}${left(a.shelved_s)}${
            a.severity === 'OK' ? '' : ', ' + a.severity}${clock(a.came)}</small>
          <p>${a.reason}</p>${a.guidance && html`<p class="hint">${a.guidance}</p>`}
          ${may && html`<p class="row">
            ${a.life !== 'ACKNOWLEDGED' && html`
              <button onClick=${() => order({order: 'ack', alarm: a.name})}>Acknowledge</button>`}
            ${a.shelved_s > 0
              ? html`<button onClick=${() => order({order: 'unshelve', alarm: a.name})}>Unshelve</button>`
              : html`<button onClick=${() => order({order: 'shelve', alarm: a.name, time_s: 600})}>
                  Shelve for 10 min</button>`}</p>`}
        </li>`)}</ul>
      ${alarms && alarms.control && html`<p class="hint">${alarms.control}</p>`}
      ${!orders && html`<p class="hint">Acknowledge and shelve: spoolwatch serve --allow-orders</p>`}
    </section>`;
}
