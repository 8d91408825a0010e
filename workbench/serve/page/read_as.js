// A record whose columns the reader could not tell: which they are, proposed where it has a proposal,
// to be put right and read again.
import {html, useRef} from './preact.js';

/// The mapping that a refusal proposes; null: the refusal is about something else.
export function proposal(refusal) {
  if (!refusal.includes('--map')) return null;
  const found = /--map (?:'([^']*=[^']*)'|(\S+=\S+))/.exec(refusal);
  return found ? found[1] || found[2] : 't=COLUMN[s],u=COLUMN[V],y=COLUMN[mm]';
}

/// asked: {name, map}; read(map) reads the record so, close() gives up.
export function ReadAs({asked, read, close}) {
  const input = useRef();
  if (!asked) return null;
  return html`
    <form class="read-as" key=${asked.name} onSubmit=${(e) => { e.preventDefault(); read(input.current.value); }}>
      <label for="map">Columns of <b>${asked.name}</b>: t is the time, u the command, y the position</label>
      <input id="map" ref=${input} defaultValue=${asked.map} spellcheck=${false} autocomplete="off" />
      <p class="row"><button class="main">Read it so</button>
        <button type="button" onClick=${close}>Leave it</button>
        <span class="hint">for example t=Time [s],u=Valve*10[V],y=-Pos[mm]</span></p>
    </form>`;
}
