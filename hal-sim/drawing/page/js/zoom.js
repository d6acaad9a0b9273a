// The stretch of time that plots show together, and the cursor in it.

export class TimeView extends EventTarget {
  constructor(from, to) {
    super();
    this.whole = [from, to];
    this.range = [from, to];
    this.cursor = null;
    /** The stretch being dragged over. */
    this.selection = null;
    /** Nothing new is taken in. */
    this.frozen = false;
    /** The cursor runs by itself. */
    this.playing = false;
    /** It stays where it is when the pointer leaves. */
    this.keepsCursor = false;
  }

  /** Shows all there is. */
  all() {
    this.show(...this.whole);
  }

  show(from, to) {
    const [first, last] = this.whole;
    const span = Math.min(Math.max(to - from, 1e-3), last - first || 1);
    const start = Math.min(Math.max(from, first), Math.max(first, last - span));
    this.range = [start, start + span];
    this.#changed();
  }

  /** Makes the shown stretch `factor` times as long, about a time in it. */
  zoom(factor, about = (this.range[0] + this.range[1]) / 2) {
    const [from, to] = this.range;
    this.show(about + (from - about) * factor, about + (to - about) * factor);
  }

  /** Goes on by a share of what is shown. */
  pan(share) {
    const [from, to] = this.range;
    this.show(from + share * (to - from), to + share * (to - from));
  }

  point(time) {
    this.cursor = time;
    this.#changed();
  }

  #changed() {
    this.dispatchEvent(new Event("change"));
  }
}

/** Has pointer, wheel and keys on a plot zoom and pan; `timeAt` turns a place in it, px, into a time. */
export function control(canvas, view, timeAt) {
  let begun = null;
  const at = (event) => timeAt(event.clientX - canvas.getBoundingClientRect().left);
  canvas.addEventListener("pointerdown", (event) => {
    begun = { x: event.clientX, time: at(event) };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    view.selection = begun && Math.abs(event.clientX - begun.x) > 6 ? [begun.time, at(event)] : null;
    if (!view.playing) view.point(at(event));
  });
  canvas.addEventListener("pointerleave", () => { if (!view.keepsCursor) view.point(null); });
  canvas.addEventListener("pointerup", (event) => {
    const chosen = view.selection;
    begun = view.selection = null;
    if (chosen) view.show(Math.min(...chosen), Math.max(...chosen));
    else view.point(at(event));
  });
  canvas.addEventListener("pointercancel", () => { begun = view.selection = null; });
  canvas.addEventListener("dblclick", () => view.all());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.zoom(event.deltaY > 0 ? 1.25 : 0.8, at(event));
  }, { passive: false });
  const keys = {
    "+": () => view.zoom(0.7), "-": () => view.zoom(1 / 0.7), "0": () => view.all(),
    ArrowLeft: () => view.pan(-0.2), ArrowRight: () => view.pan(0.2),
  };
  canvas.addEventListener("keydown", (event) => {
    const act = keys[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act();
  });
}
