// The stage as it is now, drawn at the screen's rate between the status messages.

import { fromBase, toBase } from "./frames.js";
import { drawCross, drawGhost, drawMechanism, drawNames, drawTrack, drawTrail, write } from "./mechanism.js";
import { remember, remembered } from "./remembered.js";
import { colour, onColours } from "./theme.js";
import { fit, inSight, Plane } from "./view.js";

/** How far behind the drawing is, so that there is a message on either side of it, ms. */
const DELAY_MS = 50;
const TRAIL_POINTS = 4000;
const TRAIL_STEP_MM = 0.15;
/** Half of what is shown, track radii: the whole mechanism; the disk. */
const WHOLE = 1.72;
const CLOSER = 1.22;

export class Scene {
  trail = remembered("trail", []);
  names = remembered("names", true);
  closer = remembered("closer", false);
  #messages = [];
  #drawn = "";

  constructor(canvas, stage, frames, limits) {
    Object.assign(this, { canvas, stage, frames, limits });
    stage.addEventListener("tick", () => this.#take(stage.now));
    stage.addEventListener("link", () => { this.#messages = []; });
    onColours(() => { this.#drawn = ""; });
    addEventListener("pagehide", () => remember("trail", this.trail));
  }

  /** Where a place of the plane is on the canvas, pixels. */
  pixelOf(place) {
    return this.#plane(this.canvas.clientWidth, this.canvas.clientHeight).pixel(place);
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
    this.trail.push(now.centre.map((mm) => Math.round(mm * 100) / 100));
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

  /** Draws what differs from what is there; nothing, where nothing does. */
  draw(aim, turned) {
    if (!inSight(this.canvas)) return;
    const pose = this.#pose(performance.now() - DELAY_MS);
    const key = this.#key(pose, aim, turned);
    if (key === this.#drawn) return;
    this.#drawn = key;
    const { context, width, height } = fit(this.canvas);
    const { stage } = this;
    const plane = this.#plane(width, height);
    context.clearRect(0, 0, width, height);
    drawTrack(context, plane, stage.geometry);
    drawTrail(context, plane, this.trail);
    if (pose && stage.referenced) this.#mechanism(context, plane, pose);
    if (this.limits.matter) this.#softLimits(context, plane);
    if (turned !== null && stage.target) this.#turned(context, plane, turned);
    if (aim) this.#aim(context, plane, aim);
  }

  /** All that the picture depends on, as finely as it shows. */
  #key(pose, aim, turned) {
    const { stage, frames, limits, canvas, trail } = this;
    const fine = (values) => values.map((value) => Math.round(value * 100));
    return JSON.stringify([
      canvas.clientWidth, canvas.clientHeight, devicePixelRatio, this.names, this.closer, stage.geometry,
      stage.referenced, stage.mode === "moving", pose && [fine(pose.centre), fine([pose.deg]), fine(pose.pivots)],
      stage.mode === "moving" && stage.target, frames.plain, frames.ground, frames.moved, frames.moved && fine(stage.measured ?? []),
      limits.x, limits.y, trail.length, trail.at(-1), trail[0], aim, turned,
    ]);
  }

  #mechanism(context, plane, pose) {
    const { stage } = this;
    drawMechanism(context, plane, stage.geometry, pose);
    if (stage.mode === "moving") {
      this.#target(context, plane);
    }
    if (!this.frames.plain && stage.measured) this.#frame(context, plane);
    if (this.names) drawNames(context, plane, stage.geometry, pose);
  }

  /** Where the moved point may be, along the axes of the base frame. */
  #softLimits(context, plane) {
    const far = 2 * this.stage.geometry.radius;
    const { x, y } = this.limits;
    const [[left, right], [low, high]] = [x ?? [-far, far], y ?? [-far, far]];
    const [x1, y1] = plane.pixel([left, high]);
    const [x2, y2] = plane.pixel([right, low]);
    context.setLineDash([8, 3, 2, 3]);
    context.strokeStyle = colour("bad");
    context.lineWidth = 1.5;
    context.strokeRect(x1, y1, x2 - x1, y2 - y1);
    context.setLineDash([]);
    const [tx, ty] = plane.pixel([Math.max(left, -0.6 * far), Math.max(low, -0.6 * far)]);
    write(context, "soft limits", tx, ty + 11, colour("bad"), undefined, "left");
  }

  /** The platform's outline as it would be turned. */
  #turned(context, plane, turned) {
    const { stage, frames } = this;
    const [x, y] = stage.target;
    const at = frames.plain ? [x, y] : stage.now.centre;
    drawGhost(context, plane, stage.geometry, { centre: at, deg: frames.ground.deg + turned }, colour("theta"));
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
    context.strokeStyle = colour("warn");
    const [px, py] = plane.pixel(toBase(frames.ground, stage.measured));
    context.beginPath();
    context.arc(px, py, 6, 0, 2 * Math.PI);
    context.lineWidth = 2.5;
    context.stroke();
    write(context, frames.tool ? "tool point" : "centre of rotation", px, py - 15, colour("warn"));
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
