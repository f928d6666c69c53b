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

function cosine(one, other) {
  return Math.abs(one.axis.reduce((sum, value, i) => sum + value * other.axis[i], 0));
}
