// Colours of the style sheet for canvases, and the choice of light and dark.

let colours = new Map();
const listeners = new Set();

/** The colour of this name now. */
export function colour(name) {
  if (!colours.has(name)) colours.set(name, resolved(`var(--${name})`));
  return colours.get(name);
}

// A canvas does not know `light-dark()`: an element is asked what it comes to.
function resolved(value) {
  const probe = document.createElement("i");
  probe.style.color = value;
  document.body.append(probe);
  const text = getComputedStyle(probe).color;
  probe.remove();
  return text;
}

/** Calls back whenever the colours change. */
export function onColours(listener) {
  listeners.add(listener);
}

/** From light to dark, and back. */
export function switchTheme() {
  const { dataset } = document.documentElement;
  const dark = dataset.theme ? dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  dataset.theme = dark ? "light" : "dark";
  renewColours();
}

/** Forgets the colours: they are others now. */
function renewColours() {
  colours = new Map();
  for (const listener of listeners) listener();
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", renewColours);
