// Who may command the stage and who did last; taking it for this page alone, and giving it back.

import { byId, report, setText } from "./dom.js";
import { fields } from "./gcs.js";

const NOBODY = "(nobody)";

export function ownership(stage) {
  const [box, button] = [byId("owner"), byId("own")];
  const { link } = stage;
  /** What this page is called, as far as it knows; whether it owns, and for which owner that was asked. */
  let [name, mine, asked] = ["", false, NOBODY];
  link.addEventListener("you", ({ detail }) => { name = detail.name; });
  stage.addEventListener("link", () => {
    [mine, asked] = [false, NOBODY];
    box.hidden = button.hidden = !stage.knows("OWN");
  });

  const show = () => {
    const told = fields(stage.replies["OWN?"]);
    const { OWNER: owner = NOBODY } = told;
    const free = owner === NOBODY;
    box.dataset.owner = free ? "nobody" : mine ? "mine" : "other";
    setText(byId("owner-who"), free ? "Everybody may command." : mine ? "Only this page may command." : `Only ${spoken(owner)} may command; stopping works.`);
    setText(byId("owner-last"), last(told, name));
    setText(button, mine ? "Give control back" : "Take control");
    button.disabled = !free && !mine;
  };

  stage.addEventListener("slow", async () => {
    const { OWNER: owner } = fields(stage.replies["OWN?"]);
    if (owner !== undefined && owner !== asked) {
      asked = owner;
      // The page's own connection knows whether it is the owner: names may be given twice.
      const own = owner === NOBODY ? {} : fields(await link.urge("OWN?").catch(() => ""));
      mine = own.MINE === "1";
      if (mine) name = owner;
    }
    show();
  });
  button.addEventListener("click", () => report(byId("said"), () => link.ask(mine ? "OWN 0" : `OWN 1 ${word(link.who)}`.trim()),
    mine ? "given back: everybody may command" : "this page alone may command now"));
}

function last({ LAST: who = NOBODY, LAST_S: seconds }, name) {
  if (who === NOBODY) return "";
  return `Last command: ${who === name ? "this page" : spoken(who)}, ${ago(Number(seconds))}.`;
}

/** So coarse that it does not change all the time. */
function ago(seconds) {
  if (seconds < 10) return "just now";
  if (seconds < 60) return "within the last minute";
  return seconds < 3600 ? `${Math.floor(seconds / 60)} min ago` : `${Math.floor(seconds / 3600)} h ago`;
}

/** A name as the controller takes one: letters, digits, underscores. */
function word(text) {
  return text.normalize("NFKD").replace(/\s+/g, "_").replace(/\W/g, "").slice(0, 24);
}

const spoken = (name) => name.replaceAll("_", " ");
