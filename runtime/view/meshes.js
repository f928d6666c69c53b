/** Meshes inside the page (glTF): of the user's own, each in the frame of its body, or those of an imported robot. */

import { DoubleSide, Group, Matrix4, Mesh, MeshLambertMaterial, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { matrixOf } from "./space.js";

/** Edges that turn by less, in radians, are drawn smooth. */
const CREASE = 0.6;

/**
 * models: {body, scale, data} with the file in base64; without a body its nodes name theirs, all in the frame of the
 * base, where the bodies of `zero`, a scene, stand as they do. Found: {body, number, mesh}, of bodies of one name, and
 * {node, moves} of a link that moves against its body.
 */
export async function meshesOf(models, zero) {
  const found = [];
  for (const { body, scale, data } of models) {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
    const nodes = body ? [scene] : [...scene.children];
    for (const node of nodes) {
      const { name, number, moves } = body ? { name: body, number: 0, moves: [] } : node.userData;
      const mesh = new Group().add(node);
      const at = zero.bodies.filter((one) => one.name === name)[number];
      if (!at) continue;
      if (body) mesh.scale.setScalar(scale);
      else standIn(at, node, mesh);
      found.push({ body: name, number, mesh, node, moves });
    }
  }
  return found;
}

/** The motion of a link by movements about or along lines, at joint values in radians and lengths. */
export function motionOf(moves, values) {
  return moves.reduce((matrix, { is_slide: isSlide, at, along, drives }) => {
    const value = drives.reduce((sum, [k, factor]) => sum + factor * values[k], 0);
    if (isSlide) return matrix.multiply(new Matrix4().makeTranslation(...along.map((part) => value * part)));
    const turn = new Matrix4().makeRotationAxis(new Vector3(...along), value);
    return matrix.multiply(turn.setPosition(new Vector3(...at).sub(new Vector3(...at).applyMatrix4(turn))));
  }, new Matrix4());
}

/** A node of an imported robot: in the frame of its body, with smooth surfaces, in its colours or in the body's. */
function standIn(body, node, mesh) {
  matrixOf(body.frame).invert().decompose(mesh.position, mesh.quaternion, mesh.scale);
  node.traverse((one) => {
    if (!(one instanceof Mesh)) return;
    const geometry = toCreasedNormals(one.geometry, CREASE);
    one.geometry.dispose();
    const isPainted = one.material.name !== ""; // that of a glTF without materials has no name
    Object.assign(one, { geometry, userData: { kind: body.kind, own: isPainted ? new MeshLambertMaterial({ color: one.material.color, side: DoubleSide }) : null } });
  });
}
