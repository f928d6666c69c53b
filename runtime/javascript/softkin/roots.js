/** All roots of a search along one joint: the next one ahead, again and again around the circle. */

import { AHEAD, ELSEWHERE } from "./constants.js";

const [SEARCHES, LONGEST, NEAR] = [48, 0.5, 3e-5];

/**
 * The joints at all roots that fit, the nearest to the start first. Where the arm moves while its tool rests, every
 * joint value is a root: a stretch of them has one, and the nearest to the start is added. find: the program that finds
 * a root: whether there is one, how far it is from the start, and the joints; some tell also whether other joints stand
 * there, too, and these. start, onward: the places of the start among its arguments, and of the flag that asks for the
 * next root. count: that of the joints.
 */
export function everyRoot(find, k, given, start, onward, count) {
  const reference = given[start];
  const search = (at, isOnward) => {
    const values = [...given];
    values[start] = at;
    values[onward] = isOnward;
    return find(k, values);
  };
  const found = [];
  const keep = (away, results) => {
    found.push({ away, joints: results.slice(0, count) });
    if (results[count]) found.push({ away, joints: results.slice(count + 1) });
  };
  let moves = false;
  for (const begin of [reference + ELSEWHERE, reference + ELSEWHERE + 1.0]) {
    let [left, at, skip, isNear] = [2.0 * Math.PI - AHEAD, begin, 0.0, false];
    for (let searches = found.length > 0 ? SEARCHES : 0; searches < SEARCHES; searches += 1) {
      const [there, away, ...results] = search(at, true);
      left -= found.length > 0 ? away : 0.0;
      if (!there || left <= 0.0) break;
      at += away;
      const wasNear = isNear;
      isNear = found.length > 0 && away < NEAR;
      if (found.length > 0 && away < 1.1 * AHEAD) {
        // roots without end: nothing new is near
        skip = Math.min(Math.max(4.0 * skip, AHEAD), LONGEST);
        at += skip;
        left -= skip;
      } else {
        // between two roots that nearly join the pose is as good as met
        if (isNear && wasNear) found.pop();
        skip = 0.0;
        keep(distance(at - reference), results);
      }
      moves = moves || skip === LONGEST;
    }
  }
  if (moves) {
    const [there, away, ...results] = search(reference, false);
    if (there) keep(away, results);
  }
  return found.sort((a, b) => a.away - b.away).map((one) => one.joints);
}

/** How far a joint is from the start: a root as far to the other side is behind one ahead. */
function distance(difference) {
  const turn = 2.0 * Math.PI;
  const away = difference - AHEAD;
  return Math.abs(away - turn * Math.round(away / turn));
}
