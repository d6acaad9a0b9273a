// The page: what belongs together is brought together, and everything is drawn at the screen's rate.

import { Aim } from "./aim.js";
import { announce } from "./announce.js";
import { Calibration } from "./calibration.js";
import { commandHelp } from "./commands.js";
import { Commissioning } from "./commissioning.js";
import { commandLine } from "./console.js";
import { Dial } from "./dial.js";
import { byId } from "./dom.js";
import { events } from "./events.js";
import { drive } from "./drive.js";
import { log } from "./log.js";
import { Operator } from "./operator.js";
import { steps } from "./jog.js";
import { framePanel, Frames } from "./frames.js";
import { Lesson } from "./lesson.js";
import { Link } from "./link.js";
import { macros } from "./macros.js";
import { ownership } from "./ownership.js";
import { parameters } from "./parameters.js";
import { places } from "./places.js";
import { Recorder } from "./recorder.js";
import { recovery } from "./recovery.js";
import { remember, remembered } from "./remembered.js";
import { Scene } from "./scene.js";
import { Scope } from "./scope.js";
import { SequencePanel } from "./sequence.js";
import { Stage } from "./stage.js";
import { SoftLimits } from "./soft-limits.js";
import { FirstMove } from "./first-move.js";
import { showStale } from "./stale.js";
import { statistics } from "./statistics.js";
import { showState } from "./state.js";
import { stopping } from "./stop.js";
import { switchTheme } from "./theme.js";
import { Tuning } from "./tuning.js";

const stage = new Stage(new Link());
const frames = new Frames(stage);
const scene = new Scene(byId("scene"), stage, frames, new SoftLimits(stage));
const dial = new Dial(stage, scene);
const aim = new Aim(stage, scene);
const scope = new Scope(stage);
const lesson = new Lesson();
stopping(stage);
showStale(stage);
showState(stage);
const firstMove = new FirstMove(stage);
const operator = new Operator(stage.link);
log(operator, stage.link);
new SequencePanel(operator, firstMove);
const commissioning = new Commissioning(operator, firstMove);
new Calibration(operator, firstMove);
new Tuning(operator, firstMove);
drive(stage);
steps(stage);
ownership(stage);
recovery(stage);
parameters(stage);
new Recorder(stage);
statistics(stage);
events(stage);
macros(stage, operator);
places(stage);
commandHelp(stage);
announce(stage);
framePanel(stage);
commandLine(stage);

const labels = byId("labels");
labels.checked = scene.names;
labels.addEventListener("change", () => {
  scene.names = labels.checked;
  remember("names", scene.names);
});
byId("clear-trail").addEventListener("click", () => { scene.trail = []; });
const closer = byId("closer");
closer.setAttribute("aria-pressed", String(scene.closer));
closer.addEventListener("click", () => {
  scene.closer = !scene.closer;
  closer.setAttribute("aria-pressed", String(scene.closer));
  remember("closer", scene.closer);
});
// What was chosen before the last reload.
for (const id of ["step-mm", "step-deg"]) {
  const field = byId(id);
  field.value = remembered(id, field.value);
  field.addEventListener("change", () => remember(id, field.value));
}
if (remembered("theme", "")) document.documentElement.dataset.theme = remembered("theme", "");
byId("theme").addEventListener("click", () => {
  switchTheme();
  remember("theme", document.documentElement.dataset.theme);
});

function frame() {
  scene.draw(aim.at, dial.wanted);
  dial.draw();
  scope.draw();
  lesson.draw();
  commissioning.draw();
  requestAnimationFrame(frame);
}
frame();
