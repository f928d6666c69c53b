/** Meshes of the user's own (glTF, inside the page), each in the frame of its body. */

import { Group } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

/** models: {body, scale, data} with the file in base64. */
export function meshesOf(models) {
  return Promise.all(models.map(async ({ body, scale, data }) => {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
    const mesh = new Group();
    mesh.add(scene);
    mesh.scale.setScalar(scale);
    return { body, mesh };
  }));
}
