// Theta by a handle outside the track, dragged or by keys: the outline shows what it would be; letting go turns the stage.

import { byId, report, setText } from "./dom.js";
import { plain, shown } from "./gcs.js";

const DEG = Math.PI / 180;
/** Where the handle is, track radii from the middle. */
const AT = 1.4;
const AT_CLOSER = 1.1;
const KEYS = { ArrowLeft: 1, ArrowUp: 1, ArrowRight: -1, ArrowDown: -1, PageUp: 15, PageDown: -15 };

export class Dial {
  /** Orientation that is being chosen, deg, in the frame in force; null: none. */
  wanted = null;
  #before = 0;
  #shown = "";

  constructor(stage, scene) {
    Object.assign(this, { stage, scene, handle: byId("dial"), said: byId("said"), aim: byId("aim") });
    const { handle } = this;
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      this.#before = this.#degAt(event);
      this.wanted = this.#target;
    });
    handle.addEventListener("pointermove", (event) => { if (handle.hasPointerCapture(event.pointerId)) this.#drag(event); });
    handle.addEventListener("pointerup", () => this.#release());
    handle.addEventListener("pointercancel", () => { this.wanted = null; });
    handle.addEventListener("keydown", (event) => this.#key(event));
    handle.addEventListener("blur", () => { this.wanted = null; });
    // Who stops does not want to turn.
    addEventListener("keydown", ({ key }) => { if (key === "Escape") this.wanted = null; }, { capture: true });
  }

  get #target() {
    return this.stage.target?.[2] ?? 0;
  }

  /** Direction of the pointer from the track's middle, deg, upwards. */
  #degAt({ clientX, clientY }) {
    const { left, top } = this.scene.canvas.getBoundingClientRect();
    const [x, y] = this.scene.placeAt(clientX - left, clientY - top);
    return Math.atan2(y, x) / DEG;
  }

  #drag(event) {
    if (this.wanted === null) return;
    const deg = this.#degAt(event);
    // The short way from the last: so it may go round more than once.
    this.wanted += ((deg - this.#before + 540) % 360 + 360) % 360 - 180;
    this.#before = deg;
    this.#tell("let go to turn");
  }

  #key(event) {
    const { key } = event;
    if (key === "Enter" && this.wanted !== null) this.#release();
    if (!KEYS[key]) return;
    event.preventDefault();
    this.wanted = Math.round((this.wanted ?? this.#target) + KEYS[key]);
    this.#tell("Enter turns");
  }

  #tell(how) {
    this.aim.className = "";
    setText(this.aim, `θ ${shown(this.wanted, 1)}°: ${how}`);
  }

  #release() {
    const { wanted } = this;
    this.wanted = null;
    if (wanted === null || Math.abs(wanted - this.#target) < 0.05) return;
    report(this.said, () => this.stage.link.ask(`MOV W ${plain(Math.round(wanted * 10) / 10)}`), "on its way");
  }

  /** Puts the handle where the orientation is: the chosen one, or the target. */
  draw() {
    const { stage, scene, handle } = this;
    const hidden = !stage.referenced || !stage.target;
    if (handle.hidden !== hidden) handle.hidden = hidden;
    if (hidden) return;
    const w = this.wanted ?? this.#target;
    const deg = scene.frames.ground.deg + w;
    const far = stage.geometry.radius * (scene.closer ? AT_CLOSER : AT);
    const [x, y] = scene.pixelOf([far * Math.cos(deg * DEG), far * Math.sin(deg * DEG)]).map((px) => Math.round(px * 10) / 10);
    const now = `${x},${y},${w.toFixed(2)}`;
    if (now === this.#shown) return;
    this.#shown = now;
    handle.style.left = `${x}px`;
    handle.style.top = `${y}px`;
    handle.setAttribute("aria-valuenow", w.toFixed(1));
    handle.setAttribute("aria-valuetext", `${w.toFixed(1)} degrees`);
  }
}
