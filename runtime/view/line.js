/** A line from one frame to another: the axes along it, where it is refused, singular, or jumps. */

import { inWords } from "./machines/index.js";
import { between } from "./pose.js";

const SAMPLES = 240;
/** A change between two samples is looked at where it is larger: degrees, or a part of the range in lengths. */
const LOOKED_AT = 3;
const BISECTIONS = 14;

/**
 * The samples of a line on the branches of its first pose, turns open, each with the one before as its reference.
 *
 * @returns {{at: number, frame: object, axes: ?number[], words: string, isSingular: boolean, isJump: boolean}[]}
 */
export function alongLine(machine, from, to, bytes, reference) {
  const found = [];
  let near = reference;
  for (let i = 0; i <= SAMPLES; i += 1) {
    const sample = sampleAt(machine, from, to, bytes, near, i / SAMPLES);
    const last = found[found.length - 1];
    sample.isJump = Boolean(last?.axes && sample.axes) && isJump(machine, from, to, bytes, last, sample);
    if (sample.axes) near = sample.axes;
    found.push(sample);
  }
  return found;
}

function sampleAt(machine, from, to, bytes, near, at) {
  const frame = between(from, to, at);
  const answer = machine.inverse(frame, bytes, near);
  if (answer.status) return { at, frame, axes: null, words: inWords(answer), isSingular: false };
  const { status, isSingular } = machine.singularity(answer.axes, frame);
  return { at, frame, axes: answer.axes, words: "", isSingular: Boolean(status) || isSingular };
}

/** Whether the change between two samples stays where the way between them is halved again and again. */
function isJump(machine, from, to, bytes, first, second) {
  const whole = change(first.axes, second.axes);
  if (!(whole > LOOKED_AT)) return false;
  let [low, high] = [first, second];
  for (let i = 0; i < BISECTIONS; i += 1) {
    const middle = sampleAt(machine, from, to, bytes, low.axes, (low.at + high.at) / 2);
    if (!middle.axes) return false;
    [low, high] = change(low.axes, middle.axes) > change(middle.axes, high.axes) ? [low, middle] : [middle, high];
  }
  return change(low.axes, high.axes) > whole / 2;
}

function change(one, other) {
  return Math.max(...one.map((value, i) => Math.abs(value - other[i])));
}
