// A trigger as that of an oscilloscope: the server looks for the crossing at the full rate.
import {html, useEffect, useRef, useState} from './preact.js';
import {post} from './server.js';

const FIRST = {mode: 'off', channel: 'y', edge: 'rising', level: 0, window_s: 2, before_ratio: 0.25, hold_off_s: 0};
const STATES = {off: '', waiting: 'waiting for the crossing', capturing: 'capturing', 'held off': 'held off',
                stopped: 'captured'};

const UNDERWAY_MS = 2000;

/// status: the server's {mode, channel, ..., state}, which all pages share; channels: those of the stream; meters:
/// {mean} of each channel in the picture, which the level starts at.
export function TriggerTools({status, channels, meters, capture, onShow, onSaved}) {
  const [settings, setSettings] = useState(FIRST);
  const [said, say] = useState('');
  const server = status && status.trigger;
  const of = (all) => Object.fromEntries(Object.keys(FIRST).map((key) => [key, all[key]]));
  const chosen = useRef(false);  // the level was typed, which 0 may be too
  const taken = useRef(''), sent = useRef({text: '', at: 0});
  // Another page has set it; a status that was on its way while this one sets it is older.
  useEffect(() => {
    if (!server) return;
    const text = JSON.stringify(of(server));
    const older = text !== sent.current.text && Date.now() - sent.current.at < UNDERWAY_MS;
    if (text === taken.current || older) return;
    taken.current = text;
    onShow(server.mode !== 'off');
    setSettings(of(server));
  }, [status]);
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
    const meter = meters[next.channel];
    chosen.current = chosen.current || 'level' in change;
    const starts = settings.mode === 'off' && !chosen.current && !settings.level;
    if ('channel' in change) chosen.current = false;
    if (meter && ('channel' in change || starts)) next.level = +meter.mean.toPrecision(4);
    setSettings(next);
    sent.current = {text: JSON.stringify(of(next)), at: Date.now()};
    attempt(() => post('trigger', next));
  };
  const save = () => attempt(async () => onSaved((await post('capture', {number: capture.number})).name));
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
  const {unit} = channels.find((c) => c.key === settings.channel) || {};
  return html`
    <div class="row tools trigger">
      ${pick('mode', 'trigger', [['off', 'none: roll'], ['normal', 'normal'], ['single', 'single']])}
      ${settings.mode !== 'off' && html`
        ${pick('channel', 'on', channels.map((c) => [c.key, c.words]))}
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
