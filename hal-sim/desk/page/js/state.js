// State in words, the machine and the line to it, faults, pose and lamps.

import { byId, report, setText } from "./dom.js";
import { shown } from "./gcs.js";

const WORDS = { off: "servo off", holding: "holding", moving: "moving", stopping: "stopping at a fault", fault: "fault", exciting: "a motor is excited (EXC)" };
const DECIMALS = 4;

export function showState(stage) {
  const { freshness } = stage.link;
  const mode = byId("mode");
  const showMode = () => {
    const name = stage.connected && !freshness.stale ? stage.mode : "offline";
    if (mode.dataset.mode !== name) mode.dataset.mode = name;
    setText(mode, WORDS[name] ?? (stage.connected ? "no status" : "not connected"));
    showFault(stage);
  };
  stage.addEventListener("link", () => {
    showMachine(stage);
    showMode();
  });
  stage.addEventListener("tick", showMode);
  freshness.addEventListener("change", showMode);
  stage.addEventListener("slow", () => {
    showPose(stage);
    lamp("lamp-referenced", stage.referenced);
    lamp("lamp-servo", stage.servo);
    lamp("lamp-settled", stage.settled);
    byId("first-step").hidden = stage.referenced || stage.notCommissioned !== "";
    byId("reference-again").hidden = !stage.referenced;
    showNotices(stage);
  });
  byId("acknowledge").addEventListener("click", () => report(byId("said"), () => stage.link.ask("FLC"), "fault acknowledged"));
}

/** Whether it is a real machine is the first thing to know. */
function showMachine({ connected, simulated, identity, place }) {
  const machine = byId("machine");
  machine.dataset.kind = connected ? (simulated ? "simulated" : "real") : "none";
  setText(byId("machine-kind"), connected ? (simulated ? "SIMULATED" : "REAL STAGE") : "NO STAGE");
  setText(byId("machine-line"), connected ? place : "");
  setText(byId("place"), connected ? identity : "");
}

function showFault(stage) {
  const reason = stage.fault ? `Fault: ${stage.fault}` : stage.notCommissioned && "This machine is not commissioned: nothing drives before it is.";
  const text = stage.connected ? reason : "";
  byId("alarm").hidden = !text;
  if (text) setText(byId("alarm-text"), text);
  byId("acknowledge").hidden = stage.mode !== "fault";
  byId("commission-open").hidden = Boolean(stage.fault) || !stage.notCommissioned;
}

/** What stays until somebody changes it. */
function showNotices({ notices, notCommissioned }) {
  // That one is an alarm already.
  const others = notices.filter((notice) => notice !== notCommissioned);
  byId("notices").hidden = others.length === 0;
  setText(byId("notices"), others.join("; "));
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
