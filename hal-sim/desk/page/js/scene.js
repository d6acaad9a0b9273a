// The stage as it is now, drawn at the screen's rate between the status messages.

import { fromBase, toBase } from "./frames.js";
import { drawCross, drawGhost, drawMechanism, drawNames, drawTrack, drawTrail, write } from "./mechanism.js";
import { colour } from "./theme.js";
import { fit, inSight, Plane } from "./view.js";

/** How far behind the drawing is, so that there is a message on either side of it, ms. */
const DELAY_MS = 50;
const TRAIL_POINTS = 4000;
const TRAIL_STEP_MM = 0.15;
/** Half of what is shown, track radii: the whole mechanism; the disk. */
const WHOLE = 1.72;
const CLOSER = 1.22;

export class Scene {
  trail = [];
  names = true;
  closer = false;
  #messages = [];

  constructor(canvas, stage, frames) {
    Object.assign(this, { canvas, stage, frames });
    stage.addEventListener("tick", () => this.#take(stage.now));
    stage.addEventListener("link", () => { this.#messages = []; this.trail = []; });
  }

  /** The place in the plane, mm, at so many pixels. */
  placeAt(x, y) {
    return this.#plane(this.canvas.clientWidth, this.canvas.clientHeight).place([x, y]);
  }

  #plane(width, height) {
    return new Plane(width, height, this.stage.geometry.radius * (this.closer ? CLOSER : WHOLE));
  }

  #take(now) {
    this.#messages.push({ at: performance.now(), ...now });
    if (this.#messages.length > 30) this.#messages.shift();
    const last = this.trail.at(-1);
    if (!this.stage.referenced) return;
    if (last && Math.hypot(now.centre[0] - last[0], now.centre[1] - last[1]) < TRAIL_STEP_MM) return;
    this.trail.push(now.centre);
    if (this.trail.length > TRAIL_POINTS) this.trail.shift();
  }

  /** The pose between the messages at this time. */
  #pose(at) {
    const all = this.#messages;
    const next = all.findIndex((message) => message.at >= at);
    if (next <= 0) return next === 0 ? all[0] : all.at(-1);
    const [a, b] = [all[next - 1], all[next]];
    const share = (at - a.at) / (b.at - a.at || 1);
    const mix = (from, to) => from + share * (to - from);
    return {
      centre: a.centre.map((value, i) => mix(value, b.centre[i])),
      deg: mix(a.deg, b.deg),
      pivots: a.pivots.map((value, i) => mix(value, b.pivots[i])),
    };
  }

  draw(aim) {
    if (!inSight(this.canvas)) return;
    const { context, width, height } = fit(this.canvas);
    const { stage } = this;
    const plane = this.#plane(width, height);
    context.clearRect(0, 0, width, height);
    drawTrack(context, plane, stage.geometry);
    drawTrail(context, plane, this.trail);
    const pose = this.#pose(performance.now() - DELAY_MS);
    if (pose && stage.referenced) this.#mechanism(context, plane, pose);
    if (aim) this.#aim(context, plane, aim);
  }

  #mechanism(context, plane, pose) {
    const { stage } = this;
    context.globalAlpha = stage.connected ? 1 : 0.35;
    drawMechanism(context, plane, stage.geometry, pose);
    if (stage.mode === "moving") {
      this.#target(context, plane);
    }
    if (!this.frames.plain && stage.measured) this.#frame(context, plane);
    if (this.names) drawNames(context, plane, stage.geometry, pose);
    context.globalAlpha = 1;
  }

  /** The platform's outline where it is going; where only the moved point's place is told, a cross. */
  #target(context, plane) {
    const { stage, frames } = this;
    const [x, y, deg] = stage.target;
    if (frames.plain) drawGhost(context, plane, stage.geometry, { centre: [x, y], deg }, colour("theta"));
    else drawCross(context, plane, toBase(frames.ground, [x, y]), 9, colour("theta"), 2);
  }

  /** The frame in force, and the point that is moved. */
  #frame(context, plane) {
    const { stage, frames } = this;
    const at = (x, y) => plane.pixel(toBase(frames.ground, [x, y]));
    for (const [name, x, y] of [["x", 25, 0], ["y", 0, 25]]) {
      context.beginPath();
      context.moveTo(...at(0, 0));
      context.lineTo(...at(x, y));
      context.strokeStyle = colour("warn");
      context.lineWidth = 2;
      context.stroke();
      write(context, name, ...at(x * 1.2, y * 1.2), colour("warn"));
    }
    if (!frames.moved) return;
    const [px, py] = plane.pixel(toBase(frames.ground, stage.measured));
    context.beginPath();
    context.arc(px, py, 6, 0, 2 * Math.PI);
    context.lineWidth = 2.5;
    context.stroke();
    write(context, "centre of rotation", px, py - 15, colour("warn"));
  }

  /** The place in the frame in force, mm, at so many pixels. */
  targetAt(x, y) {
    return fromBase(this.frames.ground, this.placeAt(x, y));
  }

  /** A place of the frame in force in the plane. */
  inPlane(place) {
    return toBase(this.frames.ground, place);
  }

  #aim(context, plane, { place, good }) {
    const paint = colour(good ? "act" : "faint");
    const at = this.inPlane(place);
    drawCross(context, plane, at, 12, paint, good ? 2.5 : 1.5);
    const [x, y] = plane.pixel(at);
    context.beginPath();
    context.arc(x, y, 8, 0, 2 * Math.PI);
    context.strokeStyle = paint;
    context.setLineDash(good ? [] : [3, 3]);
    context.stroke();
    context.setLineDash([]);
  }
}
