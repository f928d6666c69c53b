/** Frames, directions and extents in space. */

import { Matrix4, Quaternion, Vector3 } from "three";
import { shapesOf } from "./shapes.js";

/** The matrix of a frame. */
export function matrixOf({ position, rotation }) {
  const [a, b, c] = rotation;
  return new Matrix4().set(...a, position[0], ...b, position[1], ...c, position[2], 0, 0, 0, 1);
}

export function quaternionFrom(frame) {
  return new Quaternion().setFromRotationMatrix(matrixOf(frame));
}

/** The rotation of a block whose y lies along an axis, and whose z is level where it can be. */
export function levelAlong(axis) {
  const side = Math.abs(axis.z) > 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
  const x = side.addScaledVector(axis, -side.dot(axis)).normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, axis, x.clone().cross(axis)));
}

/** The points between which a scene is drawn. */
export function pointsOf(scene) {
  const points = scene.bodies.flatMap((body) => [body.frame.position, ...body.lines.flat()]);
  if (scene.belt) points.push(...scene.belt.path, ...scene.belt.frame.flatMap(({ line }) => line));
  const isGrown = (joint) => scene.bodies[joint.body].kind === "rod";
  for (const joint of scene.joints.filter((one) => !isGrown(one))) points.push(joint.at, joint.at.map((value, i) => value - joint.travel * joint.axis[i]));
  return points;
}

/** Place an object that holds a scene, in the frame of its work, so that the bed stands still: tables turn and tilt. */
export function stand(object, scene) {
  const { bed } = shapesOf(scene);
  const matrix = bed === null ? new Matrix4() : matrixOf(bed).invert();
  matrix.decompose(object.position, object.quaternion, object.scale);
  object.updateMatrixWorld(true);
}

/** The middle of all that is drawn inside an object, and of boxes, and the diameter of a ball around it. */
export function extentOf(scene, object, boxes = []) {
  const points = pointsOf(scene).map((point) => (object ? new Vector3(...point).applyMatrix4(object.matrixWorld).toArray() : point));
  points.push(...boxes.flatMap(({ min, max }) => [min.toArray(), max.toArray()]));
  const low = [0, 1, 2].map((k) => Math.min(...points.map((point) => point[k])));
  const high = [0, 1, 2].map((k) => Math.max(...points.map((point) => point[k])));
  const centre = low.map((value, k) => (value + high[k]) / 2);
  return { centre, size: Math.max(Math.hypot(...high.map((value, k) => value - low[k])), 1e-3), low, high };
}
