/** The limits of axes and of other quantities, which are constants of a machine. */

import { GEARED_TURN, LARGEST, LIMIT, ONE_TURN } from "./constants.js";
import { refuseParameters } from "./input.js";
import { Refusal } from "./refusal.js";

/** The constants of a machine, and its limits, or why its parameters are not allowed. */
export function constantsOf(description, programs, parameters) {
  const windows = [];
  const isTested = parameters[description.settings.checkLimits];
  const window = (key, otherwise = null, turns = null) => {
    const limit = description.limits.find((one) => one.key === key);
    const found = windowOf(limit, parameters, isTested, otherwise, turns);
    windows.push({ name: limit.name, ...found.ends });
    return found instanceof Refusal ? found : found.values;
  };
  const constants = programs.constants(parameters, window);
  return constants instanceof Refusal ? constants : { constants, windows };
}

/**
 * The range of an axis or of another quantity. values: lower limit with its tolerance, upper limit, whether the limits
 * leave one value for every direction at most, and the middle. ends: the limits, null if there is none.
 *
 * otherwise: the range if no limits are given; turns: with a gear, those of the joint per turn of the axis.
 */
function windowOf(limit, parameters, isTested, otherwise, turns) {
  const [lower, upper] = [parameters[limit.lower], parameters[limit.upper]];
  const isGiven = Math.abs(lower) + Math.abs(upper) > 0;
  const refused = () => refuseParameters(`${limit.lower} below ${limit.upper}, or both 0`, [limit.lower, limit.upper]);
  if (isGiven && !(lower < upper)) return refused();
  let [low, high] = isGiven || otherwise === null ? [lower, upper] : otherwise;
  if (!(Number.isFinite(low) && Number.isFinite(high))) {
    const finite = [low, high].filter(Number.isFinite);
    if (otherwise !== null) [low, high] = [Math.max(low, otherwise[0]), Math.min(high, otherwise[1])];
    if (!(low < high)) return refused();
    const tolerance = LIMIT + finite.reduce((sum, end) => sum + LIMIT * Math.abs(end), 0);
    const lowest = isTested && Number.isFinite(low) ? low - tolerance : -LARGEST;
    const highest = isTested && Number.isFinite(high) ? high + tolerance : LARGEST;
    const [first, last] = [low, high].map((end) => (Number.isFinite(end) ? end : null));
    return { values: [lowest, highest, false, 0], ends: { lower: first, upper: last } };
  }
  const tolerance = LIMIT + LIMIT * Math.abs(low) + LIMIT * Math.abs(high);
  const hasLimits = isGiven || otherwise !== null;
  const isSingle = turns === null
    ? high - low <= ONE_TURN + tolerance
    : (high - low + 2 * tolerance) * turns <= GEARED_TURN;
  const isWide = !(hasLimits && isTested);
  const values = [
    isWide ? -LARGEST : low - tolerance, isWide ? LARGEST : high + tolerance,
    hasLimits && isSingle, 0.5 * low + 0.5 * high,
  ];
  return { values, ends: { lower: hasLimits ? low : null, upper: hasLimits ? high : null } };
}
