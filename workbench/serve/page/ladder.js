// The models of the session as a tree, each with its error on samples that were not fitted, falling
// towards what the sensor leaves.
import {html} from './preact.js';

// Share of the bar's width, on a logarithmic scale from half the floor to the worst error.
function share(value, floor, worst) {
  const low = Math.log((floor > 0 ? floor : worst * 1e-4) / 2), high = Math.log(worst * 1.2);
  return Math.max(0.02, Math.min(1, (Math.log(value) - low) / (high - low)));
}

// Parents before children, children indented.
function tree(nodes) {
  const out = [], known = new Set(nodes.map((node) => node.model));
  const add = (node, depth) => {
    if (depth > 20) return;
    out.push({...node, depth});
    nodes.filter((n) => n.parent === node.model).forEach((n) => add(n, depth + 1));
  };
  nodes.filter((n) => !n.parent || !known.has(n.parent)).forEach((n) => add(n, 0));
  return out;
}

export function Ladder({state, open, beside}) {
  const nodes = tree(state.lineage.filter((n) => n.record === state.record || n.model === state.model));
  const errors = nodes.map((n) => n.heldout_m).filter((v) => v > 0);
  if (errors.length === 0) return null;
  const floor = Math.max(...nodes.map((n) => n.noise_floor_m || 0));
  const worst = Math.max(...errors);
  return html`
    <section class="ladder">
      <h2>Models and their error</h2>
      <p class="hint">On blocks that were not fitted; logarithmic. The line is the noise floor.</p>
      <ol>${nodes.map((node) => html`
        <li key=${node.model} style=${{'--depth': Math.min(node.depth, 6)}} class=${
          (node.depth ? 'child ' : '') + (node.model === state.trial ? 'trial' :
          node.model === state.model ? 'current' : '')}>
          <button class="plain" onClick=${() => open(node.model)}
                  aria-current=${node.model === state.model}>${node.model}</button>
          ${node.model !== (state.trial || state.model) && html`
            <button class="beside" aria-pressed=${Boolean(state.beside) && state.beside.model === node.model}
                    onClick=${() => beside(state.beside && state.beside.model === node.model ? '' : node.model)}
                    aria-label=${'beside ' + node.model}>beside</button>`}
          <span class="what">${node.model === state.trial ? 'trial: ' : ''}${node.what}</span>
          ${node.heldout_m > 0 && html`
            <span class="bar"><i style=${{width: 100 * share(node.heldout_m, floor, worst) + '%'}}></i>
              ${floor > 0 && html`<b style=${{left: 100 * share(floor, floor, worst) + '%'}}></b>`}</span>
            <span class="error">${node.heldout}</span>`}
        </li>`)}</ol>
    </section>`;
}
