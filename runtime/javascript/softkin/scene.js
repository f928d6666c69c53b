/**
 * What can be drawn of a machine at a pose: bodies with frames that move with them, and joints.
 *
 * @typedef {{name: string, kind: string, joints: string[], frame: {position: number[], rotation: number[][]},
 *   lines: number[][][]}} Body - kind: "base", "link", "rod", "plate" or "tool"; joints: the axes that move it against
 *   the body before it; frame: fixed in the body, its rotation by rows; lines: pairs of points of the body, in the
 *   frame of the machine. Two parallel rods that hold a plate have one name; a rod has isCable, too
 * @typedef {{joints: string[], kind: string, at: number[], axis: number[], body: number, travel: number}} Joint - kind:
 *   "turn" or "slide"; axis: of length one, a positive joint value turns counter-clockwise about it or moves along it;
 *   body: the number of the body that it moves; travel: of a slide, its way from `at - travel axis` to `at`
 * @typedef {{joints: string[], at: number[], axis: number[], body: number}} Motor - beside an axis that turns, of which
 *   it turns the body; none where a loop or a belt moves the joint, or several axes
 */

import { beltOf } from "./belt.js";

const IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
/** Vectors closer to parallel than this cosine count as parallel. */
const PARALLEL = 0.999;
const TINY = 1e-9;
/** Half of the drawn width of a parallelogram over the length of its rods. */
const HALF_WIDTH = 0.06;

/**
 * The scene of a machine: of a chain or of a loop.
 *
 * @param {object} parts - `parts` of a description
 * @param {number[][]} values - what the program of the parts computes
 * @param {number[]} position - of the tool
 * @param {number[][]} rotation - of the tool, by rows
 * @param {{name: string, lower: number | null, upper: number | null}[]} limits - of the machine
 * @returns {{bodies: Body[], joints: Joint[], motors: Motor[], belt: object | null}} belt: as `beltOf` gives it
 */
export function sceneOf(parts, values, position, rotation, limits) {
  const tool = { name: "tool", kind: "tool", joints: [], frame: { position, rotation }, lines: [] };
  const found = parts.kind === "chain" ? chainOf(parts, values, limits) : loopOf(parts, values, tool.frame);
  return { ...found, bodies: [...found.bodies, tool] };
}

/** A chain, composed from its base: a body between every two joints. */
function chainOf({ factors, loops = [], belt }, values, limits) {
  const [joints, motors] = [[], []];
  const moved = new Set(loops.flatMap((loop) => loop.joints));
  let [at, rows] = [[0, 0, 0], IDENTITY];
  let body = { name: "base", kind: "base", joints: [], frame: { position: at, rotation: rows }, lines: [] };
  const bodies = [body];
  let [shifts, start, last] = [[], at, null];
  const finish = (next) => {
    const order = (shift) => (last && isAlong(shift, last) ? 0 : next && isAlong(shift, next) ? 2 : 1);
    for (const shift of [...shifts].sort((a, b) => order(a) - order(b))) {
      const end = plus(start, shift);
      if (sizeOf(shift) > 0) body.lines.push([start, end]);
      start = end;
    }
    shifts = [];
    start = at;
  };
  const frames = [];
  for (const factor of factors) {
    frames.push([at, rows]);
    const [amount, rate] = values[factor.amount];
    const sense = rate < 0 ? -1 : 1;
    const direction = columnOf(rows, factor.axis);
    const isShift = factor.motion === "shift";
    const way = isShift ? times(amount, direction) : [0, 0, 0];
    const angle = factor.motion === "flip" ? Math.PI * amount : amount;
    if (factor.joints.length) finish(direction);
    at = plus(at, way);
    if (!isShift) rows = productOf(rows, turnAbout(factor.axis, angle));
    if (factor.joints.length) {
      body = { name: factor.joints.join(" "), kind: "link", joints: factor.joints, lines: [],
        frame: { position: at, rotation: rows } };
      bodies.push(body);
      joints.push({ joints: factor.joints, kind: isShift ? "slide" : "turn", at, body: bodies.length - 1,
        axis: times(sense, direction), travel: isShift ? sense * amount : 0 });
      if (!isShift && factor.joints.length === 1 && !moved.has(factor.joints[0])) {
        motors.push({ joints: factor.joints, at, axis: direction, body: bodies.length - 1 });
      }
      [start, last] = [at, direction];
    } else if (isShift) {
      shifts.push(way);
    }
  }
  finish(null);
  for (const loop of loops) {
    const [origin, axes] = frames[loop.at];
    const placed = (place) => plus(origin, axes.map((row) => dot(row, values[place])));
    const [start, tip] = [loop.start.map(placed), loop.tip.map(placed)];
    const line = [start[start.length - 1], tip[tip.length - 1]];
    const axis = unit(minus(line[1], line[0]));
    const frame = { position: line[0], rotation: frameAlong(axis) };
    bodies.push({ name: loop.name, kind: "rod", joints: loop.joints, frame, lines: [line] });
    if (loop.cylinder) {
      const slide = { joints: [loop.cylinder], kind: "slide", at: times(0.5, plus(...line)), axis };
      joints.push({ ...slide, body: bodies.length - 1, travel: sizeOf(minus(line[1], line[0])) });
    }
    for (const [word, pins] of [["crank", start], ["lever", tip]]) {
      const lines = pins.slice(1).map((pin, i) => [pins[i], pin]).filter((arm) => sizeOf(minus(arm[1], arm[0])) > TINY);
      if (!lines.length) continue;
      const own = { position: lines[0][0], rotation: frameAlong(unit(minus(lines[0][1], lines[0][0]))) };
      bodies.push({ name: `${word} beside the ${loop.name}`, kind: "link", joints: loop.joints, frame: own, lines });
      if (word === "crank" && loop.isFirst && !loop.cylinder && factors[loop.at].motion !== "shift") {
        const axis = columnOf(axes, factors[loop.at].axis);
        motors.push({ joints: loop.joints, at: pins[0], axis, body: bodies.length - 1 });
      }
    }
  }
  return { bodies, joints, motors, belt: belt ? beltAt(belt, factors, frames, values, limits) : null };
}

/** The belt on the frame that two shifts of the chain share. */
function beltAt(belt, factors, frames, values, limits) {
  const slides = belt.slides.map((k) => factors[k]);
  const [at, rows] = frames[belt.slides[0]];
  const own = limits.filter(({ name }) => slides[0].joints.includes(name));
  const ends = own.flatMap(({ lower, upper }) => [lower, upper]);
  const most = ends.includes(null) ? Infinity : Math.max(...ends.map(Math.abs));
  const place = slides.map(({ amount }) => values[amount][0]);
  return beltOf(belt, at, slides.map(({ axis }) => columnOf(rows, axis)), place, most);
}

/** A loop: its base, cranks, carriages, rods and plate. */
function loopOf(parts, values, tool) {
  const at = (place) => values[place];
  const base = { name: "base", kind: "base", joints: [], frame: { position: [0, 0, 0], rotation: IDENTITY },
    lines: ringOf(parts.base.map(at)) };
  const found = { bodies: [base], joints: [], motors: [], belt: null };
  const add = (body, joint) => {
    found.bodies.push(body);
    if (joint) found.joints.push({ ...joint, body: found.bodies.length - 1 });
  };
  for (const crank of parts.cranks) {
    add(...crankOf(crank, at));
    const { joints, at: centre, axis, body } = found.joints[found.joints.length - 1];
    if (crank.isHeld) found.motors.push({ joints, at: centre, axis, body });
  }
  for (const rail of parts.rails) {
    const way = minus(at(rail.at), at(rail.origin));
    const axis = unit(at(rail.direction));
    add({ name: rail.joint, kind: "link", joints: [rail.joint], frame: { position: at(rail.at), rotation: IDENTITY },
      lines: [] }, { joints: [rail.joint], kind: "slide", at: at(rail.at), axis, travel: dot(way, axis) });
  }
  const centre = tool.position;
  const plate = differentOf(parts.plate.map(at));
  const spokes = plate.filter((point) => sizeOf(minus(point, centre)) > TINY).map((point) => [centre, point]);
  for (const rod of parts.rods) {
    const [start, end] = [at(rod.start), at(rod.end)];
    const across = parts.isParallel ? acrossOf(rod, parts, at, centre) : null;
    const axis = unit(minus(end, start));
    const joint = rod.joints.length
      ? { joints: rod.joints, kind: "slide", at: times(0.5, plus(start, end)), axis, travel: sizeOf(minus(end, start)) }
      : null;
    const sides = across ? [across, times(-1, across)] : [[0, 0, 0]];
    for (const side of sides) {
      const line = [plus(start, side), plus(end, side)];
      const frame = { position: line[0], rotation: frameAlong(axis, across) };
      add({ name: rod.name, kind: "rod", isCable: rod.isCable, joints: rod.joints, frame, lines: [line] }, joint);
    }
  }
  add({ name: "plate", kind: "plate", joints: [], frame: tool, lines: [...ringOf(plate), ...spokes] });
  for (const { joint, kind, axis } of parts.carried) {
    found.joints.push({ joints: [joint], kind, at: centre, axis: unit(axis), body: found.bodies.length, travel: 0 });
  }
  return found;
}

/** A crank, from the centre of its circle to the middle between the ends that it moves; x of its frame is its arm. */
function crankOf(crank, at) {
  const ends = crank.ends.map(at);
  const around = at(crank.around);
  const middle = times(1 / ends.length, ends.reduce(plus));
  const axis = unit(cross(minus(ends[0], around), minus(at(crank.quarter), around)));
  const centre = plus(at(crank.centre), times(dot(minus(at(crank.foot), at(crank.centre)), axis), axis));
  const arm = crank.isHeld ? minus(middle, centre) : minus(ends[0], around);
  const along = unit(sizeOf(arm) > TINY ? arm : minus(ends[0], around));
  const lines = crank.isHeld ? [[centre, middle]] : [];
  if (ends.length > 1) lines.push([ends[0], ends[ends.length - 1]]);
  const frame = { position: centre, rotation: transposed([along, cross(axis, along), axis]) };
  return [
    { name: crank.joint, kind: "link", joints: [crank.joint], frame, lines },
    { joints: [crank.joint], kind: "turn", at: centre, axis, travel: 0 },
  ];
}

/** From the middle line of a parallelogram to one of its rods: along the axis of its crank, or level. */
function acrossOf(rod, parts, at, centre) {
  const [start, end] = [at(rod.start), at(rod.end)];
  const crank = parts.cranks.find((one) => one.ends.includes(rod.start));
  const rail = parts.rails.find((one) => at(one.at) === start);
  const axis = crank
    ? cross(minus(start, at(crank.around)), minus(at(crank.quarter), at(crank.around)))
    : cross(rail ? at(rail.direction) : [0, 0, 1], minus(end, start));
  const radius = sizeOf(minus(end, centre));
  const half = HALF_WIDTH * sizeOf(minus(end, start));
  return times(radius > TINY ? Math.min(half, 0.7 * radius) : half, unit(axis));
}

/** The lines of a ring through points; of two points the one line. */
function ringOf(points) {
  if (points.length < 2) return [];
  const lines = points.map((point, i) => [point, points[(i + 1) % points.length]]);
  return points.length > 2 ? lines : lines.slice(0, 1);
}

function differentOf(points) {
  return points.filter((one, i) => !points.slice(0, i).some((other) => sizeOf(minus(one, other)) <= TINY));
}

/** A rotation by rows whose x is a direction, and whose y is near to another one. */
function frameAlong(x, near) {
  const other = near ?? (Math.abs(x[2]) < PARALLEL ? [0, 0, 1] : [0, 1, 0]);
  const y = unit(minus(other, times(dot(other, x), x)));
  return transposed([x, y, cross(x, y)]);
}

function isAlong(shift, axis) {
  return Math.abs(dot(shift, axis)) > PARALLEL * sizeOf(shift);
}

function turnAbout(axis, angle) {
  const rows = IDENTITY.map((row) => [...row]);
  const [first, second] = [(axis + 1) % 3, (axis + 2) % 3];
  rows[first][first] = rows[second][second] = Math.cos(angle);
  [rows[first][second], rows[second][first]] = [-Math.sin(angle), Math.sin(angle)];
  return rows;
}

const plus = (a, b) => a.map((value, i) => value + b[i]);
const minus = (a, b) => a.map((value, i) => value - b[i]);
const times = (factor, a) => a.map((value) => factor * value);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const sizeOf = (a) => Math.hypot(...a);
const unit = (a) => (sizeOf(a) > 0 ? times(1 / sizeOf(a), a) : [1, 0, 0]);
const columnOf = (rows, k) => rows.map((row) => row[k]);
const transposed = (rows) => [0, 1, 2].map((k) => columnOf(rows, k));
const productOf = (a, b) => a.map((row) => [0, 1, 2].map((k) => dot(row, columnOf(b, k))));
