// The running stand: motion, command, the model's error, estimates and alarms. It follows, it can be
// paused, and it says since when nothing has come.
import {html, useEffect, useRef, useState} from './preact.js';
import {AlarmCount, Alarms, standing} from './alarms.js';
import {PlotStack, ZoomButtons} from './plots.js';
import {Ring} from './ring.js';
import {post} from './server.js';
import {TriggerTools} from './trigger.js';

const STALE_S = 3;
const FRAME_MS = 160;
/// Windows that watch at the same time for each further such pause between two pictures.
const WINDOWS = 3;
const FIRST_HEIGHT = 240, HEIGHT = 160;
const USUAL = ['reference', 'y', 'u', 'error'];
const WIDTHS = {y: 2}, DASHES = {u_requested: [5, 3]};

/// The plots of these channels, as PlotStack takes them: one for each unit.
function specs(channels) {
  const plots = new Map();
  for (const {key, words, plot, unit} of channels) {
    const label = plot + ', ' + unit;
    if (!plots.has(label)) plots.set(label, {height: plots.size ? HEIGHT : FIRST_HEIGHT, label, series: []});
    plots.get(label).series.push({key, name: words, tone: 'channel-' + key, width: WIDTHS[key], dash: DASHES[key]});
  }
  return [...plots.values()];
}

/// Which channels are drawn: chosen once, and kept by the browser for this address.
function useChosen() {
  const [chosen, setChosen] = useState(() => {
    try {
      const kept = JSON.parse(localStorage.getItem('channels'));
      return Array.isArray(kept) && kept.length ? kept : USUAL;
    } catch {
      return USUAL;
    }
  });
  return [chosen, (keys) => {
    setChosen(keys);
    try { localStorage.setItem('channels', JSON.stringify(keys)); } catch { /* it lasts as long as the page */ }
  }];
}

function Channels({channels, chosen, choose}) {
  const turn = (key) => choose(chosen.includes(key) ? chosen.filter((one) => one !== key) : [...chosen, key]);
  const drawn = channels.filter((c) => chosen.includes(c.key)).length;
  return html`
    <details class="channels"><summary>${drawn} of ${channels.length} channels</summary>
      <div class="list">${channels.map((c) => html`
        <label key=${c.key}><input type="checkbox" id=${'channel-' + c.key} checked=${chosen.includes(c.key)}
            disabled=${drawn === 1 && chosen.includes(c.key)} onChange=${() => turn(c.key)} />
          <i style=${{background: 'var(--channel-' + c.key + ')'}}></i> ${c.words}, ${c.unit}</label>`)}</div>
    </details>`;
}

// Of what is on the screen.
function meter(values) {
  let low = Infinity, high = -Infinity, sum = 0, n = 0;
  for (const v of values) {
    if (v == null) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
    sum += v;
    ++n;
  }
  return n ? {low, high, peak: Math.max(Math.abs(low), Math.abs(high)), mean: sum / n} : null;
}

const clockOf = (t) => new Date(1000 * t).toTimeString().slice(0, 8);

// Four digits, with a power of ten where that is shorter.
const shown = (v) => {
  if (v == null || !Number.isFinite(v)) return '';
  const plain = String(+v.toPrecision(4));
  return plain.length <= 8 ? plain : (+v.toPrecision(4)).toExponential().replace('e+', 'e');
};

function Meters({meters, channels}) {
  return html`
    <table class="meters"><thead><tr><th>in the picture</th><th>min</th><th>max</th><th>peak</th><th>mean</th></tr></thead>
      <tbody>${channels.map(({key, words, unit}) => html`<tr key=${key}><td>${words}, ${unit}</td>
        ${['low', 'high', 'peak', 'mean'].map((what) => html`
          <td class="n">${shown(meters[key] && meters[key][what])}</td>`)}</tr>`)}</tbody></table>`;
}

const percent = (ratio) => shown(+(100 * ratio).toPrecision(2)) + ' %';

/// The smallest change that an alarm would show now.
function seen(r) {
  if (!r.valid) return html`<span class="warn">nothing: ${r.reason}</span>`;
  if (r.down === 0 || r.up === 0) return 'it is outside its band';
  const sides = [r.down != null && '−' + percent(r.down), r.up != null && '+' + percent(r.up)].filter(Boolean);
  return sides.length ? sides.join(' or ') : html`<span class="hint">–</span>`;
}

function Estimates({status}) {
  const list = (status && status.estimates) || [];
  const rows = list.flatMap((e) => e.words.map((words, i) => ({
    words, valid: e.valid, text: e.text[i], value: e.value[i], low: e.low[i], high: e.high[i], band: e.band[i],
    down: e.seen_down_ratio[i], up: e.seen_up_ratio[i],
    reason: i === 0 ? e.reason : '', of: i === 0 ? e.words.length : 0})));
  if (rows.length === 0) return null;
  return html`
    <section class="estimates"><h2>Estimates, and what would be detected now</h2>
      <table><thead><tr><th></th><th>value</th><th>band</th><th>change seen from</th></tr></thead>
        <tbody>${rows.slice(0, 40).map((r) => html`
          <tr class=${r.valid && (r.value < r.low && r.low !== null || r.value > r.high && r.high !== null)
              ? 'outside' : ''}><td>${r.words}</td><td class="n">${r.text}</td><td class="n">${r.band}</td>
            ${(r.valid || r.of > 0) && html`<td rowspan=${r.valid ? 1 : r.of}>${seen(r)}</td>`}</tr>`)}</tbody></table>
    </section>`;
}

/// What the daemon's trackers would show, as `spoolwatch status` says it.
function Detectable({alarms}) {
  const sources = (alarms && alarms.detectable) || [];
  if (sources.length === 0) return null;
  return html`
    <section class="detectable"><h2>Would be detected now</h2>
      ${sources.map((one) => html`<p>${one.smallest}</p>
        ${one.more.map((line) => html`<p class="hint">${line}</p>`)}`)}
    </section>`;
}

/// A time of the daemon's clock as the wall clock shows it.
function where({where, spans}) {
  if (!spans || spans.length === 0) return where;
  return where.replace(/from [\d.]+ to [\d.]+ s\b/, 'from ' + clockOf(spans[0][0]) + ' to '
                                                  + clockOf(spans[spans.length - 1][1]));
}

function Model({status, model}) {
  const m = status && status.model;
  if (!model) {
    return html`<section><h2>Model beside the stand</h2>
      <p class="hint">Choose a model in the workbench: it runs along.</p></section>`;
  }
  return html`
    <section class="beside-model"><h2>Model beside the stand</h2>
      <p><b>${model}</b>${status && status.model_note ? ': ' + status.model_note : ''}</p>
      ${m && html`
        <p>error ${m.rms}, fit ${shown(m.fit_percent)} %, ${shown(m.floor_ratio)} × floor
          <small> last 10 s</small></p>
        ${m.worst && html`<p><i class="region"></i> worst ${where(m.worst)} (${m.worst.rms})
          <small> last 30 s</small></p>`}
        ${m.note && html`<p class="hint">${m.note}</p>`}`}
    </section>`;
}

export function Live({feed, link, state, openWorkbench}) {
  const element = useRef(), kept = useRef(null);
  const [status, setStatus] = useState(null);
  const [alarms, setAlarms] = useState(null);
  const [known, setKnown] = useState(null);  // the newest alarms that are a list
  const [span, setSpan] = useState(10);
  const [paused, setPaused] = useState(false);
  const [view, setView] = useState(null);    // zoomed: it does not follow
  const [age, setAge] = useState({s: null, since: null});
  const [meters, setMeters] = useState({});
  const [held, setHeld] = useState(0);
  const [capture, setCapture] = useState(null);   // the newest
  const [captured, showCaptured] = useState(false);  // the picture is that of the capture
  const [saved, setSaved] = useState('');
  const [refused, refuse] = useState('');
  const now = useRef();
  const [chosen, choose] = useChosen();
  const [channels, setChannels] = useState([]);  // of the stream
  // Without a model there is no error of it.
  const drawn = channels.filter((c) => chosen.includes(c.key) && (c.key !== 'error' || state.model));
  const plots = JSON.stringify(specs(drawn));
  const worst = status && status.model && status.model.worst;
  now.current = {span, paused, view, capture: captured ? capture : null, worst: (worst && worst.spans) || []};
  if (!kept.current) {
    kept.current = {ring: new Ring(), came: 0, aged: null, fresh: false, frozen: null,
                    after: 0, every: 1};
  }
  useEffect(() => {
    const k = kept.current, specs = JSON.parse(plots), keys = specs.flatMap((spec) => spec.series.map((s) => s.key));
    k.key = null;  // nothing is drawn yet
    const stack = new PlotStack(element.current, specs, {onZoom: (from, to) => {
      setView(from === null ? null : [k.base + from, k.base + to]);
    }});
    k.turn = (key) => stack.turn(key);
    const on = {
      history: ({detail}) => {
        if (!k.ring.history(detail)) k.frozen = null;
        k.fresh = true;
      },
      samples: ({detail}) => {
        if (!k.ring.samples(detail)) k.frozen = null;
        k.came = Date.now();
        k.fresh = true;
        if (now.current.paused) k.after += detail.t.length;
      },
      dropped: () => k.ring.gap(),
      status: ({detail}) => {
        setStatus(detail);
        if (detail.channels) setChannels(detail.channels);
        k.aged = {s: detail.age_s, at: Date.now()};
      },
      alarms: ({detail}) => {
        setAlarms(detail);
        if (!detail.control && Array.isArray(detail.alarms)) setKnown(detail);
      },
      capture: ({detail}) => setCapture(detail),
      watching: ({detail}) => { k.every = Math.ceil(detail / WINDOWS); },
    };
    for (const [name, take] of Object.entries(on)) feed.addEventListener(name, take);

    // Times of a capture count from its crossing.
    const drawCapture = (capture, view) => {
      const [from, to] = view || [capture.from, capture.to];
      k.base = 0;
      stack.bands = [{spans: [[0, 0]], tone: 'link'}];
      stack.mark = {key: capture.channel, value: capture.level};
      stack.show(capture, from, to);
      element.current.dataset.points = capture.t.length;
      const inside = (key) => (capture[key] || []).filter((v, i) => capture.t[i] >= from && capture.t[i] <= to);
      setMeters(Object.fromEntries(keys.map((key) => [key, meter(inside(key))])));
    };
    let frame = 0, told = 0;
    const pictureOf = ({span, paused, view, capture}) =>
      paused + '|' + span + '|' + view + '|' + (capture ? capture.number : '');
    // What is paused or captured is drawn once.
    const changed = () => pictureOf(now.current) !== k.key
      || (k.fresh && !now.current.paused && !now.current.capture);
    const draw = (time) => {
      if (!changed()) return;
      const {span, paused, view, capture} = now.current;
      const key = pictureOf(now.current);
      if (capture) {
        k.key = key;
        drawCapture(capture, view);
        return;
      }
      stack.mark = null;
      const {ring} = k;
      if (paused && !k.frozen && ring.length) k.frozen = ring.newest;
      if (!paused) { k.frozen = null; k.after = 0; }
      k.key = key;
      k.fresh = false;
      if (!ring.length) return;
      const newest = k.frozen || ring.newest;
      const [from, to] = view || [newest - span, newest];
      const part = ring.part(from, to, keys);
      k.base = newest;
      stack.bands = [{spans: now.current.worst.map((one) => one.map((t) => t - newest)), tone: 'region'}];
      stack.show({...part, t: part.t.map((v) => v - newest)}, from - newest, to - newest);
      element.current.dataset.points = part.t.length;
      if (time - told > 450) {
        told = time;
        setMeters(Object.fromEntries(keys.map((key) => [key, meter(part[key])])));
      }
    };
    // Frames are asked for only as often as they are drawn: an idle frame costs too.
    let turn = 0;
    const frames = setInterval(() => {
      if (++turn % k.every === 0 && !document.hidden && changed()) frame = requestAnimationFrame(draw);
    }, FRAME_MS);
    const ticking = setInterval(() => {
      const since = k.aged && k.aged.s != null ? k.aged.s + (Date.now() - k.aged.at) / 1000 : null;
      const seen = k.came ? (Date.now() - k.came) / 1000 : null;
      const s = seen !== null && (since === null || seen < since) ? seen : since;
      setAge({s, since: s === null ? null : new Date(Date.now() - 1000 * s)});
      setHeld(k.after);
    }, 500);
    return () => {
      clearInterval(frames);
      cancelAnimationFrame(frame);
      clearInterval(ticking);
      for (const [name, take] of Object.entries(on)) feed.removeEventListener(name, take);
      stack.end();
    };
  }, [plots]);

  const open = async () => {
    try {
      refuse('');
      await post('record', {name: saved});
      openWorkbench();
    } catch (error) {
      refuse(error.message);
    }
  };
  const stale = !link.alive || age.s === null || age.s > STALE_S;
  const health = (status && status.health) || {};
  const alarmed = standing(alarms, known, status, stale);
  const ago = age.s === null ? 'no sample yet'
    : stale ? 'no data since ' + age.since.toTimeString().slice(0, 8)
            : 'newest sample ' + age.s.toFixed(1) + ' s old';
  return html`
    <main class=${'live' + (stale ? ' stale' : '')}>
      <div>
        <p class="printed">${health.rig_id}, ${stale ? 'was ' : ''}${status && status.state}, newest sample
          ${' '}${age.since && age.since.toLocaleString()}</p>
        <p class="row tools">
          <span class="state">${!status || !status.state ? 'no daemon heard' : (stale ? 'was ' : '') + status.state}</span>
          <span class=${'age' + (stale ? ' stale' : '')} role="status">${ago}</span>
          <${AlarmCount} list=${alarmed.list} stale=${stale} />
          <button aria-pressed=${paused} onClick=${() => setPaused(!paused)}>
            ${paused ? 'Resume' : 'Pause'}</button>
          ${paused && html`<span class="hint">${held} samples since</span>`}
          <label class="row">window <select value=${span}
            onChange=${(e) => { setView(null); setSpan(+e.target.value); }}>
            ${[5, 10, 30, 60, 120].map((s) => html`<option value=${s}>${s} s</option>`)}</select></label>
          <${Channels} channels=${channels} chosen=${chosen} choose=${choose} />
          <${ZoomButtons} turn=${(key) => kept.current.turn(key)} disabled=${age.s === null} />
          ${view && html`<button onClick=${() => setView(null)}>
            ${captured && capture ? 'Whole capture' : 'Back to live'}</button>`}
        </p>
        <${TriggerTools} status=${status} channels=${channels} meters=${meters} capture=${capture} onSaved=${setSaved}
          onShow=${(on) => { setView(null); showCaptured(on); }} />
        ${captured && capture && html`
          <p class="captured">capture ${capture.number}: ${capture.samples} samples, crossing at ${clockOf(capture.t0)}
            ${capture.lacks_s > 0 && html` <span class="warn">its first ${shown(capture.lacks_s)} s are missing: no
              sample of them was kept</span>`}</p>`}
        ${saved && html`<p class="saved">saved as <b>${saved}</b>${' '}
          <button onClick=${open}>Open in the workbench</button>
          ${' '}<span class="warn">${refused}</span></p>`}
        ${age.s === null && html`<p class="welcome">No daemon is heard. Its samples appear here as soon as
          <code> spoolwatchd</code> runs with the LCM address and prefix of this server
          (<code>--lcm-url</code>, <code>--prefix</code>).</p>`}
        <div class=${'stack' + (age.s === null ? ' unheard' : '')} ref=${element}></div>
        ${age.s !== null && html`<${Meters} meters=${meters} channels=${drawn} />`}
        <${Estimates} status=${status} />
      </div>
      <div class="side">
        <${Alarms} alarms=${alarms} now=${alarmed} orders=${state.orders} stale=${stale} />
        <section class="loop"><h2>Loop</h2>
          <p>${health.rig_id || 'no health message yet'}</p>
          ${health.rig_id && html`<p class="hint">lateness p99.9 ${shown(health.lateness_p999_us)} µs,
            overruns ${health.overruns}, dropped ${health.dropped_samples}</p>`}
          ${status && status.lost > 0 && html`<p class="warn">${status.lost} messages lost</p>`}
          ${status && status.notice && html`<p class="hint">${status.notice}</p>`}
        </section>
        <${Model} status=${status} model=${state.model} />
        <${Detectable} alarms=${stale ? null : alarms} />
      </div>
    </main>`;
}
