// A canvas in millimetres or in pixels, sharp on every screen.

/** Whether any of an element is on the screen: nobody needs to draw what nobody sees. */
export function inSight(element) {
  const { top, bottom, width } = element.getBoundingClientRect();
  return width > 0 && bottom > 0 && top < innerHeight;
}

/** Fits the canvas' pixels to the screen's; the context, scaled to CSS pixels, and the size in them. */
export function fit(canvas) {
  const ratio = devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

/** The stage's plane on a canvas: millimetres, y upwards, about the track's centre. */
export class Plane {
  constructor(width, height, reachMm) {
    this.scale = Math.min(width, height) / (2 * reachMm);
    this.centre = [width / 2, height / 2];
  }

  pixel([x, y]) {
    return [this.centre[0] + x * this.scale, this.centre[1] - y * this.scale];
  }

  place([px, py]) {
    return [(px - this.centre[0]) / this.scale, (this.centre[1] - py) / this.scale];
  }
}
