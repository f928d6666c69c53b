// What the parts of the page say of poses, without a browser: the model, a controller, a line, a slice, the copied text.
import { readFragment } from "./address.js";
import { pythonOf } from "./copy.js";
import { alongLine } from "./line.js";
import { Live } from "./live.js";
import { Model } from "./model.js";
import { posesFrom } from "./search.js";
import { serve } from "./worker.js";

globalThis.location = { protocol: "http:", host: "page" };

/** A machine of its own parameters, and what is said of poses: null, or the reason of a refusal. */
export function asked({ name, parameters, machine, base, poses }) {
  const model = new Model();
  model.open(name, { parameters });
  const { start, parameters: shown } = model;
  const [live, send] = followed(machine, name);
  const answers = poses.map(({ axes, frame, bytes }) => {
    model.moveAxes(base);
    const first = model.pose.frame;
    const line = alongLine(model.machine, first, frame, bytes, base);
    const slice = cellOf(model, frame, bytes, axes);
    model.moveAxes(axes);
    const stands = model.pose.beyond?.reason ?? null;
    model.aim(frame, bytes);
    const aimed = model.refusal?.reason ?? null;
    const solutions = model.solutions().filter((slot) => !slot.status).map((slot) => slot.axes);
    send({ type: "axes", status: "live", message: "", complete: true, axes, quality: axes.map(() => "good"), reasons: axes.map(() => "") });
    return { stands, aimed, solutions, slice, line: line.at(-1).words, live: live.pose.beyond?.reason ?? null, followed: live.axes };
  });
  model.moveAxes(base);
  return { start, shown, answers };
}

/** A model that follows a controller, and what sends it messages. */
function followed(machine, name) {
  const model = new Model();
  let socket = null;
  new Live(model, "token", () => {}, {}, class { constructor() { socket = this; } });
  const send = (message) => socket.onmessage({ data: JSON.stringify(message) });
  send({ type: "machine", protocol: 1, machine, name, source: { kind: "OPC UA" } });
  return [model, send];
}

/** Whether the one cell of a slice is reached on the branches of a pose. */
function cellOf(model, position, bytes, reference) {
  const found = [];
  globalThis.self = { postMessage: ({ rows }) => found.push(...rows.map((row) => [...row])) };
  serve();
  const nothing = [0, 0, 0];
  self.onmessage({ data: {
    name: model.name, parameters: model.parameters, cells: 1, corners: [position.position, nothing, nothing],
    rotation: position.rotation, what: model.description.margins[0].name, bytes, reference,
  } });
  return found[0][0] >= 0;
}

/** The Python that is copied where parameters are changed one after the other, as in their fields. */
export function copied({ name, changes, words }) {
  const model = new Model();
  model.open(name);
  changes.forEach(([parameter, value]) => model.setParameter(parameter, value));
  return pythonOf(model, words);
}

/** The limits of a machine that a controller names. */
export function limitsOfLive({ machine, name }) {
  return followed(machine, name)[0].machine.limits;
}

/** All poses that are found of a platform at its axes, from how many starts, and where it stands. */
export function posesOf({ name, parameters, axes }) {
  const model = new Model();
  model.open(name, { parameters, axes });
  const { frame, scene } = model.pose;
  const points = scene.bodies.flatMap((body) => [body.frame.position, ...body.lines.flat()]);
  return { ...[...posesFrom(model.machine, axes, points, frame)].at(-1), frame };
}

/** What a fragment of the address says. */
export function read(fragment) {
  return readFragment(fragment, new Model());
}
