// Error numbers of the General Command Set in words.

const WORDS = {
  1: "the line is not understood",
  2: "no such command",
  3: "the line is too long",
  5: "not referenced, or the servo is off",
  7: "out of the stage’s reach or of the soft limits",
  8: "velocity out of limits",
  9: "the centre of rotation cannot be set there",
  10: "stopped",
  15: "no such axis",
  17: "a value is out of range",
  18: "no such macro name",
  20: "no such macro",
  22: "an axis is named twice",
  23: "this axis cannot be used here",
  24: "wrong number of values",
  25: "not a number",
  26: "a value is missing",
  27: "soft limit out of range",
  34: "not possible with this stage",
  45: "referencing failed: an encoder does not answer, or the pivots are no pose",
  53: "not while something moves",
  54: "no such parameter",
  56: "wrong password",
  57: "no such recorder table",
  58: "no such recorder option, or not of this source",
  60: "this needs command level 1",
  63: "still starting",
  64: "this parameter can only be read",
  73: "a generator is running",
  77: "so many points have not been recorded",
  78: "this recorder table records nothing",
  84: "the motors are off",
  89: "not in this state",
  91: "the pivots would collide",
  93: "not while it moves, or with frames like these",
  304: "too much was sent at once",
  504: "following error too large: the motors are off",
  1005: "busy: nothing was done",
  1008: "a macro is running",
  1024: "a fault is latched: acknowledge it first",
};

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
