/** The search for all poses of a platform at its axes. */

import { FEWEST_STARTS, MOST_STARTS, OFTEN, SAME_POSE } from "./machines/softkin/constants.js";
import { rotationOf, rowsOf } from "./pose.js";

/** Irrational steps that fill a space of six dimensions evenly: powers of 1 / g, where g^7 = g + 1. */
const STEPS = [1, 2, 3, 4, 5, 6].map((power) => 1.1127756842787055 ** -power);

/**
 * Newton's method from starts all around the machine, spread evenly over places and rotations: yields after each start
 * {starts, poses}, where poses: {frame, isOther, count}. isOther: of the assembly mode that the machine is not in. points:
 * between which it is drawn; present: the frame that its tool has.
 */
export function* posesFrom(machine, axes, points, present) {
  const centre = [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k] / points.length, 0));
  const size = 2 * Math.max(...points.map((point) => Math.hypot(...point.map((value, k) => value - centre[k]))));
  const modes = [machine, machine.inOtherAssembly()];
  const poses = [{ frame: present, isOther: false, count: 0 }];
  for (let starts = 1; starts <= MOST_STARTS; starts += 1) {
    const start = startAt(starts, machine.description.task, present, centre, size);
    for (const [isOther, mode] of modes.entries()) {
      const { status, frame } = mode.forward(axes, start);
      if (status) continue;
      const known = poses.find((pose) => isSame(pose.frame, frame, size));
      if (known) known.count += 1;
      else poses.push({ frame, isOther: Boolean(isOther), count: 1 });
    }
    yield { starts, poses };
    if (starts >= FEWEST_STARTS && poses.every(({ count }) => count >= OFTEN)) return;
  }
}

function startAt(number, { position: letters, turning }, present, centre, size) {
  const part = STEPS.map((step) => (0.5 + number * step) % 1);
  const position = centre.map((value, k) => (letters.includes("xyz"[k]) ? value + 1.5 * size * (part[k] - 0.5) : present.position[k]));
  const [, , , u, v, w] = part;
  const turn = (share) => 2 * Math.PI * share;
  const [a, b] = [Math.sqrt(1 - u), Math.sqrt(u)];
  const quaternion = [a * Math.sin(turn(v)), a * Math.cos(turn(v)), b * Math.sin(turn(w)), b * Math.cos(turn(w))];
  return { position, rotation: turning === "about z" ? rotationOf([360 * u, 0, 0]) : rowsOf(quaternion) };
}

export function isSame(one, other, size) {
  const isNear = (a, b, within) => a.every((value, i) => Math.abs(value - b[i]) < within);
  return isNear(one.position, other.position, SAME_POSE * size) && isNear(one.rotation.flat(), other.rotation.flat(), SAME_POSE);
}
