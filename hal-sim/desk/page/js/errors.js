// Error numbers of the General Command Set in words.

import { WORDS } from "./error-words.js";

/** What an error number means. */
export function words(number) {
  return WORDS[number] ?? `error ${number}`;
}

/** A refusal by the controller. */
export class GcsError extends Error {
  constructor(number, line) {
    super(words(number));
    this.number = number;
    this.line = line;
  }
}
