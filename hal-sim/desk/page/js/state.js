// State in words, faults, pose and lamps.

import { byId, report, setText } from "./dom.js";
import { shown } from "./gcs.js";

const WORDS = { off: "servo off", holding: "holding", moving: "moving", stopping: "stopping at a fault", fault: "fault" };
const DECIMALS = 4;

export function showState(stage) {
  const mode = byId("mode");
  const showMode = () => {
    const name = stage.connected ? stage.mode : "offline";
    mode.dataset.mode = name;
    setText(mode, WORDS[name] ?? "not connected");
    showAlarm(stage);
  };
  stage.addEventListener("link", () => {
    setText(byId("place"), stage.connected ? `${stage.identity} at ${stage.place}` : "");
    showMode();
  });
  stage.addEventListener("tick", showMode);
  stage.addEventListener("slow", () => {
    showPose(stage);
    lamp("lamp-referenced", stage.referenced);
    lamp("lamp-servo", stage.servo);
    lamp("lamp-settled", stage.settled);
  });
  byId("acknowledge").addEventListener("click", () => report(byId("said"), () => stage.link.ask("FLC"), "fault acknowledged"));
}

function showAlarm(stage) {
  const text = stage.connected ? stage.fault && `Fault: ${stage.fault}` : stage.reason;
  byId("alarm").hidden = !text;
  if (text) setText(byId("alarm-text"), text);
  byId("acknowledge").hidden = !(stage.connected && stage.mode === "fault");
}

function showPose({ measured, target, referenced }) {
  ["x", "y", "w"].forEach((name, i) => {
    setText(byId(`${name}-measured`), referenced ? shown(measured[i], DECIMALS) : "–");
    setText(byId(`${name}-target`), referenced ? shown(target[i], DECIMALS) : "–");
  });
}

function lamp(id, on) {
  byId(id).classList.toggle("on", on);
}
