/** Meshes inside the page (glTF): of the user's own, each in the frame of its body, or those of an imported robot. */

import { DoubleSide, Group, Mesh, MeshLambertMaterial } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { matrixOf } from "./space.js";

/** Edges that turn by less, in radians, are drawn smooth. */
const CREASE = 0.6;

/**
 * models: {body, scale, data} with the file in base64; without a body its nodes name theirs, all in the frame of the
 * base, where the bodies of `zero`, a scene, stand as they do. Found: {body, number, mesh}, of bodies of one name.
 */
export async function meshesOf(models, zero) {
  const found = [];
  for (const { body, scale, data } of models) {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
    const nodes = body ? [scene] : [...scene.children];
    for (const node of nodes) {
      const { body: name, number } = body ? { body, number: 0 } : node.userData;
      const mesh = new Group().add(node);
      const at = zero.bodies.filter((one) => one.name === name)[number];
      if (!at) continue;
      if (body) mesh.scale.setScalar(scale);
      else standIn(at, node, mesh);
      found.push({ body: name, number, mesh });
    }
  }
  return found;
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
