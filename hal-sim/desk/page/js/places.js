// Places that this browser keeps by name: where the target is now, to go there again. In the coordinates in force.

import { byId, make, report } from "./dom.js";
import { plain, shown } from "./gcs.js";
import { remember, remembered } from "./remembered.js";

export function places(stage) {
  const [form, list, name, said] = ["places-form", "places-list", "place-name", "said"].map(byId);
  let kept = remembered("places", []);
  const keep = (changed) => {
    kept = changed;
    remember("places", kept);
    show();
  };
  const button = (text, label, action) => {
    const made = make("button", { type: "button", className: "quiet", textContent: text, "aria-label": label });
    made.addEventListener("click", action);
    return made;
  };
  const show = () => list.replaceChildren(...kept.map((place) => {
    const [x, y, w] = place.at;
    const where = `${shown(x, 2)}, ${shown(y, 2)} mm, ${shown(w, 2)}°`;
    const go = () => report(said, () => stage.link.ask(`MOV X ${plain(x)} Y ${plain(y)} W ${plain(w)}`), `on its way to ${place.name}`);
    return make("li", {}, button("Go", `Go to ${place.name}`, go), make("span", { className: "grow" }, make("b", { textContent: place.name }), make("span", { className: "faint small", textContent: ` ${where}` })),
      button("✕", `Forget ${place.name}`, () => keep(kept.filter((one) => one !== place))));
  }));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    report(said, async () => {
      const wanted = name.value.trim();
      if (!wanted) throw new Error("a place needs a name");
      if (!stage.referenced || !stage.target) throw new Error("the stage does not know yet where it is");
      keep([...kept.filter((one) => one.name !== wanted), { name: wanted, at: [...stage.target] }]);
      name.value = "";
    }, "place kept in this browser");
  });
  show();
}
