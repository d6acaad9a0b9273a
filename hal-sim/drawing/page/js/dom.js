// Small helpers for the document.

export const byId = (id) => document.getElementById(id);

/** An element with properties and children. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** Text that is written only when it differs: the rest of the page is not laid out again for nothing. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** What an action came to, said below it. */
export async function report(output, action, done = "") {
  try {
    await action();
    output.className = "said good";
    setText(output, done);
    return true;
  } catch (error) {
    output.className = "said bad";
    setText(output, error.message);
    return false;
  }
}

/** Has a file saved. */
export function save(name, text, kind = "text/csv") {
  const url = URL.createObjectURL(new Blob([text], { type: kind }));
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
