// A button that acts as long as it is held: what it asks for is renewed, and ends by itself if it is not.

// What is not renewed ends 300 ms after it was asked for last: a page that dies does not let its button go.
const RENEWAL_MS = 100;

/** `begin` once, `renew` over and over, `end` when it is let go; only while `allowed`. */
export function whileHeld(button, { allowed = () => true, begin, renew, end }) {
  let renewal = 0;
  const hold = () => {
    button.classList.add("held");
    begin();
    clearInterval(renewal);
    renewal = setInterval(() => renew().catch(() => clearInterval(renewal)), RENEWAL_MS);
  };
  const release = () => {
    clearInterval(renewal);
    if (!button.classList.contains("held")) return;
    button.classList.remove("held");
    end();
  };
  button.addEventListener("pointerdown", (event) => {
    if (!allowed()) return;
    button.setPointerCapture(event.pointerId);
    hold();
  });
  for (const kind of ["pointerup", "pointercancel", "lostpointercapture", "blur", "keyup"]) button.addEventListener(kind, release);
  button.addEventListener("keydown", (event) => {
    if (allowed() && [" ", "Enter"].includes(event.key) && !event.repeat) hold();
  });
  // A page that nobody sees any more does not see a button let go.
  addEventListener("visibilitychange", () => { if (document.hidden) release(); });
}
