// Plots by finger: one moves what is shown, or marks a stretch; two bring it nearer or farther.

/// Lets fingers move `plot`. range(): the shown [from, to]; zoom(from, to); marks(): whether a finger
/// marks; mark(from, to).
export function byFinger(plot, {range, zoom, marks, mark}) {
  const over = plot.over, fingers = new Map();
  let begun = null, wanted = null;
  over.style.touchAction = 'pan-y';
  const at = (event) => event.clientX - over.getBoundingClientRect().left;
  const begin = () => {
    const shown = range();
    begun = shown && {from: shown[0], to: shown[1], places: [...fingers.values()]};
  };
  const show = (from, to) => {
    const waits = wanted;
    wanted = [from, to];
    if (!waits) requestAnimationFrame(() => { const now = wanted; wanted = null; zoom(...now); });
  };
  const move = () => {
    const places = [...fingers.values()], width = over.clientWidth;
    if (!begun || !width) return;
    const perPixel = (begun.to - begun.from) / width;
    if (places.length === 2) {
      // what each finger touched stays beneath it
      const [a, b] = begun.places, scale = perPixel * (b - a) / (places[1] - places[0]);
      if (!(scale > 0) || !Number.isFinite(scale)) return;
      const from = begun.from + a * perPixel - places[0] * scale;
      show(from, from + width * scale);
    } else if (marks()) {
      const [from, to] = [begun.places[0], places[0]].sort((a, b) => a - b);
      plot.setSelect({left: from, top: 0, width: to - from, height: over.clientHeight}, false);
    } else {
      const by = (begun.places[0] - places[0]) * perPixel;
      show(begun.from + by, begun.to + by);
    }
  };
  const end = (event) => {
    if (!fingers.delete(event.pointerId)) return;
    const {left, width} = plot.select;
    if (event.type === 'pointerup' && begun && marks() && width >= 5) {
      mark(plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x'));
    }
    plot.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
    begin();
  };
  over.addEventListener('pointerdown', (event) => {
    if (event.pointerType !== 'touch' || fingers.size === 2) return;
    over.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    begin();
  });
  over.addEventListener('pointermove', (event) => {
    if (!fingers.has(event.pointerId)) return;
    fingers.set(event.pointerId, at(event));
    move();
  });
  for (const name of ['pointerup', 'pointercancel']) over.addEventListener(name, end);
}
