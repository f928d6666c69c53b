/** Configuration bytes: the branches that they leave open, and the bytes of a pose. */

import { COINCIDENT, EDGE, LARGEST } from "./constants.js";
import { nearestPeriod } from "./numbers.js";

/** The byte of an open branch; 1 and 2 are its two branches, 3 says that both coincide, and is read as open. */
export const AUTOMATIC = 0;

/**
 * The slots that branch bytes leave open, the first byte varies fastest.
 * @param {number[]} bytes - each 0, 1, 2 or 3
 * @returns {{bytes: number[], signs: number[]}[]} signs: 1 for byte 1, -1 for byte 2
 */
export function slotsOf(bytes) {
  let found = [[]];
  for (const byte of [...bytes].reverse()) {
    const choices = byte === 1 || byte === 2 ? [byte] : [1, 2];
    found = found.flatMap((slot) => choices.map((choice) => [choice, ...slot]));
  }
  return found.map((slot) => ({ bytes: slot, signs: slot.map((byte) => (byte === 1 ? 1 : -1)) }));
}

/** The byte of a branch by its signed margin. */
export function branchByte(margin) {
  if (Math.abs(margin) <= COINCIDENT) return 3;
  return margin > 0 ? 1 : 2;
}

/** The number of the turn of a value in degrees: 1 is [-180, 180), -1 is [-540, -180), and so on; 0: beyond a byte. */
export function turnOf(value) {
  const turn = Math.floor((value + 180 + EDGE) / 360);
  const number = turn >= 0 ? turn + 1 : turn;
  return number >= -127 && number <= 127 ? number : 0;
}

/**
 * The number of the turn on which an axis that is beyond its limits (degrees) would be inside.
 *
 * Of several the one nearest to the limit that it exceeds; 0 if there is none, or none that a byte can name.
 */
export function turnInside(axis, lowest, highest) {
  const turns = axis > highest ? Math.floor((highest - axis) / 360) : -Math.floor((axis - lowest) / 360);
  const number = turnOf(Math.min(Math.max(axis + 360 * turns, -360 * 127), 360 * 126));
  const inside = nearestPeriod(axis, number > 0 ? 360 * number - 360 : 360 * number);
  return lowest <= inside && inside <= highest ? number : 0;
}

/**
 * The squared distance of axes from the reference, over the counted axes.
 *
 * It is 0 for a reference that is no number of reasonable size: then the first branch is taken.
 */
export function squaredDistance(axes, reference, counted) {
  let total = 0;
  if (!counted.every((i) => Math.abs(reference[i]) <= LARGEST)) return total;
  for (const i of counted) total += (axes[i] - reference[i]) * (axes[i] - reference[i]);
  return total;
}
