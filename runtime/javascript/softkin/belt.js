/** A belt that two motors share, with its wheels and its frame, at a place of the carriage. */

/** The size of a frame without limits, and the parts of its size that the carriage may be away from its middle. */
const [USUAL, ROOM] = [400, [0.45, 0.33]];
/** The angle between two points of the belt on a wheel, in degrees. */
const STEP = 15;

/**
 * The belt lies in a plane with two directions, along which the carriage has moved from a point of the base.
 *
 * @param {object} layout - `belt` of the parts of a description
 * @param {number[]} at - that point
 * @param {number[][]} directions
 * @param {number[]} place - the way of the carriage along both
 * @param {number} most - the largest way that limits allow; infinite without limits
 * @returns {{path: number[][], wheels: {at: number[], joint: string}[], frame: {line: number[][], kind: string}[],
 *   carriage: number[], radius: number, normal: number[]}} path: the points of the belt, from the carriage and back to
 *   it; joint: of a wheel that a motor turns, its axis; frame: rails (kind "base"), and the beam or the arm that moves
 *   on them ("link")
 */
export function beltOf(layout, at, directions, place, most) {
  const size = sizeOf(place, most);
  const inPlane = (flat) => at.map((value, i) => value + flat[0] * directions[0][i] + flat[1] * directions[1][i]);
  const flatAt = ([origin, first, second]) =>
    [0, 1].map((i) => size * (origin[i] - layout.held[i]) + place[0] * first[i] + place[1] * second[i]);
  const radius = size * layout.radius;
  const path = [flatAt(layout.ends[0])];
  for (const { at: centre, from, to } of layout.wheels) {
    const [x, y] = flatAt(centre);
    const count = Math.round(Math.abs(to - from) / STEP);
    for (let k = 0; k <= count; k += 1) {
      const angle = ((from + (k * (to - from)) / count) * Math.PI) / 180;
      path.push([x + radius * Math.cos(angle), y + radius * Math.sin(angle)]);
    }
  }
  path.push(flatAt(layout.ends[1]));
  const [[a, b, c], [d, e, f]] = directions;
  return {
    path: path.map(inPlane),
    wheels: layout.wheels.map(({ at: centre, joint }) => ({ at: inPlane(flatAt(centre)), joint })),
    frame: layout.frame.map(({ ends, body }) => ({ line: ends.map((end) => inPlane(flatAt(end))), kind: body })),
    carriage: inPlane(place),
    radius,
    normal: [b * f - c * e, c * d - a * f, a * e - b * d],
  };
}

/** As large as limits allow, else the usual size; doubled until the carriage has room. */
function sizeOf(place, most) {
  const needed = Math.max(...place.map((way, i) => Math.abs(way) / ROOM[i]));
  let size = Number.isFinite(most) && most > 0 ? most / Math.min(...ROOM) : USUAL;
  while (size < needed && Number.isFinite(needed)) size *= 2;
  return size;
}
