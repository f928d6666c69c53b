/** A slice of the workspace, row by row, in a worker: the same program as the page, started without a page. */

import { created } from "./limits.js";
import { catalogue } from "./machines/index.js";

const ROWS_A_MESSAGE = 4;

/** Answer the message of `SlicePanel`: for every cell a number, -1 where nothing reaches it; then for parts of cells at a border. */
export function serve() {
  self.onmessage = ({ data }) => {
    const { machine } = created(catalogue[data.name], data.parameters);
    const { cells, fine } = data;
    const all = [];
    let rows = [];
    for (let row = 0; row < cells; row += 1) {
      rows.push(Float32Array.from({ length: cells }, (_, column) => valueAt(machine, data, (column + 0.5) / cells, (row + 0.5) / cells)));
      if (rows.length === ROWS_A_MESSAGE || row === cells - 1) {
        self.postMessage({ until: row + 1, rows });
        all.push(...rows);
        rows = [];
      }
    }
    const parts = bordersOf(all, data.what === "number").map(([row, column]) => ({ row, column, values: Float32Array.from({ length: fine * fine },
      (_, k) => valueAt(machine, data, (column + ((k % fine) + 0.5) / fine) / cells, (row + (Math.floor(k / fine) + 0.5) / fine) / cells)) }));
    self.postMessage({ until: cells, rows: [], parts });
  };
}

/** The cells beside which, or at a corner of which, another answer is: reached or not, or another number. */
function bordersOf(rows, isNumber) {
  const kind = (row, column) => (isNumber ? rows[row]?.[column] : rows[row]?.[column] >= 0);
  const around = [-1, 0, 1].flatMap((i) => [-1, 0, 1].map((k) => [i, k]));
  return rows.flatMap((values, row) => [...values.keys()].filter((column) => around.some(([i, k]) => {
    const isInside = rows[row + i]?.[column + k] !== undefined;
    return isInside && kind(row + i, column + k) !== kind(row, column);
  })).map((column) => [row, column]));
}

/** a, down: the place in the slice, from 0 to 1 along it and from its top. */
function valueAt(machine, { corners, rotation, what, bytes, reference }, a, down) {
  const [origin, along, up] = corners;
  const frame = { position: origin.map((value, i) => value + a * along[i] + (1 - down) * up[i]), rotation };
  if (what === "number") {
    const found = machine.inverseAll(frame, reference);
    const answers = found.status ? [] : found.slots.filter((slot) => !slot.status);
    return answers.length ? answers.reduce((sum, slot) => sum + 1 + slot.others.length, 0) : -1;
  }
  const open = what === "reach" ? bytes.map(() => 0) : bytes;
  const found = machine.inverse(frame, open, reference);
  if (found.status) return -1;
  if (what === "reach") return 1;
  const { status, margins } = machine.singularity(found.axes, frame);
  return status ? 0 : Math.abs(margins[what]);
}
