// Parameters as sliders: every move is simulated at once, and nothing is kept until it is fitted. The
// server says in which unit each is shown: value = in_si * shown number.
import {html} from './preact.js';

const STEPS = 1000;

// The place of a value on its slider and back.
function place({low, high, logarithmic}, value) {
  const share = logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(STEPS * Math.min(1, Math.max(0, share)));
}

function valueAt({low, high, logarithmic}, at) {
  const share = at / STEPS;
  const value = logarithmic ? low * (high / low) ** share : low + share * (high - low);
  return +value.toPrecision(5);
}

// Four digits, with a power of ten where that is shorter.
const text = (value) => {
  const plain = String(+value.toPrecision(4));
  return plain.length <= 8 ? plain : value.toExponential(3).replace(/\.?0+e/, 'e').replace('e+', 'e');
};

function Slider({parameter, value, set}) {
  const moved = value !== undefined && value !== parameter.value;
  const now = value === undefined ? parameter.value : value;
  const id = 'parameter-' + parameter.name;
  const printed = (value) => text(value / parameter.in_si);
  const [low, high] = [parameter.low, parameter.high].map(printed);
  const take = (input) => {
    const typed = input.value.trim() === '' ? NaN : Number(input.value.replace(',', '.'));
    if (Number.isFinite(typed)) set(parameter.name, +(typed * parameter.in_si).toPrecision(12));
    else input.value = printed(now);
  };
  return html`
    <li class=${moved ? 'moved' : ''}>
      <label for=${id} title=${parameter.what + '; slider: ' + low + ' to ' + high + ' ' + parameter.unit}>
        ${parameter.effect ? parameter.effect + ': ' : ''}${parameter.words}</label>
      <input inputmode="decimal" aria-label=${parameter.words + ' as a number, ' + parameter.unit} value=${printed(now)}
             onChange=${(e) => take(e.target)} />
      <span class="unit">${parameter.unit}</span>
      <input id=${id} type="range" min="0" max=${STEPS} value=${place(parameter, now)}
             aria-valuetext=${printed(now) + ' ' + parameter.unit}
             style=${{'--share': place(parameter, now) / STEPS}}
             onInput=${(e) => set(parameter.name, valueAt(parameter, +e.target.value))} />
    </li>`;
}

export function Sliders({parameters, values, set, reset, fit, running, rms}) {
  if (parameters.length === 0) return null;
  const moved = Object.keys(values).length > 0;
  return html`
    <section class="sliders">
      <h2>Parameters</h2>
      <ul>${parameters.map((p) => html`
        <${Slider} key=${p.name} parameter=${p} value=${values[p.name]} set=${set} />`)}</ul>
      <p class="row">
        <button onClick=${reset} disabled=${!moved}>Reset</button>
        <button onClick=${fit} disabled=${running}>${moved ? 'Fit from here' : 'Fit'}</button>
        <output class="preview">${moved && rms ? 'error ' + rms : ''}</output>
      </p>
    </section>`;
}
