// A report: the run's data, its plots, and the run played back at the cursor.

const run = JSON.parse(byId("run").textContent);
const unpacked = (text) => new Float32Array(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
const data = {
  times: unpacked(run.times),
  low: run.channels.map(([low]) => unpacked(low)),
  high: run.channels.map(([, high]) => unpacked(high)),
};
const [first, last] = [data.times[0] ?? 0, data.times.at(-1) ?? 1];
const view = new TimeView(first, last);
view.keepsCursor = true;

const pivots = (from) => [1, 2, 3].map((number) => ({ name: `pivot ${number}`, short: String(number), paint: `pivot-${number}`, channel: from + number - 1 }));
const plots = [
  { title: "Centre, mm", series: [{ name: "x", paint: "x", channel: 0 }, { name: "y", paint: "y", channel: 1 }], decimals: 3 },
  { title: "Orientation θ, °", series: [{ name: "θ", paint: "theta", channel: 2 }], decimals: 3 },
  { title: "Error of the centre, µm", series: [{ name: "true pose", paint: "steel", channel: 5 }, { name: "following, by the encoders", paint: "centre", channel: 3 }], decimals: 3 },
  { title: "Error of θ, µrad", series: [{ name: "true pose", paint: "steel", channel: 6 }, { name: "following, by the encoders", paint: "theta", channel: 4 }], decimals: 2 },
  { title: "Speed of the moved point, mm/s", series: [{ name: "set", paint: "centre", channel: 7 }], decimals: 1 },
  { title: "Rate of θ, °/s", series: [{ name: "set", paint: "theta", channel: 8 }], decimals: 1 },
  { title: "Pivots on the track, °", series: pivots(9), decimals: 2 },
  { title: "Rates of the pivots, rad/s", series: pivots(12), decimals: 2 },
  { title: "Duty of the motors", series: pivots(15), decimals: 3 },
].map((what) => {
  const canvas = make("canvas", { className: "plot", tabIndex: 0, role: "img", "aria-label": `${what.title}, over time` });
  byId("plots").append(canvas);
  const plot = new Plot(canvas, { ...what, data });
  control(canvas, view, (x) => plot.timeAt(x, view.range));
  return plot;
});

/** The pose at the cursor, inside the lowest and highest of its stretch: what the plots say there. */
function poseAt(time) {
  const value = (channel) => valueAt(data, channel, time);
  return { centre: [value(0), value(1)], deg: value(2), pivots: [value(9), value(10), value(11)] };
}

/** Where the centre has been up to a time. */
function trailTo(time) {
  const end = placeOf(data.times, time);
  const step = Math.max(1, Math.floor(end / 3000));
  const points = [];
  for (let i = 0; i < end; i += step) points.push([(data.low[0][i] + data.high[0][i]) / 2, (data.low[1][i] + data.high[1][i]) / 2]);
  return points;
}

function drawScene() {
  const { context, width, height } = fit(byId("scene"));
  const plane = new Plane(width, height, 1.85 * run.geometry.radius);
  context.clearRect(0, 0, width, height);
  drawTrack(context, plane, run.geometry);
  if (data.times.length === 0) return;
  const pose = poseAt(view.cursor);
  drawTrail(context, plane, [...trailTo(view.cursor), pose.centre]);
  drawMechanism(context, plane, run.geometry, pose);
  if (byId("names").checked) drawNames(context, plane, run.geometry, pose);
  const [x, y] = pose.centre.map((mm) => shown(mm, 3));
  setText(byId("pose"), `x ${x} mm  y ${y} mm  θ ${shown(pose.deg, 3)}°`);
}

let stale = true;
const slider = byId("time");
Object.assign(slider, { min: first, max: last, value: first });
slider.addEventListener("input", () => view.point(Number(slider.value)));
view.addEventListener("change", () => {
  slider.value = view.cursor;
  setText(byId("now"), `${view.cursor.toFixed(3)} s`);
  setText(byId("shown"), view.range.map((time) => time.toFixed(3)).join(" to ") + " s");
  stale = true;
});

const play = byId("play");
play.addEventListener("click", () => {
  view.playing = !view.playing;
  if (view.playing && view.cursor >= last) view.cursor = first;
  play.setAttribute("aria-pressed", String(view.playing));
  setText(play, view.playing ? "❚❚ Pause" : "▶ Play");
});
for (const button of document.querySelectorAll("[data-zoom]")) {
  const acts = { in: () => view.zoom(0.5, view.cursor), out: () => view.zoom(2, view.cursor), all: () => view.all() };
  button.addEventListener("click", acts[button.dataset.zoom]);
}
byId("names").addEventListener("change", () => { stale = true; });
byId("theme").addEventListener("click", switchTheme);
onColours(() => { stale = true; });
addEventListener("resize", () => { stale = true; });

setText(byId("name"), run.name);
setText(byId("conditions"), run.conditions);
setText(byId("summary"), run.summary);
setText(byId("span-text"), `${run.moves.length} moves, ${(last - first).toFixed(2)} s, ${run.ticks.toLocaleString("en")} ticks of the control loop`);
const heads = ["", "start s", "x mm", "y mm", "θ °", "profile s", "settle ms"].map((text) => make("th", { scope: "col", textContent: text }));
byId("moves").append(make("tr", {}, ...heads), ...run.moves.map((move, index) => {
  const show = make("button", { type: "button", textContent: String(index + 1), "aria-label": `Show move ${index + 1}` });
  show.addEventListener("click", () => {
    const room = 0.1 * (move.end_s - move.start_s) + 0.02;
    view.show(move.start_s - room, move.end_s + room);
    view.point(move.start_s);
  });
  const unsettled = move.never ? "never" : "no time";
  const settled = move.settle_ms === null ? unsettled : shown(move.settle_ms, 2);
  const cells = [shown(move.start_s, 3), ...move.target.map((value) => shown(value, 3)), shown(move.end_s - move.start_s, 4), settled];
  return make("tr", {}, make("td", {}, show), ...cells.map((text) => make("td", { textContent: text })));
}));

view.point(first);

let before = performance.now();
function frame(now) {
  if (view.playing) {
    const next = view.cursor + ((now - before) / 1000) * Number(byId("rate").value);
    if (next >= last) play.click();
    view.point(Math.min(next, last));
  }
  before = now;
  if (stale) {
    stale = false;
    drawScene();
    for (const plot of plots) plot.draw(view);
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
