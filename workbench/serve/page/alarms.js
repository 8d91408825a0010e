// Alarms of the daemon: acknowledge, put aside, never more.
import {html, useState} from './preact.js';
import {post} from './server.js';

function rows(alarms, status) {
  if (alarms && !alarms.control && Array.isArray(alarms.alarms)) {
    return alarms.alarms.filter((a) => a.life !== 'NORMAL').map((a) => ({
      name: a.source + '.' + a.name, life: a.life, severity: a.severity, came: a.came,
      reason: a.reason, guidance: a.guidance, shelved: a.shelved_for_s > 0}));
  }
  // Without the control socket: what came over LCM.
  return ((status && status.alarms) || []).filter((a) => a.active).map((a) => ({
    name: a.source + '.' + a.name, life: 'ACTIVE', severity: a.severity, came: a.time, reason: a.reason,
    guidance: a.guidance}));
}

const clock = (text) => {
  const time = new Date(text);
  return text && !isNaN(time) ? ', came ' + time.toTimeString().slice(0, 8) : '';
};

export function Alarms({alarms, status, orders, stale}) {
  const [said, say] = useState('');
  const order = async (body) => {
    try {
      say('');
      await post('alarm', body);
    } catch (error) {
      say(error.message);
    }
  };
  const list = rows(alarms, status);
  const reachable = alarms && !alarms.control;
  return html`
    <section class="alarms">
      <h2>Alarms</h2>
      ${said && html`<p class="warn" role="alert">${said}</p>`}
      ${list.length === 0 && html`<p class=${reachable && !stale ? 'hint' : 'warn'}>
        ${stale ? 'not known: nothing is heard' : reachable ? 'none' : 'none heard of; those from before are not known'}</p>`}
      ${list.length > 0 && stale && html`<p class="warn">as they were last heard</p>`}
      <ul>${list.map((a) => html`
        <li key=${a.name} class=${a.severity}>
          <b>${a.name}</b> <small>${a.life.toLowerCase()}${a.severity === 'OK' ? '' : ', ' + a.severity}${clock(a.came)}</small>
          <p>${a.reason}</p>${a.guidance && html`<p class="hint">${a.guidance}</p>`}
          ${orders && reachable && html`<p class="row">
            <button onClick=${() => order({order: 'ack', alarm: a.name})}>Acknowledge</button>
            ${a.shelved
              ? html`<button onClick=${() => order({order: 'unshelve', alarm: a.name})}>Unshelve</button>`
              : html`<button onClick=${() => order({order: 'shelve', alarm: a.name, time_s: 600})}>
                  Shelve for 10 min</button>`}</p>`}
        </li>`)}</ul>
      ${alarms && alarms.control && html`<p class="hint">${alarms.control}</p>`}
      ${!orders && html`<p class="hint">Acknowledge and shelve: spoolwatch serve --allow-orders</p>`}
    </section>`;
}
