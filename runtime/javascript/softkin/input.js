/** What a caller gives becomes arrays of numbers, or a refusal says what is wrong with it. No value raises an error. */

import { LARGEST, Status } from "./constants.js";
import { Refusal, refuse } from "./refusal.js";

const IDENTITY = Object.freeze([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);

/** An array of `count` numbers, which may be NaN or infinite: programs test their size. */
export function numbersOf(values, count, what) {
  const found = listOf(values);
  if (found === null || found.length !== count || !found.every((value) => typeof value === "number")) {
    return refuse(Status.BAD_INPUT, `${what} must be ${count} numbers`);
  }
  return found;
}

/** Position and rotation of a frame; the rotation of a machine that reads none is not looked at. */
export function poseOf(frame, readsRotation) {
  const position = numbersOf(memberOf(frame, "position"), 3, "position");
  if (position instanceof Refusal) return position;
  if (!readsRotation) return [position, IDENTITY];
  const rows = listOf(memberOf(frame, "rotation"));
  const rotation = rows === null || rows.length !== 3 ? [null] : rows.map((row) => numbersOf(row, 3, "row"));
  if (rotation.some((row) => !Array.isArray(row))) {
    return refuse(Status.BAD_INPUT, "rotation must be three rows of three numbers");
  }
  return [position, rotation];
}

/** `count` signed bytes, where 128 to 255 stand for the negative ones. */
export function bytesOf(configuration, count) {
  const found = listOf(configuration);
  if (found === null || found.length !== count || !found.every((n) => Number.isInteger(n) && n >= -128 && n <= 255)) {
    return refuse(Status.BAD_INPUT, `configuration must be ${count} bytes, -128 to 255`);
  }
  return found.map((byte) => (byte > 127 ? byte - 256 : byte));
}

/** The parameters by name, each in its type; `limits` may hold the ends of axes. */
export function parametersOf(description, given, limits) {
  if (given === null || typeof given !== "object") return refuseParameters("parameters must be an object", []);
  const found = {};
  const unknown = namesOf(given).find((name) => !description.parameters.some((p) => p.name === name));
  if (unknown !== undefined) return refuseParameters("there is no parameter of this name", [unknown]);
  for (const parameter of description.parameters) {
    const own = memberOf(given, parameter.name);
    const value = parameterValue(parameter, own === undefined ? parameter.default : own);
    if (value === null || !isAllowed(parameter, value)) return refuseRange(parameter);
    found[parameter.name] = value;
  }
  return limits === undefined || limits === null ? found : withEnds(description, found, limits);
}

/** A refusal of parameters: the condition that they violate, and their names. */
export function refuseParameters(condition, names) {
  const refusal = refuse(Status.NOT_INITIALIZED, condition);
  refusal.parameters = names;
  return refusal;
}

/** The values that a parameter may have, in words. */
export function rangeOf(parameter) {
  if (parameter.kind === "flag") return "true or false";
  if (parameter.kind === "sign") return "1 or -1";
  return `${parameter.lowIsOpen ? "more than" : "at least"} ${parameter.low} and at most ${parameter.high}`;
}

function refuseRange(parameter) {
  return refuseParameters(`${parameter.name} must be ${rangeOf(parameter)} (${parameter.meaning})`, [parameter.name]);
}

/** A number, or a flag as true or false; null if it is neither. */
function parameterValue(parameter, value) {
  if (typeof value !== "number" && typeof value !== "boolean") return null;
  const number = Number(value);
  if (parameter.kind === "flag") return number === 0 || number === 1 ? number === 1 : null;
  return Number.isNaN(number) ? null : number;
}

function isAllowed(parameter, value) {
  if (parameter.kind === "flag") return true;
  if (parameter.kind === "sign") return value === 1 || value === -1;
  if (["signed length", "transmission"].includes(parameter.kind) && value === 0) return false;
  const isAbove = parameter.lowIsOpen ? value > parameter.low : value >= parameter.low;
  return isAbove && value <= Math.min(parameter.high, LARGEST);
}

/** The parameters with the limits that a mapping gives; an end that is null has no limit, and is infinite. */
function withEnds(description, found, limits) {
  if (typeof limits !== "object") return refuseParameters("limits must be an object, by the names of axes", []);
  const changed = { ...found };
  for (const name of namesOf(limits)) {
    const limit = description.limits.find((one) => one.name === name);
    if (!limit) return refuseParameters(`there are no limits of ${name}`, []);
    const own = memberOf(limits, name);
    const pair = own === null ? [null, null] : listOf(own);
    if (pair === null || pair.length !== 2) return refuseParameters(`limits of ${name} must be [lower, upper]`, []);
    const ends = [limit.lower, limit.upper].map((parameter, side) => endOf(description, parameter, pair[side], side));
    const refused = ends.find((end) => end instanceof Refusal);
    if (refused) return refused;
    if (!(ends[0] < ends[1])) return refuseParameters(`limits of ${name}: lower must be below upper`, []);
    const isFree = !ends.some(Number.isFinite);
    [limit.lower, limit.upper].forEach((parameter, side) => {
      changed[parameter] = isFree ? 0 : ends[side];
    });
    const twice = [limit.lower, limit.upper].find((end) => found[end] !== defaultOf(description, end));
    if (twice) return refuseParameters("limits are given once: as a mapping, or each by itself", [twice]);
  }
  return changed;
}

function endOf(description, name, value, side) {
  if (value === null) return side ? Infinity : -Infinity;
  const parameter = description.parameters.find((p) => p.name === name);
  const number = parameterValue(parameter, value);
  return number === null || !isAllowed(parameter, number) ? refuseRange(parameter) : number;
}

function defaultOf(description, name) {
  return description.parameters.find((p) => p.name === name).default;
}

/** An array of what an array or a typed array holds; null for anything else. */
function listOf(values) {
  try {
    return Array.isArray(values) || ArrayBuffer.isView(values) ? Array.from(values) : null;
  } catch {
    return null;
  }
}

/** A member of an object itself; undefined where it has none. */
function memberOf(given, name) {
  try {
    return Object.prototype.hasOwnProperty.call(given, name) ? given[name] : undefined;
  } catch {
    return undefined;
  }
}

function namesOf(given) {
  try {
    return Object.keys(given);
  } catch {
    return [];
  }
}
