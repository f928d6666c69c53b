/** Frames: angles A, B, C and quaternions from rotations by rows, and back; the way from one frame to another. */

const DEGREE = Math.PI / 180;
/** Below this sine of B its axis has no direction: A is 0 then, as in the Python package. */
const NO_DIRECTION = 1e-11;

/** Rz(A) Ry(B) Rz(C) by rows, angles in degrees: the convention of SoftMotion. */
export function rotationOf([a, b, c]) {
  const [ca, sa] = [Math.cos(a * DEGREE), Math.sin(a * DEGREE)];
  const [cb, sb] = [Math.cos(b * DEGREE), Math.sin(b * DEGREE)];
  const [cc, sc] = [Math.cos(c * DEGREE), Math.sin(c * DEGREE)];
  return [
    [ca * cb * cc - sa * sc, -ca * cb * sc - sa * cc, ca * sb],
    [sa * cb * cc + ca * sc, -sa * cb * sc + ca * cc, sa * sb],
    [-sb * cc, sb * sc, cb],
  ];
}

/** A, B, C in degrees of a rotation by rows: B in [0, 180]. */
export function anglesOf(rows) {
  const [x, y, z] = [rows[0][2], rows[1][2], rows[2][2]];
  const across = Math.hypot(x, y);
  const [ca, sa] = across > NO_DIRECTION ? [x / across, y / across] : [1, 0];
  const a = Math.atan2(sa, ca);
  const c = Math.atan2(ca * rows[1][0] - sa * rows[0][0], ca * rows[1][1] - sa * rows[0][1]);
  const b = Math.atan2(across > NO_DIRECTION ? across : 0, z);
  return [a / DEGREE, b / DEGREE, c / DEGREE];
}

/** The quaternion x, y, z, w of a rotation by rows. */
export function quaternionOf(rows) {
  const [[a, b, c], [d, e, f], [g, h, i]] = rows;
  const parts = [1 + a - e - i, 1 - a + e - i, 1 - a - e + i, 1 + a + e + i];
  const most = parts.indexOf(Math.max(...parts));
  const found = [
    [parts[0], b + d, c + g, h - f],
    [b + d, parts[1], f + h, c - g],
    [c + g, f + h, parts[2], d - b],
    [h - f, c - g, d - b, parts[3]],
  ][most];
  const size = Math.hypot(...found);
  return found.map((part) => part / size);
}

/** The rotation by rows of a quaternion x, y, z, w of length one. */
export function rowsOf([x, y, z, w]) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
}

/** The frame at a part of the way from one frame to another: position on the line, rotation about one axis. */
export function between(from, to, part) {
  const position = from.position.map((value, i) => value + part * (to.position[i] - value));
  const start = quaternionOf(from.rotation);
  let end = quaternionOf(to.rotation);
  let cosine = start.reduce((sum, value, i) => sum + value * end[i], 0);
  if (cosine < 0) [end, cosine] = [end.map((value) => -value), -cosine];
  const angle = Math.acos(Math.min(1, cosine));
  const sine = Math.sin(angle);
  const [first, second] = sine > 1e-9 ? [Math.sin((1 - part) * angle) / sine, Math.sin(part * angle) / sine] : [1 - part, part];
  const mixed = start.map((value, i) => first * value + second * end[i]);
  const size = Math.hypot(...mixed);
  return { position, rotation: rowsOf(mixed.map((value) => value / size)) };
}

/** A frame of the six numbers X, Y, Z, A, B, C. */
export function frameOf(numbers) {
  return { position: numbers.slice(0, 3), rotation: rotationOf(numbers.slice(3, 6)) };
}

/** The six numbers X, Y, Z, A, B, C of a frame. */
export function numbersOf({ position, rotation }) {
  return [...position, ...anglesOf(rotation)];
}
