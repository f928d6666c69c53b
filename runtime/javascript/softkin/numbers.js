/** The primitives of every program. Each is total: it has a value for any numbers. */

import { EDGE, LARGEST, PIVOT, SOLVABLE } from "./constants.js";

/** One degree in radians. */
export const DEGREE = Math.PI / 180;
/** One radian in degrees. */
export const RADIAN = 180 / Math.PI;
const TURN = 2 * Math.PI;
/** With more turns than this there is no nearest angle. */
const MOST_TURNS = 1e18;
const HALF_AND_EDGE = 180 + EDGE;

/** Whether all are numbers of reasonable size. */
export function isReasonable(...numbers) {
  for (const number of numbers) {
    if (!(Math.abs(number) <= LARGEST)) return false;
  }
  return true;
}

/** The square root of x, and 0 for a negative x. */
export function squareRoot(x) {
  return x > 0 ? Math.sqrt(x) : 0;
}

/** The angle of (x, y) in radians, in (-pi, pi]; 0 for (0, 0). Zeros have no sign. */
export function angleOf(y, x) {
  return Math.atan2(y + 0, x + 0);
}

/**
 * value + 360 k in [centre - 180, centre + 180), in degrees; the interval is shifted down by EDGE.
 *
 * So a value on an edge stays on its side in spite of rounding.
 */
export function nearestPeriod(value, centre) {
  const turns = (value - centre + HALF_AND_EDGE) / 360;
  return turns > -MOST_TURNS && turns < MOST_TURNS ? value - 360 * Math.floor(turns) : NaN;
}

/** The angle of the arc centre ± half that is nearest to an angle, in radians. */
export function nearestOnArc(angle, centre, half) {
  const away = angle - centre;
  const turns = (away + Math.PI) / TURN;
  if (!(turns > -MOST_TURNS && turns < MOST_TURNS)) return NaN;
  return centre + Math.min(Math.max(away - TURN * Math.floor(turns), -half), half);
}

/**
 * The determinant, then the solution by rows: LU decomposition with partial pivoting.
 *
 * Zeros if the matrix is singular, and where a number is NaN or beyond SOLVABLE in size.
 * @param {number[][]} matrix - by rows (n, n)
 * @param {number[][]} right - by rows (n, m); empty if the determinant alone is wanted
 * @returns {number[]} 1 + n m numbers
 */
export function solveLinear(matrix, right) {
  const size = matrix.length;
  const rows = matrix.map((row, i) => (right.length ? [...row, ...right[i]] : [...row]));
  const width = rows[0].length;
  const nothing = new Array(1 + size * (width - size)).fill(0);
  let largest = 0;
  for (const row of matrix) for (const entry of row) largest = Math.max(largest, Math.abs(entry));
  if (!(largest >= 1 / SOLVABLE && rows.every((row) => row.every((entry) => Math.abs(entry) <= SOLVABLE)))) {
    return nothing;
  }
  let determinant = 1;
  for (let k = 0; k < size; k += 1) {
    let best = k;
    for (let i = k + 1; i < size; i += 1) if (Math.abs(rows[i][k]) > Math.abs(rows[best][k])) best = i;
    if (!(Math.abs(rows[best][k]) > PIVOT * largest)) return nothing;
    if (best !== k) {
      [rows[k], rows[best]] = [rows[best], rows[k]];
      determinant = -determinant;
    }
    determinant *= rows[k][k];
    rows[k][k] = 1 / rows[k][k];
    for (let i = k + 1; i < size; i += 1) {
      const factor = rows[i][k] * rows[k][k];
      for (let j = k + 1; j < width; j += 1) rows[i][j] -= factor * rows[k][j];
    }
  }
  for (let k = size - 1; k >= 0; k -= 1) {
    for (let j = size; j < width; j += 1) {
      for (let i = k + 1; i < size; i += 1) rows[k][j] -= rows[k][i] * rows[i][j];
      rows[k][j] *= rows[k][k];
    }
  }
  return [determinant, ...rows.flatMap((row) => row.slice(size))];
}
