// A trigger as that of an oscilloscope: the server looks for the crossing at the full rate.
import {html, useEffect, useState} from './preact.js';
import {post} from './server.js';

const FIRST = {mode: 'off', channel: 'y', edge: 'rising', level: 0, window_s: 2, before_ratio: 0.25, hold_off_s: 0};
const STATES = {off: '', waiting: 'waiting for the crossing', capturing: 'capturing', 'held off': 'held off',
                stopped: 'captured'};

/// status: the server's {mode, channel, ..., state}, which all pages share.
export function TriggerTools({status, units, capture, onShow, onSaved}) {
  const [settings, setSettings] = useState(FIRST);
  const [said, say] = useState('');
  const server = status && status.trigger;
  const text = server ? JSON.stringify({...server, state: undefined}) : '';
  // Another page has set it.
  useEffect(() => {
    if (!server) return;
    onShow(server.mode !== 'off');
    setSettings(Object.fromEntries(Object.keys(FIRST).map((key) => [key, server[key]])));
  }, [text]);
  const attempt = async (run) => {
    try {
      say('');
      await run();
    } catch (error) {
      say(error.message);
    }
  };
  const set = (change) => {
    const next = {...settings, ...change};
    setSettings(next);
    attempt(() => post('trigger', next));
  };
  const save = () => attempt(async () => onSaved((await post('capture')).name));
  const pick = (key, label, options) => html`
    <label class="row">${label} <select id=${'trigger-' + key} value=${String(settings[key])}
      onChange=${(e) => set({[key]: typeof FIRST[key] === 'number' ? +e.target.value : e.target.value})}>
      ${options.map(([value, name]) => html`<option value=${String(value)}>${name}</option>`)}</select></label>`;
  const number = (key, label, unit) => html`
    <label class="row">${label} <input id=${'trigger-' + key} size="6" value=${settings[key]} inputmode="decimal"
      onChange=${(e) => {
        const value = Number(e.target.value.replace(',', '.'));
        if (e.target.value.trim() !== '' && Number.isFinite(value)) set({[key]: value});
        else e.target.value = settings[key];
      }} /> ${unit}</label>`;
  const unit = {reference: units.position, y: units.position, u: 'V', error: units.error}[settings.channel];
  return html`
    <div class="row tools trigger">
      ${pick('mode', 'trigger', [['off', 'none: roll'], ['normal', 'normal'], ['single', 'single']])}
      ${settings.mode !== 'off' && html`
        ${pick('channel', 'on', [['y', 'position'], ['reference', 'reference'], ['u', 'command'],
                                 ['error', 'error of the model']])}
        ${pick('edge', 'edge', [['rising', 'rising'], ['falling', 'falling'], ['either', 'either']])}
        ${number('level', 'level', unit)}
        ${pick('window_s', 'length', [0.5, 1, 2, 5, 10, 20].map((s) => [s, s + ' s']))}
        ${pick('before_ratio', 'before it', [0, 0.1, 0.25, 0.5, 0.75, 0.9].map((r) => [r, 100 * r + ' %']))}
        ${number('hold_off_s', 'hold-off', 's')}
        ${settings.mode === 'single' && html`<button onClick=${() => set({})}>Trigger again</button>`}
        <span class="hint" id="trigger-state" role="status">${STATES[(server && server.state) || 'off']}</span>`}
      ${capture && html`
        <button class=${settings.mode === 'off' ? '' : 'main'} onClick=${save}>Save capture ${capture.number}</button>`}
      ${said && html`<span class="warn" role="alert">${said}</span>`}
    </div>`;
}
