/** All roots of a search along one joint: the next one ahead, again and again around the circle. */

import { AHEAD, ELSEWHERE } from "./constants.js";

/**
 * The joints at all roots that fit, the nearest to the start first. find: the program that finds a root: whether there
 * is one, how far it is from the start, and the joints; some tell also whether other joints stand there, too, and these.
 * start, onward: the places of the start among its arguments, and of the flag that asks for the next root. count: that
 * of the joints.
 */
export function everyRoot(find, k, given, start, onward, count) {
  const reference = given[start];
  const turn = 2.0 * Math.PI;
  for (const begin of [reference + ELSEWHERE, reference + ELSEWHERE + 1.0]) {
    const found = [];
    let left = turn - AHEAD;
    let at = begin;
    for (;;) {
      const values = [...given];
      values[start] = at;
      values[onward] = true;
      const [there, away, ...results] = find(k, values);
      left -= found.length > 0 ? away : 0.0;
      if (!there || left <= 0.0) break;
      at += away;
      const one = { away: distance(at - reference), joints: results.slice(0, count) };
      found.push(one);
      if (results[count]) found.push({ ...one, joints: results.slice(count + 1) });
    }
    if (found.length > 0) return found.sort((a, b) => a.away - b.away).map((one) => one.joints);
  }
  return [];
}

/** How far a joint is from the start: a root as far to the other side is behind one ahead. */
function distance(difference) {
  const turn = 2.0 * Math.PI;
  const away = difference - AHEAD;
  return Math.abs(away - turn * Math.round(away / turn));
}
