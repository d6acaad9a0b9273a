// The page: what belongs together is brought together, and everything is drawn at the screen's rate.

import { Aim } from "./aim.js";
import { commandLine } from "./console.js";
import { byId } from "./dom.js";
import { drive } from "./drive.js";
import { steps } from "./jog.js";
import { framePanel, Frames } from "./frames.js";
import { Lesson } from "./lesson.js";
import { Link } from "./link.js";
import { parameters } from "./parameters.js";
import { Recorder } from "./recorder.js";
import { Scene } from "./scene.js";
import { Scope } from "./scope.js";
import { Stage } from "./stage.js";
import { FirstMove } from "./first-move.js";
import { showStale } from "./stale.js";
import { statistics } from "./statistics.js";
import { showState } from "./state.js";
import { stopping } from "./stop.js";
import { switchTheme } from "./theme.js";

const stage = new Stage(new Link());
const frames = new Frames(stage);
const scene = new Scene(byId("scene"), stage, frames);
const aim = new Aim(stage, scene);
const scope = new Scope(stage);
const lesson = new Lesson();
stopping(stage);
showStale(stage);
showState(stage);
new FirstMove(stage);
drive(stage);
steps(stage);
parameters(stage);
new Recorder(stage);
statistics(stage);
framePanel(stage);
commandLine(stage);

byId("labels").addEventListener("change", (event) => { scene.names = event.target.checked; });
byId("clear-trail").addEventListener("click", () => { scene.trail = []; });
byId("closer").addEventListener("click", (event) => {
  scene.closer = !scene.closer;
  event.target.setAttribute("aria-pressed", String(scene.closer));
});
byId("theme").addEventListener("click", switchTheme);

function frame() {
  scene.draw(aim.at);
  scope.draw();
  lesson.draw();
  requestAnimationFrame(frame);
}
frame();
