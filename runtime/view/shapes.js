/** As what joints are drawn, by what the scene says of them: rails are beams, tables discs, quills round. */

const PARALLEL = 0.999;
const SQUARE = 0.1;

/** The slides that carry a tool anywhere around its work. */
const ALL = 3;

/**
 * For every joint of a scene its shape: a slide is a "beam" with a carriage, or a "quill" where it lies along the axis of
 * a turn beside it; a turn is a "barrel", but before the slides of a machine tool, which carry the tool around the work,
 * a "table" and the "trunnion" that tilts it. isTool: whether it is such a machine, whose last body is a spindle.
 * bed: the frame that stands still where tables carry the work of a machine with three slides; else null.
 */
export function shapesOf({ bodies, joints }) {
  const slides = joints.filter(({ kind, body }) => kind === "slide" && bodies[body].kind === "link");
  const isTool = !bodies.some(({ kind }) => kind === "plate") && slides.some((one) => slides.some((other) => cosine(one, other) < SQUARE));
  const first = joints.indexOf(slides[0]);
  const carriesWork = (i) => isTool && i < first;
  const shapes = joints.map((joint, i) => {
    if (joint.kind === "turn") return carriesWork(i) ? (i === 0 ? "table" : "trunnion") : "barrel";
    const beside = [i - 1, i + 1].filter((k) => joints[k]?.kind === "turn" && !carriesWork(k)).map((k) => joints[k]);
    return beside.some((one) => cosine(one, joint) > PARALLEL) ? "quill" : "beam";
  });
  const { rotation } = bodies[joints[first]?.body]?.frame ?? {}; // behind it, and behind what turns the bed against the last table
  const bed = isTool && first > 0 && slides.length >= ALL ? { position: joints[first - 1].at, rotation } : null;
  return { shapes, isTool, bed };
}

/**
 * Where the motor of a turn stands: at one end of its axis, or beside it where bodies leave both ends.
 *
 * @returns {{axis: number[], isAside: boolean}} axis: the direction from the joint to the motor
 */
export function motorPlace({ bodies }, { at, axis, body }) {
  const isTaken = (sense) => bodies.some(({ kind, lines }, i) => (kind === "base" && !lines.length && body === 1 && sense * axis[2] < -PARALLEL)
    || (Math.abs(i - body) < 2 && lines.some((ends) => ends.some((end, k) => isAt(end, at) && along(end, ends[1 - k], axis) * sense > PARALLEL))));
  const sense = [-1, 1].find((one) => !isTaken(one));
  if (sense) return { axis: axis.map((value) => sense * value), isAside: false };
  const least = axis.map(Math.abs).indexOf(Math.min(...axis.map(Math.abs)));
  const across = axis.map((value, i) => (i === least ? 1 : 0) - axis[least] * value);
  const length = Math.hypot(...across);
  return { axis: across.map((value) => value / length), isAside: true };
}

function isAt(one, other) {
  return one.every((value, i) => Math.abs(value - other[i]) < 1e-9 * (1 + Math.abs(value)));
}

/** The cosine between the way from one point to another and an axis. */
function along(start, end, axis) {
  const way = end.map((value, i) => value - start[i]);
  return way.reduce((sum, value, i) => sum + value * axis[i], 0) / (Math.hypot(...way) || 1);
}

function cosine(one, other) {
  return Math.abs(one.axis.reduce((sum, value, i) => sum + value * other.axis[i], 0));
}
