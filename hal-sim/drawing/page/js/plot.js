// A plot of a few quantities over time. Each column of pixels shows everything between the lowest and the highest value in it.

import { placeOf } from "./envelope.js";
import { shown } from "./gcs.js";
import { colour } from "./theme.js";
import { ticks, widened } from "./ticks.js";
import { fit } from "./view.js";

const MARGIN = { left: 58, right: 10, top: 26, bottom: 22 };

export class Plot {
  /** `series`: [{ name, short, paint, channel }], the short name for narrow plots, `data`: an Envelope or the like. */
  constructor(canvas, { title, series, data, decimals = 2, symmetric = false }) {
    Object.assign(this, { canvas, title, series, data, decimals, symmetric });
  }

  /** The time at so many pixels from the canvas' left. */
  timeAt(x, [from, to]) {
    const width = this.canvas.clientWidth - MARGIN.left - MARGIN.right;
    const share = Math.min(Math.max((x - MARGIN.left) / width, 0), 1);
    return from + share * (to - from);
  }

  /** Draws what `view` shows. */
  draw(view) {
    const { context, width, height } = fit(this.canvas);
    context.clearRect(0, 0, width, height);
    const [from, to] = view.range;
    const frame = { left: MARGIN.left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
    const first = Math.max(0, placeOf(this.data.times, from) - 1);
    const last = Math.min(this.data.times.length, placeOf(this.data.times, to) + 1);
    const [low, high] = this.#range(first, last);
    const x = (time) => frame.left + ((time - from) / (to - from)) * (frame.right - frame.left);
    const y = (value) => frame.bottom - ((value - low) / (high - low)) * (frame.bottom - frame.top);
    this.#grid(context, frame, [from, to], [low, high], x, y);
    context.save();
    context.beginPath();
    context.rect(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
    context.clip();
    for (const one of this.series) this.#line(context, one, first, last, x, y);
    this.#marks(context, frame, view, x);
    context.restore();
    this.#legend(context, frame, view);
  }

  #range(first, last) {
    let [low, high] = [Infinity, -Infinity];
    for (const { channel } of this.series) {
      for (let i = first; i < last; i += 1) {
        if (this.data.low[channel][i] < low) low = this.data.low[channel][i];
        if (this.data.high[channel][i] > high) high = this.data.high[channel][i];
      }
    }
    if (this.symmetric && low <= high) {
      high = Math.max(-low, high);
      low = -high;
    }
    return widened(low, high);
  }

  #grid(context, frame, times, values, x, y) {
    context.fillStyle = colour("panel");
    context.fillRect(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
    context.lineWidth = 1;
    context.strokeStyle = colour("grid");
    context.fillStyle = colour("faint");
    context.font = "12px system-ui, sans-serif";
    context.beginPath();
    const up = ticks(...values, (frame.bottom - frame.top) / 28);
    context.textBaseline = "middle";
    context.textAlign = "right";
    for (const value of up.values) {
      const at = Math.round(y(value)) + 0.5;
      context.moveTo(frame.left, at);
      context.lineTo(frame.right, at);
      context.fillText(shown(value, up.decimals), frame.left - 6, at);
    }
    const along = ticks(...times, (frame.right - frame.left) / 80);
    context.textBaseline = "top";
    context.textAlign = "center";
    for (const value of along.values) {
      // Before the controller's start there is nothing.
      if (value < 0) continue;
      const at = Math.round(x(value)) + 0.5;
      context.moveTo(at, frame.top);
      context.lineTo(at, frame.bottom);
      if (at < frame.right - 18) context.fillText(shown(value, along.decimals), at, frame.bottom + 5);
    }
    context.stroke();
    context.textAlign = "right";
    context.fillText("s", frame.right, frame.bottom + 5);
    context.strokeStyle = colour("line");
    context.strokeRect(frame.left + 0.5, frame.top + 0.5, frame.right - frame.left - 1, frame.bottom - frame.top - 1);
  }

  #line(context, { channel, paint }, first, last, x, y) {
    const { times, low, high } = this.data;
    context.strokeStyle = colour(paint);
    context.lineWidth = 1.4;
    context.lineJoin = "round";
    context.beginPath();
    let down = false;
    for (let i = first; i < last;) {
      // All stretches that share a column of pixels.
      const at = x(times[i]);
      const column = Math.floor(at);
      let [least, most, end] = [Infinity, -Infinity, NaN];
      let broken = false;
      for (; i < last && Math.floor(x(times[i])) === column; i += 1) {
        if (Number.isNaN(low[channel][i])) { broken = true; continue; }
        least = Math.min(least, low[channel][i]);
        most = Math.max(most, high[channel][i]);
        end = (low[channel][i] + high[channel][i]) / 2;
      }
      if (least <= most) {
        if (down) context.lineTo(at, y(most));
        else context.moveTo(at, y(most));
        context.lineTo(at, y(least));
        context.lineTo(at, y(end));
        down = true;
      }
      if (broken) down = false;
    }
    context.stroke();
  }

  #marks(context, frame, view, x) {
    if (view.selection) {
      const [a, b] = view.selection.map(x);
      context.globalAlpha = 0.15;
      context.fillStyle = colour("act");
      context.fillRect(Math.min(a, b), frame.top, Math.abs(b - a), frame.bottom - frame.top);
      context.globalAlpha = 1;
    }
    if (view.cursor === null) return;
    const at = x(view.cursor);
    context.strokeStyle = colour("ink");
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(at, frame.top);
    context.lineTo(at, frame.bottom);
    context.stroke();
  }

  #legend(context, frame, view) {
    context.textBaseline = "middle";
    context.textAlign = "left";
    context.font = "600 13px system-ui, sans-serif";
    context.fillStyle = colour("ink");
    context.fillText(this.title, 2, 12);
    const titleEnd = 2 + context.measureText(this.title).width;
    let right = frame.right;
    context.textAlign = "right";
    context.font = "12px system-ui, sans-serif";
    const whole = (one) => `${one.name}${this.#valueText(one, view)}`;
    const wanted = this.series.reduce((sum, one) => sum + context.measureText(whole(one)).width + 31, 0);
    const narrow = wanted > frame.right - titleEnd;
    for (const one of [...this.series].reverse()) {
      const text = narrow ? one.short ?? one.name : whole(one);
      context.fillStyle = colour("ink");
      context.fillText(text, right, 12);
      right -= context.measureText(text).width + 5;
      context.fillStyle = colour(one.paint);
      context.fillRect(right - 14, 10, 14, 4);
      right -= 26;
    }
  }

  #valueText({ channel }, view) {
    if (view.cursor === null || this.data.times.length === 0 || this.canvas.clientWidth < 560) return "";
    const place = Math.min(placeOf(this.data.times, view.cursor), this.data.times.length - 1);
    const [low, high] = [this.data.low[channel][place], this.data.high[channel][place]].map((v) => shown(v, this.decimals));
    return low === high ? ` ${low}` : ` ${low} … ${high}`;
  }
}
