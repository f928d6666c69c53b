/** Statuses, and refusals with their reasons. */

import { MEANINGS } from "./constants.js";

/** Why a program refuses; programs return it in the place of their values. */
export class Refusal {
  constructor(status, reason, missing, turn) {
    this.status = status;
    /** With the unit of the missing amount at its end: "A2: out of reach [u]". */
    this.reason = reason;
    this.missing = missing;
    this.turn = turn;
  }

  /**
   * What a caller is told.
   * @returns {{status: number, reason: string, unit: string, missing: number, turn: number}} reason: a sentence with
   *   the name of the quantity that refuses, or the meaning of the status; missing: the amount of this quantity, 0
   *   if there is none; unit: that of the amount, "u" (the user's length unit), "deg" or ""; turn: where the turn of
   *   an axis is the reason, the number of a turn inside the limits, else 0
   */
  told() {
    const found = /^(.*) \[(u|deg)\]$/s.exec(this.reason);
    const [reason, unit] = found ? [found[1], found[2]] : [this.reason || MEANINGS[this.status], ""];
    return { status: this.status, reason, unit, missing: this.missing, turn: this.turn };
  }
}

/** A refusal with a status and, if there is one, a reason, its amount and another turn. */
export function refuse(status, reason = "", missing = 0, turn = 0) {
  return new Refusal(status, reason, missing, turn);
}

/** A result that refuses, in a sentence: "A2: out of reach, missing 12.3 u". */
export function inWords({ reason, unit, missing, turn }) {
  const amount = missing ? `, missing ${amountOf(missing)}${unit ? ` ${unit}` : ""}` : "";
  return `${reason}${amount}${turn ? `, which is turn ${turn}` : ""}`;
}

/** An amount in four digits, spelled as in the Python package: "214.0", "2e-05". Half a digit is rounded to even. */
function amountOf(missing) {
  if (!Number.isFinite(missing)) return String(missing).replace("Infinity", "inf");
  const [, sense, digits, rest, exponent] = /^(-?)(\d\.\d{3})(\d*)e(.*)$/.exec(missing.toExponential(30));
  const isDown = /^50*$/.test(rest) && Number(digits[4]) % 2 === 0;
  const rounded = isDown ? Number(`${sense}${digits}e${exponent}`) : Number(missing.toPrecision(4));
  const size = Math.abs(rounded);
  if (size < 1e-4 || size >= 1e16) return rounded.toExponential().replace(/e([+-])(\d)$/, "e$10$2");
  return Number.isInteger(rounded) ? `${rounded}.0` : String(rounded);
}
