/** The machine as it stands at first: near the pose in which it is drawn, and away from singular poses. */

import { shapesOf } from "./shapes.js";

const SWEEP = [27, 41, -33, 22, 48, 15, -19];
const FACTORS = [1, 0.6, -1, 0.3, -0.6, 1.6, 0];
const GOOD = 0.12;
/** How high the tool stands above its work, in shares of `lengthOf`. */
const WORK = 0.4;

/** The nominal values of all parameters, by name. */
export function nominalOf(description) {
  return Object.fromEntries(description.parameters.map(({ name, nominal, kind }) => [name, kind === "flag" ? Boolean(nominal) : nominal]));
}

/** The largest length among the parameters: what a slide moves by, and the size of what has no other. */
export function lengthOf(machine) {
  const { description, parameters } = machine;
  const lengths = description.parameters
    .filter(({ kind, unit }) => unit === "u" && !kind.startsWith("distance"))
    .map(({ name }) => Math.abs(parameters[name]));
  const all = description.parameters.filter(({ unit }) => unit === "u").map(({ name }) => Math.abs(parameters[name]));
  return [Math.max(0, ...lengths), Math.max(0, ...all), 400].find((one) => one > 0 && Number.isFinite(one));
}

/** Axis values at which the machine stands, is not singular, and is inside its limits where such are found. */
export function startOf(machine) {
  let best = null;
  for (const axes of candidates(machine)) {
    const worth = worthOf(machine, axes);
    if (worth !== null && (best === null || worth > best.worth)) best = { axes, worth };
    if (best && best.worth >= GOOD) break;
  }
  return best ? aboveWork(machine, best.axes) : drawnOf(machine);
}

/** The tool of a machine whose tables carry the work stands above the work, if the machine comes there. */
function aboveWork(machine, axes) {
  const { frame, configuration } = machine.forward(axes);
  if (frame.position[2] > 0 || shapesOf(machine.scene(axes, frame)).bed === null) return axes;
  const lifted = { ...frame, position: [0, 0, WORK * lengthOf(machine)] };
  const found = machine.inverse(lifted, openTurns(machine, configuration), axes);
  return found.status ? axes : found.axes;
}

function* candidates(machine) {
  for (const factor of FACTORS) yield swept(machine, factor);
  yield* fromFrames(machine);
}

/** The axis values of its drawing, else the nominal ones. */
function drawnOf({ description }) {
  return description.drawn ?? description.axes.map((axis) => axis.nominal);
}

function swept(machine, factor) {
  const travel = 0.25 * lengthOf(machine);
  const drawn = drawnOf(machine);
  return machine.description.axes.map(({ unit }, i) => {
    const part = (factor * SWEEP[i % SWEEP.length]) / (unit === "deg" ? 1 : 40);
    return inside(machine.limits[i], drawn[i] + (unit === "deg" ? part : part * travel));
  });
}

function inside({ lower, upper }, value) {
  if (lower !== null && value < lower) return lower;
  return upper !== null && value > upper ? upper : value;
}

/** How far the least margin is from zero; null if there is no pose, or the inverse does not come back to it. */
function worthOf(machine, axes) {
  const found = machine.forward(axes);
  if (found.status) return null;
  if (machine.inverse(found.frame, openTurns(machine, found.configuration), axes).status) return null;
  const { status, margins } = machine.singularity(axes, found.frame);
  if (status) return null;
  return Math.min(1, ...Object.values(margins).map(Math.abs));
}

function openTurns(machine, bytes) {
  return bytes.map((byte, i) => (i < machine.description.branchCount ? byte : 0));
}

/** Axis values of level frames around the origin, for a machine that does not stand near its nominal axis values. */
function* fromFrames(machine) {
  const step = 0.35 * lengthOf(machine);
  const reference = drawnOf(machine);
  const rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const numbers = [0, 1, -1, 2, -2];
  for (const z of machine.description.task.position.includes("z") ? numbers : [0]) {
    for (const y of numbers) {
      for (const x of numbers) {
        const found = machine.inverseAll({ position: [x * step, y * step, z * step], rotation }, reference);
        if (!found.status) yield* found.slots.filter((slot) => !slot.status).map((slot) => slot.axes);
      }
    }
  }
}
