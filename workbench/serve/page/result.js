// What a diagnosis or a fit has found: words, the candidates with the error that each would reach,
// the law that was learned.
import {Law} from './laws.js';
import {html} from './preact.js';

function Candidates({result, run, running, record}) {
  if (!result.candidates || result.candidates.length === 0) return null;
  // Of each effect the round in which it does best.
  const best = new Map();
  for (const one of result.candidates) {
    const known = best.get(one.effect);
    if (!known || one.heldout_m < known.heldout_m) best.set(one.effect, one);
  }
  const rows = [...best.values()].sort((a, b) => a.heldout_m - b.heldout_m).slice(0, 8);
  const of_this = result.record === record;
  return html`
    <h3>What would help</h3>
    <table>
      <thead><tr><th>effect</th><th>would reach</th><th>by chance</th><th></th></tr></thead>
      <tbody>${rows.map((one) => html`
        <tr key=${one.effect}>
          <td>${one.effect}${one.round > 1 ? html` <small>round ${one.round}</small>` : ''}</td>
          <td class="n">${one.heldout}</td><td class="n">${one.chance}</td>
          <td><button disabled=${running || !of_this} aria-label=${'try ' + one.effect}
                      onClick=${() => run('diagnose', {only: one.only, model: result.model})}>Try</button></td>
        </tr>`)}</tbody>
    </table>
    ${!of_this && html`<p class="hint">Open ${result.record} to try them.</p>`}`;
}

function Steps({result}) {
  if (!result.steps || result.steps.length === 0) return null;
  return html`
    <h3>How the error falls</h3>
    <ol class="steps">${result.steps.map((step) => html`
      <li><span>${step.what}</span><b>${step.heldout}</b></li>`)}
      ${result.floors.map((floor) => html`
        <li class="floor"><span>${floor.what}</span><b>${floor.size}</b></li>`)}</ol>`;
}

function title({kind, only, model}) {
  if (kind === 'fit') return 'Fit';
  if (kind !== 'diagnosis') return 'Not done';
  return only.length ? 'Tried: ' + model + ' + ' + only.join(' + ') : 'Diagnosis of ' + model;
}

/// The newest result and, below one that is not of all effects, the diagnosis before it.
export function Result({result, run, running, record, narrow}) {
  if (!result) return null;
  return html`
    <section class=${'result ' + result.kind} role="status">
      <h2>${title(result)}</h2>
      ${result.interrupted && html`<p class="warn">Interrupted: the best so far.</p>`}
      <p class="words">${result.words}</p>
      ${result.kind === 'fit' && html`
        <p class="hint">The error is that of the blocks that were fitted; beside the verdict is that of the whole record.</p>`}
      ${result.unsaved && html`<p class="warn">Its model waits to be written: ${result.unsaved}</p>`}
      ${(result.laws || []).map((law) => html`
        <p class="law">${law.what || law.name}: <code>${law.formula}</code> ${law.values}</p>
        <${Law} law=${{...law.curve, title: law.name, key: 'the law'}} narrow=${narrow} />`)}
      <div class="answers"><div><${Steps} result=${result} /></div>
        <div>${!result.before && html`
          <${Candidates} result=${result} run=${run} running=${running} record=${record} />`}</div></div>
      ${result.remarks && result.remarks.length > 0 && html`
        <details><summary>More</summary>${result.remarks.map((line) => html`<p>${line}</p>`)}</details>`}
    </section>
    <${Result} result=${result.before} run=${run} running=${running} record=${record} narrow=${narrow} />`;
}
