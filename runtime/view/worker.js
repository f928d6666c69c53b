/** A slice of the workspace, row by row, in a worker: the same program as the page, started without a page. */

import { created } from "./limits.js";
import { catalogue } from "./machines/index.js";

const ROWS_A_MESSAGE = 4;

/** Answer the message of `SlicePanel`: for every cell a number, -1 where nothing reaches it. */
export function serve() {
  self.onmessage = ({ data }) => {
    const { machine } = created(catalogue[data.name], data.parameters);
    let rows = [];
    for (let row = 0; row < data.cells; row += 1) {
      rows.push(Float32Array.from({ length: data.cells }, (_, column) => valueAt(machine, data, row, column)));
      if (rows.length === ROWS_A_MESSAGE || row === data.cells - 1) {
        self.postMessage({ until: row + 1, rows });
        rows = [];
      }
    }
  };
}

function valueAt(machine, { cells, corners, rotation, what, bytes, reference }, row, column) {
  const [origin, along, up] = corners;
  const [a, b] = [(column + 0.5) / cells, 1 - (row + 0.5) / cells];
  const frame = { position: origin.map((value, i) => value + a * along[i] + b * up[i]), rotation };
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
