// The workbench: a record against a model, where it fails, what would help, try, accept or undo.
import {html, useEffect, useRef, useState} from './preact.js';
import {Ladder} from './ladder.js';
import {Laws} from './laws.js';
import {MakeModel} from './make.js';
import {PlotStack, ZoomButtons} from './plots.js';
import {ReadAs, proposal} from './read_as.js';
import {Result} from './result.js';
import {latest, post, upload} from './server.js';
import {Sliders} from './sliders.js';

const SPECS = [
  {height: 250, label: 'position, mm', series: [
    {key: 'measured', name: 'measured', tone: 'measured', width: 2},
    {key: 'ghost_model', name: 'before', tone: 'ghost'},
    {key: 'model', name: 'model, free run', tone: 'model'}]},
  {height: 200, label: 'error', level: 'floor', series: [
    {key: 'ghost_error', name: 'before', tone: 'ghost'},
    {key: 'error', name: 'measured less model, drift-corrected', tone: 'residual'}]},
  {height: 140, label: 'command, V', series: [{key: 'command', name: 'command', tone: 'command'}]},
];

function Files({state, act, ask}) {
  const [over, setOver] = useState(false);
  const input = useRef();
  /// Reads a record; where its columns are not understood, asks which they are. read(map): map is '' at first.
  const attempt = (name, read) => act(async () => {
    ask(null);
    try {
      await read('');
    } catch (error) {
      const map = proposal(error.message);
      if (map) ask({name, map, read});
      throw error;
    }
  });
  const take = async (files) => {
    for (const file of files) await attempt(file.name, (map) => upload(file, map));
  };
  // Anywhere on the page.
  useEffect(() => {
    const on = {
      dragover: (e) => { e.preventDefault(); setOver(e.dataTransfer.types.includes('Files')); },
      dragleave: (e) => { if (!e.relatedTarget) setOver(false); },
      drop: (e) => { e.preventDefault(); setOver(false); take(e.dataTransfer.files); }};
    for (const [name, does] of Object.entries(on)) addEventListener(name, does);
    return () => { for (const [name, does] of Object.entries(on)) removeEventListener(name, does); };
  }, []);
  const records = state.files.filter((f) => f.kind === 'record');
  const models = state.files.filter((f) => f.kind === 'model');
  const open = (name) =>
    attempt(name, (map) => (map ? post('import', {name, map}) : post('record', {name})));
  const choose = (what, name) => act(() => post(what, {name}));
  return html`
    <section class=${'files' + (over ? ' over' : '')}>
      <h2>Record and model</h2>
      <label>Record
        <select id="record" value=${state.record} onChange=${(e) => open(e.target.value)}>
          ${!state.record && html`<option value="">choose, or drop a file</option>`}
          ${records.map((f) => html`<option value=${f.name}>${f.name}</option>`)}
        </select></label>
      <label>Model
        <select id="model" value=${state.model} onChange=${(e) => e.target.value.startsWith('shipped:')
            ? choose('shipped', e.target.value.slice(8)) : choose('model', e.target.value)}>
          ${!state.model && html`<option value="">choose</option>`}
          <optgroup label="in the folder">
            ${models.map((f) => html`<option value=${f.name}>${f.name}</option>`)}</optgroup>
          <optgroup label="shipped: copied into the folder">
            ${state.shipped.map((name) => html`<option value=${'shipped:' + name}>${name}</option>`)}
          </optgroup>
        </select></label>
      <p class="row"><button onClick=${() => input.current.click()}>Add a file</button>
        <span class="hint">or drop it on the page: CSV, MAT, LCM log, TOML</span></p>
      <input id="upload" type="file" multiple hidden ref=${input}
             onChange=${(e) => { take(e.target.files); }} />
      <${MakeModel} act=${act} />
    </section>`;
}

function Verdict({shown, trial, running, act, selected, select}) {
  if (!shown) return null;
  return html`
    <section class=${'verdict ' + shown.judgement}>
      <p class="words">${trial && html`<span class="tag">trial</span>`} ${shown.verdict}</p>
      ${trial && html`<p class="row">
        <button class="main" onClick=${() => act(() => post('accept'))}>Accept ${trial}</button>
        <button onClick=${() => act(() => post('undo'))}>Undo</button></p>`}
      <dl class="figures">${shown.figures.map((f) => html`
        <div><dt>${f.label}</dt><dd>${f.value}</dd></div>`)}</dl>
      ${shown.regions.length > 0 && html`
        <p class="regions">Fails, with the share of the speed error: ${shown.regions.map((region, i) => html`
          <button aria-pressed=${i === selected} onClick=${() => select(i === selected ? -1 : i)}
                  title=${region.share + ' of the speed error in ' + region.time_share + ' of the time'}>
            ${region.where} <small>${region.share}</small></button>`)}</p>`}
      ${!trial && html`<p class="row">
        <button class="main" disabled=${running} onClick=${() => act(() => post('diagnose'))}>
          Diagnose: what is missing?</button></p>`}
      <details><summary>In words</summary>
        ${[...shown.lines, ...shown.notes].map((line) => html`<p>${line}</p>`)}</details>
    </section>`;
}

/// The next step of a session that shows nothing yet.
function Welcome({state}) {
  if (state.shown) return null;
  return html`
    <p class="welcome">${state.record
      ? html`<b>${state.record}</b> is read. Now choose a model, one of the shipped ones to begin with, or make one
          from data sheets: the page then shows where it fails, and finds out what it misses.`
      : state.model
        ? html`Now drop a record on this page, or choose one of the folder: the page then shows where
            <b> ${state.model}</b> fails, and finds out what it misses.`
        : html`Drop a record on this page and choose a model: the page shows where the model fails, and finds
            out what it misses.`}</p>`;
}

/// Two models side by side: their errors, and only what differs.
function SideBySide({beside}) {
  if (!beside) return null;
  const {figures, differences} = beside;
  return html`
    <section class="side-by-side">
      <table><thead><tr><th></th><th>${beside.shown}</th><th>${beside.model}</th></tr></thead>
        <tbody>${figures.labels.map((label, i) => html`
          <tr><td>${label}</td><td class="n">${figures.here[i]}</td><td class="n">${figures.there[i]}</td></tr>`)}
        ${differences.map((one) => html`
          <tr key=${one.name}><td title=${one.name}>${one.words}</td><td class="n">${one.here}</td><td class="n">${one.there}</td></tr>`)}
        </tbody></table>
      ${differences.length === 0 && html`<p class="hint">Their parameters are the same.</p>`}
    </section>`;
}

function Bands({ignored, act}) {
  if (ignored.length === 0) return null;
  return html`<p class="bands">Left out: ${ignored.map((span) => html`
    <button title="count it again" onClick=${() => act(() =>
      post('ignore', {spans: ignored.filter((one) => one !== span)}))}>${span.replace(':', ' to ')} s ×</button>`)}</p>`;
}

function usePlots({state, values, rms}) {
  const element = useRef(), stack = useRef(), view = useRef({from: 0, to: 0});
  const [zoomed, setZoomed] = useState(false);
  const [marking, setMarking] = useState(false);
  const [selected, setSelected] = useState(0);
  const [alone, setAlone] = useState(false);  // without the curves of the model before
  const shown = state.shown;
  const before = Object.keys(values).length > 0 ? 'before' : state.beside ? state.beside.model
    : state.trial && 'before';
  const now = useRef();
  now.current = {state, values, alone};

  // The curves of the state and view, fetched once; a slider's move brings model and error anew.
  const base = useRef({});
  const draw = useRef(latest(async () => {
    const {state, values} = now.current;
    if (!state.shown) return;
    const {from, to} = view.current;
    const body = {from, to, rows: 2500};
    const old = base.current;
    const fetched = old.state !== state || old.from !== from || old.to !== to;
    if (fetched) base.current = {state, from, to, curves: await post('curves', body)};
    let curves = base.current.curves;
    const moved = Object.keys(values).length > 0;
    if (moved) {
      const other = await post('preview', {...body, values});
      if (other.superseded || other.rows !== curves.t.length) return;
      curves = {...curves, ...other, ghost_model: curves.model, ghost_error: curves.error};
    }
    if (!stack.current) return;
    if (now.current.alone) curves = {...curves, ghost_model: undefined, ghost_error: undefined};
    stack.current.levels.floor = curves.floor;
    const ghost = moved ? 'before' : state.beside ? state.beside.model : 'before';
    for (const i of [0, 1]) stack.current.rename(i, i === 0 ? 'ghost_model' : 'ghost_error', ghost);
    stack.current.label(0, 'position, ' + curves.position_unit);
    stack.current.label(1, 'error, ' + curves.unit);
    stack.current.label(2, 'command, ' + curves.command_unit);
    const whole = !(to > from);
    stack.current.show(curves, whole ? state.shown.from_s : from, whole ? state.shown.to_s : to,
                       fetched ? 3 : 2);
    rms(moved ? curves : null);
    element.current.dataset.drawn = String(+(element.current.dataset.drawn || 0) + 1);
  }, (message) => now.current.say(message)));

  const zoom = (from, to) => {
    const {shown} = now.current.state;
    if (from !== null && shown) {
      const span = to - from;  // moved into the record as a whole
      if (span > 0.999 * (shown.to_s - shown.from_s)) from = null;
      else if (from < shown.from_s) [from, to] = [shown.from_s, shown.from_s + span];
      else if (to > shown.to_s) [from, to] = [shown.to_s - span, shown.to_s];
    }
    view.current = from === null ? {from: 0, to: 0} : {from, to};
    setZoomed(from !== null);
    draw.current();
  };
  const leaveOut = (from, to) => {
    setMarking(false);
    const spans = [...now.current.state.ignored, from.toFixed(3) + ':' + to.toFixed(3)];
    now.current.act(() => post('ignore', {spans}));
  };
  useEffect(() => {
    stack.current = new PlotStack(element.current, SPECS, {onZoom: zoom, onBand: leaveOut});
    return () => { stack.current.end(); stack.current = null; };
  }, []);
  useEffect(() => zoom(null, null), [state.record]);
  useEffect(() => {
    stack.current.dragMeaning = marking ? 'band' : 'zoom';
  }, [marking]);
  useEffect(() => setSelected(0), [state.record, state.model, state.trial]);
  const region = shown && shown.regions[selected];
  useEffect(() => {
    stack.current.bands = [
      {spans: region ? region.spans : [], tone: 'region'},
      {spans: state.ignored.map((span) => span.split(':').map(Number)), tone: 'ignored'}];
    stack.current.repaint();
    draw.current();
  }, [state, selected, alone]);
  // At once, before anything else is drawn.
  const move = (values) => {
    now.current.values = values;
    draw.current();
  };
  return {selected, select: setSelected, now, move, view: html`
    <section class=${'plots' + (shown ? '' : ' empty')}>
      <p class="row tools">
        <button onClick=${() => zoom(null, null)} disabled=${!zoomed}>Whole record</button>
        <${ZoomButtons} turn=${(key) => stack.current.turn(key)} disabled=${!shown} />
        <button aria-pressed=${marking} onClick=${() => setMarking(!marking)} disabled=${!shown}>
          Leave out a stretch</button>
        ${zoomed && html`<button onClick=${() => leaveOut(view.current.from, view.current.to)}>
          Leave out what is shown</button>`}
        ${before && html`<button aria-pressed=${alone} onClick=${() => setAlone(!alone)}
          title="the axes then fit the model that is shown">Hide ${before}</button>`}
        <span class="hint">${marking ? 'drag over the stretch that must not count'
                                     : 'drag to zoom, double click for the whole record; keys: arrows + − 0; two fingers zoom'}</span>
      </p>
      <div class="stack" ref=${element}></div>
    </section>`};
}

function Progress({progress, running, cancel}) {
  if (!running) return null;
  const {text, done, of} = progress || {text: 'preparing', done: 0, of: 0};
  return html`
    <section class="progress" role="status">
      <progress aria-label="progress" max=${of || 1} ...${of ? {value: done} : {}}></progress>
      <p class="row"><button onClick=${cancel} title="what was found by then is kept">Cancel</button>
        <span>${text}</span></p>
    </section>`;
}

function Commands({commands, shown, preview}) {
  const text = [...commands.slice(-6), ...(shown ? [shown.command] : [])];
  if (text.length === 0) return null;
  return html`
    <section class="commands">
      <h2>The same by command line</h2>
      ${preview && html`<code class="now">${preview}</code>`}
      ${text.reverse().map((line) => html`<code>${line}</code>`)}
      <p class="hint">commands.sh in the folder holds them all.</p>
    </section>`;
}

function Exports({state, act, say}) {
  const report = () => act(async () => {
    const {file} = await post('report');
    say('The report is ' + file + '.');
  });
  const link = (name) => html`<a download=${name} href=${'/files/' + encodeURIComponent(name)}>${name}</a>`;
  if (!state.record && !state.model) return null;
  const reports = state.files.filter((f) => f.name.endsWith('.html')).slice(-3);
  return html`
    <section class="exports"><h2>Take away</h2>
      <p class="row"><button onClick=${report} disabled=${!state.shown}>Write a report</button></p>
      <ul>${[state.trial || state.model, state.record, ...reports.map((f) => f.name)]
        .filter(Boolean).map((name) => html`<li key=${name}>${link(name)}</li>`)}</ul>
    </section>`;
}

function AddEffect({effects, act, disabled}) {
  const absent = effects.filter((e) => !e.present);
  if (absent.length === 0) return null;
  return html`
    <label>Add an effect
      <select id="effect" disabled=${disabled} value="" onChange=${(e) => {
          const effect = e.target.value;
          e.target.value = '';
          act(() => post('add', {effect}));
        }}>
        <option value="">choose: it gets a typical size</option>
        ${absent.map((e) => html`<option value=${e.name} title=${e.equation}>${e.name}</option>`)}
      </select></label>`;
}

function useMedia(query) {
  const [list] = useState(() => matchMedia(query));
  const [matches, set] = useState(list.matches);
  useEffect(() => {
    const change = () => set(list.matches);
    list.addEventListener('change', change);
    return () => list.removeEventListener('change', change);
  }, []);
  return matches;
}

export function Workbench({state, progress}) {
  const [message, say] = useState(state.notice);
  const [asked, ask] = useState(null);  // {name, map, read}: a record whose columns are not understood
  const [values, setValues] = useState({});
  const [preview, setPreview] = useState(null);
  const act = async (work) => {
    try {
      say('');
      await work();
    } catch (error) {
      say(error.message);
    }
  };
  const plots = usePlots({state, values, rms: setPreview});
  Object.assign(plots.now.current, {act, say});
  const change = (values) => {
    setValues(values);
    plots.move(values);
  };
  const move = (values) => {
    say('');
    change(values);
  };
  useEffect(() => change({}), [state.model, state.trial, state.record]);
  const run = (what, body = {}) => act(() => post(what, body));
  // Without a third column it stands below the verdict.
  const narrow = useMedia('(max-width: 1180px)');
  const result = html`<${Result} result=${state.result} run=${run} running=${state.running}
                                record=${state.record} narrow=${!narrow} />`;
  const node = state.lineage.find((one) => one.model === state.model);
  return html`
    <main class="workbench">
      <div class="left">
        <${Files} state=${state} act=${act} ask=${ask} />
        <${Sliders} parameters=${state.shown ? state.parameters : []} values=${values}
                    set=${(name, value) => move({...plots.now.current.values, [name]: value})}
                    reset=${() => move({})} running=${state.running}
                    fit=${() => run('fit', {values})} rms=${preview && preview.rms} />
      </div>
      <div class="middle">
        ${message && html`<p class="message" role="alert">${message}
          <button class="plain" aria-label="close" onClick=${() => say('')}>×</button></p>`}
        <${ReadAs} asked=${asked} close=${() => { ask(null); say(''); }}
                   read=${(map) => act(async () => { await asked.read(map); ask(null); })} />
        <p class="printed">${state.record} against ${state.trial || state.model}</p>
        <${Welcome} state=${state} />
        <${Verdict} shown=${state.shown} trial=${state.trial} running=${state.running} act=${act}
                    selected=${plots.selected} select=${plots.select} />
        <${Progress} progress=${progress} running=${state.running} cancel=${() => run('cancel')} />
        ${narrow && result}
        <${SideBySide} beside=${state.beside} />
        <${Bands} ignored=${state.ignored} act=${act} />
        ${plots.view}
        <${Laws} state=${state} />
      </div>
      <div class="right">
        ${!narrow && result}
        <${Ladder} state=${state} open=${(name) => run('model', {name})}
                   beside=${(name) => run('beside', {name})} />
        ${state.model && html`<section class="next">
          <h2>Step by hand</h2>
          <${AddEffect} effects=${state.effects} act=${act} disabled=${state.running} />
          <p class="row"><button disabled=${state.running || !(state.trial || (node && node.parent))}
                                  onClick=${() => run('undo')}>
            ${state.trial ? 'Undo the trial' : 'Back one model'}</button></p>
        </section>`}
        <${Commands} commands=${state.commands} shown=${state.shown}
                     preview=${preview && preview.command} />
        <${Exports} state=${state} act=${act} say=${say} />
      </div>
    </main>`;
}
