/** Light, and the place of a camera. */

import { AmbientLight, DirectionalLight, HemisphereLight } from "three";

/** The direction from which one looks at first, of length one, and the room around the ball of the machine. */
const FROM = [0.605, -0.658, 0.447];
const ROOM = 1.25;
/** The light of a scene. */
export function lights() {
  const sun = new DirectionalLight(0xffffff, 2.1);
  sun.position.set(2, -3, 4);
  const other = new DirectionalLight(0xffffff, 0.7);
  other.position.set(-3, 2, 1);
  const sky = new HemisphereLight(0xffffff, 0x8890a0, 1.0);
  sky.position.set(0, 0, 1);
  return [sun, other, sky, new AmbientLight(0xffffff, 0.35)];
}

/** Place a camera so that it sees all of an extent. */
export function lookAt(camera, { centre, size }) {
  const narrow = Math.min(1, camera.aspect) * Math.tan((camera.fov / 2) * (Math.PI / 180));
  const away = (ROOM * size) / 2 / Math.sin(Math.atan(narrow));
  camera.up.set(0, 0, 1);
  camera.position.set(...FROM.map((value, i) => centre[i] + away * value));
  camera.lookAt(...centre);
  rangeOf(camera, size);
}

/** The nearest and the farthest that is drawn of a machine of a size. */
export function rangeOf(camera, size) {
  camera.near = size / 100;
  camera.far = size * 60;
  camera.updateProjectionMatrix();
}
