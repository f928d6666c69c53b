/**
 * The calls that all machines share, around the programs of each.
 *
 * No call raises an error: each returns an object with a `status`, which is 0 where it succeeds. Only then it has
 * results; else it has what `Refusal.told` gives: reason, unit, missing, turn. Positions are in the user's length unit
 * (u), axes in degrees or in that unit, the Jacobian per radian.
 *
 * @typedef {{position: number[], rotation: number[][]}} Frame - position (3), rotation by rows (3, 3); a machine whose
 *   description says `readsRotation: false` needs no rotation
 * @typedef {object} Description - `description` of a module. axes: in their order, `period` is 360 where a full turn
 *   leads to the same pose, else null; parameters: names, kinds, units, ranges, defaults (null: it must be given) and
 *   nominal values; limits: what has limits, with the names of its parameters; configuration: the bytes, of a branch
 *   with the names of 1 and 2; margins: the singularities, "type 1" (serial) or "type 2" (parallel); drawn: axis values
 *   of a pose to show with nominal parameters
 */

import {
  AUTOMATIC, branchByte, slotsOf, squaredDistance, turnInside, turnOf,
} from "./configuration.js";
import { COINCIDENT, MEANINGS, Status, TIE } from "./constants.js";
import { bytesOf, numbersOf, parametersOf, poseOf, refuseParameters } from "./input.js";
import { constantsOf } from "./limits.js";
import { isReasonable, solveLinear } from "./numbers.js";
import { Refusal, inWords, refuse } from "./refusal.js";
import { findRotation } from "./rotation.js";
import { everyRoot } from "./roots.js";
import { sceneOf } from "./scene.js";

export * from "./numbers.js";
export { MEANINGS, Refusal, Status, everyRoot, inWords, refuse, refuseParameters, turnInside };

/** Plain data that nobody can change. */
export function freeze(data) {
  Object.values(data).forEach((part) => typeof part === "object" && part !== null && freeze(part));
  return Object.freeze(data);
}

/** Axes that differ by less (degrees, lengths) are one solution of a searched branch, found twice. */
const SAME = 2e-3;

/**
 * A machine with its parameters.
 *
 * @param {object} description - what the module of the mechanism exports
 * @param {object} programs - the functions of that module
 * @param {object} parameters - by name, as in `description.parameters`: numbers, true or false for a flag
 * @param {object} [limits] - limits by the name of an axis, [lower, upper], null for an end or for both without a limit
 * @returns {{status: number, machine: ?Machine}} or, where the parameters are not allowed, status 1 with the reason,
 *   and `parameters`: the names of those that are at fault
 */
export function createMachine(description, programs, parameters, limits) {
  const given = parametersOf(description, parameters, limits);
  const found = given instanceof Refusal ? given : constantsOf(description, programs, given);
  if (found instanceof Refusal) return { ...found.told(), parameters: found.parameters };
  return { status: Status.OK, machine: new Machine(description, programs, given, found) };
}

/** A machine, which never changes. It is made by `create` of a module. */
export class Machine {
  constructor(description, programs, parameters, { constants, windows }) {
    this.description = description;
    this.parameters = Object.freeze(parameters);
    /** The limits of axes, then of other quantities: {name, lower, upper}, null if there is none. */
    this.limits = Object.freeze(windows.map(Object.freeze));
    /** Whether the inverse is a search along a joint: then a branch may have several solutions. */
    this.isSearched = Boolean(programs.allJoints) && (!programs.isSearched || programs.isSearched(constants));
    this._programs = programs;
    this._k = constants;
    Object.freeze(this);
  }

  /**
   * The frame at axis values, and their configuration. Limits are not tested.
   *
   * @param {number[]} axes - one value for each axis
   * @param {Frame} [start] - where a search for the frame begins, of a machine that has `startsForward`: the frame that
   *   the axes have, or one nearby, as the previous one on a path; the home pose if there is none. Another machine has
   *   one frame, whatever the start
   * @returns {{status: number, frame: Frame, configuration: number[], margins: number[]}} margins: the signed margins
   *   of the branches. Refused: BAD_INPUT, IMPOSSIBLE
   */
  forward(axes, start) {
    const values = this._axes(axes);
    if (values instanceof Refusal) return values.told();
    const pose = this._asks("forward", values, start);
    if (pose instanceof Refusal) return pose.told();
    const [position, rotation, margins] = pose;
    return { status: Status.OK, frame: { position, rotation }, configuration: this._written(margins, values), margins };
  }

  /**
   * The same machine in the other assembly mode, of one that has `startsForward`: its `forward` finds the poses that
   * this one refuses as those of the other mode. Its home pose is not one of them: give a start.
   *
   * @returns {Machine}
   */
  inOtherAssembly() {
    const constants = { ...this._k, assembly_sign: -this._k.assembly_sign };
    return new Machine(this.description, this._programs, this.parameters, { constants, windows: [...this.limits] });
  }

  /**
   * The axis values that reach a frame.
   *
   * @param {Frame} frame - a rotation with few exact digits, as from single precision, is repaired
   * @param {number[]} [configuration] - see `description.configuration`; the default one if there is none. Of open
   *   branches the solution nearest to the reference is taken
   * @param {number[]} [reference] - one value for each axis, usually the present ones; zeros if there is none
   * @returns {{status: number, axes: number[]}} Refused: BAD_INPUT, UNREACHABLE (out of reach, or beyond a limit;
   *   `turn` then names a turn that is inside), IMPOSSIBLE
   */
  inverse(frame, configuration, reference) {
    const asked = this._asked(frame, reference);
    if (asked instanceof Refusal) return asked.told();
    const bytes = this._bytes(configuration);
    if (bytes instanceof Refusal) return bytes.told();
    const rotation = this._made(asked.rotation);
    if (rotation instanceof Refusal) return rotation.told();
    const [branches, turns] = [bytes.slice(0, this.description.branchCount), bytes.slice(this.description.branchCount)];
    const axes = this._choose({ ...asked, rotation }, branches, turns);
    const refused = axes instanceof Refusal ? axes : this._beyond(axes);
    return refused ? refused.told() : { status: Status.OK, axes };
  }

  /**
   * Every branch of the inverse, in fixed slots: branch 1 before branch 2, the first byte varies fastest.
   *
   * Turns are open, as in `inverse`. No slot is left out: one without axes has a status and a reason, also where the
   * axes are beyond limits.
   * @param {Frame} frame
   * @param {number[]} [reference]
   * @returns {{status: number, slots: {status: number, configuration: number[], axes: number[], others: number[][]}[]}}
   *   others: further solutions of the same branch, of a searched machine. Refused: BAD_INPUT, for what has not the
   *   form of a frame or of a reference
   */
  inverseAll(frame, reference) {
    const asked = this._asked(frame, reference);
    if (asked instanceof Refusal) return asked.told();
    const every = slotsOf(new Array(this.description.branchCount).fill(AUTOMATIC));
    const rotation = this._made(asked.rotation);
    const given = { ...asked, rotation };
    const found = (slot) => (rotation instanceof Refusal ? rotation : this._inside(slot.signs, given));
    const isSearch = this.isSearched && !(rotation instanceof Refusal);
    const slots = isSearch ? this._searched(every, given) : every.map((slot) => this._slot(slot, found(slot)));
    return { status: Status.OK, slots };
  }

  /**
   * The Jacobian at axis values, per radian for an axis in degrees.
   *
   * @param {number[]} axes
   * @param {Frame} [start] - the frame that the axes have, as in `forward`
   * @returns {{status: number, rows: number[][]}} rows as in `description.jacobianRows`, one column for each axis
   */
  jacobian(axes, start) {
    const values = this._axes(axes);
    const rows = values instanceof Refusal ? values : this._asks("jacobian", values, start);
    return rows instanceof Refusal ? rows.told() : { status: Status.OK, rows };
  }

  /**
   * The velocities of the axes for a twist of the frame, both per radian: the inverse of the Jacobian. An axis that is
   * held does not move.
   *
   * @param {number[]} axes
   * @param {number[]} twist - rows as in `description.jacobianRows`
   * @param {Frame} [start] - the frame that the axes have, as in `forward`
   * @returns {{status: number, velocities: number[]}} Refused: BAD_INPUT, IMPOSSIBLE at a singular pose
   */
  axisVelocities(axes, twist, start) {
    const wanted = this._rows(twist, "twist");
    const velocities = wanted instanceof Refusal ? wanted : this._solved(axes, wanted, start);
    return velocities instanceof Refusal ? velocities.told() : { status: Status.OK, velocities };
  }

  /**
   * The accelerations of the axes that give the frame an acceleration, per radian.
   *
   * @param {number[]} axes
   * @param {number[]} velocities - those that the axes have, as `axisVelocities` finds them
   * @param {number[]} twistRate - the rate of the twist; zeros on a straight line at constant speed
   * @param {Frame} [start] - the frame that the axes have, as in `forward`
   * @returns {{status: number, accelerations: number[]}} Refused: as `axisVelocities`
   */
  axisAccelerations(axes, velocities, twistRate, start) {
    const accelerations = this._accelerations(axes, velocities, twistRate, start);
    return accelerations instanceof Refusal ? accelerations.told() : { status: Status.OK, accelerations };
  }

  /**
   * The singularity margins at axis values. Axis values that allow no pose are singular, and have none.
   *
   * @param {number[]} axes
   * @param {Frame} [start] - the frame that the axes have, as in `forward`
   * @returns {{status: number, isSingular: boolean, margins: Object<string, number>}} margins: dimensionless and
   *   signed, by name; singular where one is smaller in size than the parameter that
   *   `description.settings.warningDistance` names
   */
  singularity(axes, start) {
    const values = this._axes(axes);
    const margins = values instanceof Refusal ? values : this._asks("singularity", values, start);
    if (margins instanceof Refusal) return { ...margins.told(), isSingular: true };
    const near = this.parameters[this.description.settings.warningDistance];
    const named = Object.fromEntries(this.description.margins.map(({ name }, i) => [name, margins[i]]));
    return { status: Status.OK, isSingular: margins.some((margin) => Math.abs(margin) < near), margins: named };
  }

  /**
   * The values of what has limits: of every axis, then of every other quantity, by its name.
   *
   * @param {number[]} axes
   * @returns {{status: number, values: Object<string, number>, beyond: ?object}} beyond: the limit that the axes
   *   exceed, as a refusal; null if they exceed none, or limits are not tested
   */
  limited(axes) {
    const values = this._axes(axes);
    const more = values instanceof Refusal ? values : this._programs.quantities?.(this._k, values) ?? [];
    if (more instanceof Refusal) return more.told();
    const named = Object.fromEntries(this.description.limits.map(({ name }, i) => [name, [...values, ...more][i]]));
    return { status: Status.OK, values: named, beyond: this._beyond(values)?.told() ?? null };
  }

  /**
   * What can be drawn at axis values: see `scene.js`.
   *
   * @param {number[]} axes
   * @param {Frame} [frame] - that of the tool at these axes where it is known, as after `inverse`; else `forward` finds
   *   it
   * @returns {{status: number, bodies: object[], joints: object[], motors: object[], belt: object | null}} bodies: the
   *   base first, the tool last
   */
  scene(axes, frame) {
    const values = this._axes(axes);
    if (values instanceof Refusal) return values.told();
    if (!this._programs.parts) return refuse(Status.IMPOSSIBLE, "there is no drawing of this machine").told();
    const known = frame === undefined || frame === null ? this._programs.forward(this._k, values) : poseOf(frame, true);
    if (known instanceof Refusal) return known.told();
    const [position, rotation] = known;
    if (!isReasonable(...values, ...position, ...rotation.flat())) return refuse(Status.BAD_INPUT).told();
    const found = this._programs.parts(this._k, values, position, rotation);
    return { status: Status.OK, ...sceneOf(this.description.parts, found, position, rotation, this.limits) };
  }

  _accelerations(axes, velocities, twistRate, start) {
    const wanted = this._rows(twistRate, "twistRate");
    if (wanted instanceof Refusal) return wanted;
    const [values, speeds] = [this._axes(axes), numbersOf(velocities, this.description.axes.length, "velocities")];
    if (values instanceof Refusal || speeds instanceof Refusal) return values instanceof Refusal ? values : speeds;
    const bias = this._asks("bias", values, start, speeds);
    return bias instanceof Refusal ? bias : this._solved(axes, wanted.map((value, i) => value - bias[i]), start);
  }

  /** Numbers for the rows of the Jacobian. */
  _rows(values, what) {
    const found = numbersOf(values, this.description.jacobianRows.length, what);
    return found instanceof Refusal || isReasonable(...found) ? found : refuse(Status.BAD_INPUT);
  }

  /** The values of the axes whose product with the Jacobian is wanted. */
  _solved(axes, wanted, start) {
    const values = this._axes(axes);
    const rows = values instanceof Refusal ? values : this._asks("jacobian", values, start);
    if (rows instanceof Refusal) return rows;
    const moving = this.description.axes.map(({ isHeld }, i) => (isHeld ? -1 : i)).filter((i) => i >= 0);
    const matrix = rows.map((row) => moving.map((i) => row[i]));
    const solved = rows.length ? solveLinear(matrix, wanted.map((value) => [value])) : [1];
    if (this.singularity(axes, start).isSingular || solved[0] === 0) {
      return refuse(Status.IMPOSSIBLE, "the pose is singular");
    }
    const found = values.map(() => 0);
    rows.forEach((_, i) => { found[moving[i]] = solved[i + 1]; });
    return found;
  }

  _axes(axes) {
    return numbersOf(axes, this.description.axes.length, "axes");
  }

  /** The answer of a program for axis values and more, whose forward kinematics begins at a start. */
  _asks(program, values, start, ...more) {
    const isAsked = this.description.startsForward && start !== undefined && start !== null;
    if (!isAsked) return this._programs[program](this._k, values, ...more);
    const pose = poseOf(start, true);
    const rotation = pose instanceof Refusal ? pose : findRotation(null, pose[1]);
    if (rotation instanceof Refusal) return rotation;
    const there = [["x", "y", "z"].map((name, i) => [`start_${name}`, pose[0][i]])];
    rotation.forEach((row, i) => there.push(row.map((value, k) => [`start_r${i + 1}${k + 1}`, value])));
    return this._programs[program]({ ...this._k, ...Object.fromEntries(there.flat()) }, values, ...more);
  }

  /** What an inverse is asked: position and rotation as given, and the reference. */
  _asked(frame, reference) {
    const pose = poseOf(frame, this.description.readsRotation);
    if (pose instanceof Refusal) return pose;
    const near = this._reference(reference);
    return near instanceof Refusal ? near : { position: pose[0], rotation: pose[1], near };
  }

  _reference(reference) {
    const { axes } = this.description;
    if (reference !== undefined && reference !== null) return numbersOf(reference, axes.length, "reference");
    const held = axes.filter((axis) => axis.isHeld).map((axis) => axis.name);
    if (!held.length) return new Array(axes.length).fill(0);
    return refuse(Status.BAD_INPUT, `a reference is needed: it holds the value of ${held.join(" and ")}`);
  }

  _bytes(configuration) {
    const { defaultConfiguration, branchCount } = this.description;
    const given = configuration === undefined || configuration === null ? defaultConfiguration : configuration;
    const bytes = bytesOf(given, defaultConfiguration.length);
    if (bytes instanceof Refusal) return bytes;
    const place = bytes.slice(0, branchCount).findIndex((byte) => byte < 0 || byte > 3);
    return place < 0 ? bytes : refuse(Status.BAD_INPUT, `byte ${place} of the configuration means nothing`);
  }

  _made(rotation) {
    return this.description.readsRotation ? findRotation(null, rotation) : rotation;
  }

  _branch({ position, rotation, near }, signs, turns) {
    return this._programs.branch(this._k, position, rotation, signs, turns, near);
  }

  _openTurns() {
    return new Array(this.description.periodAxes.length).fill(0);
  }

  /** The axes on the slot that bytes name, or on the nearest of the open ones; if all refuse, the first reason. */
  _choose(given, branches, turns) {
    const found = slotsOf(branches).map(({ signs }) => this._branch(given, signs, turns));
    const answers = found.filter((axes) => !(axes instanceof Refusal));
    if (!answers.length) return found[0];
    return answers.reduce((best, axes) => (this._isNearer(axes, best, given.near) ? axes : best));
  }

  _isNearer(axes, other, near) {
    const counted = this.description.distanceAxes;
    const tie = this._programs.tie ? this._programs.tie(this._k) : TIE;
    return squaredDistance(axes, near, counted) < squaredDistance(other, near, counted) - tie;
  }

  _beyond(axes) {
    return this.parameters[this.description.settings.checkLimits] ? this._programs.limits(this._k, axes) : null;
  }

  _inside(signs, given) {
    const axes = this._branch(given, signs, this._openTurns());
    return axes instanceof Refusal ? axes : this._beyond(axes) ?? axes;
  }

  _slot({ bytes }, found, others = []) {
    if (found instanceof Refusal) return { ...found.told(), configuration: [...bytes, ...this._openTurns()] };
    return { status: Status.OK, configuration: [...bytes, ...this._turns(found)], axes: found, others };
  }

  _written(margins, axes) {
    return [...margins.map(branchByte), ...this._turns(axes)];
  }

  _turnSizes() {
    return this._programs.turnSizes ? this._programs.turnSizes(this._k) : this._openTurns().fill(1);
  }

  _turns(axes) {
    const sizes = this._turnSizes();
    return this.description.periodAxes.map((index, i) => turnOf(sizes[i] * axes[index]));
  }

  /** Every slot of a searched machine: all roots of a search for each choice of signs that it knows. */
  _searched(every, given) {
    const { sides, branchCount } = this.description;
    const found = new Map();
    const scans = new Map(every.map(({ signs }) => [signs.slice(0, sides).join(), signs]));
    const turns = this._openTurns();
    for (const signs of scans.values()) {
      const open = [...signs.slice(0, sides), ...new Array(branchCount - sides).fill(0)];
      const asked = this._programs.searchGiven(this._k, given.position, given.rotation, open, turns, given.near);
      if (asked instanceof Refusal) return every.map((slot) => this._slot(slot, asked));
      for (const joints of this._programs.allJoints(this._k, asked)) {
        this._sortIn(found, this._programs.fromJoints(this._k, joints, turns, given.near));
      }
    }
    let empty = null; // why a branch has no root: the same for all that have none
    return every.map((slot) => {
      const own = found.get(slot.signs.join()) ?? [];
      const allowed = own.filter((axes) => !this._beyond(axes));
      if (allowed.length) return this._slot(slot, allowed[0], allowed.slice(1));
      if (own.length) return this._slot(slot, this._beyond(own[0]));
      empty = empty ?? this._branch(given, slot.signs, turns);
      return this._slot(slot, empty instanceof Refusal ? empty : refuse(Status.UNREACHABLE));
    });
  }

  /** Add a solution under the signs of its branch; where branches coincide, under the signs of both. */
  _sortIn(found, axes) {
    const pose = axes instanceof Refusal ? axes : this._programs.forward(this._k, axes);
    if (pose instanceof Refusal) return;
    let signs = [[]];
    for (const margin of pose[2]) {
      const sides = Math.abs(margin) < COINCIDENT ? [1, -1] : [margin > 0 ? 1 : -1];
      signs = signs.flatMap((s) => sides.map((side) => [...s, side]));
    }
    for (const key of signs.map((s) => s.join())) {
      const others = found.get(key) ?? [];
      if (!others.some((other) => this._isSame(axes, other))) found.set(key, [...others, axes]);
    }
  }

  /** Whether axes differ by full turns alone. */
  _isSame(axes, other) {
    const apart = axes.map((value, i) => Math.abs(value - other[i]));
    const sizes = this._turnSizes();
    this.description.periodAxes.forEach((index, i) => {
      const turned = sizes[i] * apart[index] + 180;
      apart[index] = Math.abs(turned - 360 * Math.floor(turned / 360) - 180) / sizes[i];
    });
    return Math.max(...apart) < SAME;
  }
}
