/** What the machine stands on: a ground with a grid of round lengths, and the frame of its base. */

import { CylinderGeometry, GridHelper, Group, Mesh, MeshBasicMaterial, PlaneGeometry } from "three";

const FLOOR = { light: [0xb9c2cc, 0xdde3ea, 0xe9edf1], dark: [0x3c4652, 0x2a323b, 0x1b2128] };
/** The colours of X, Y and Z, as those of the handles. */
const AXES = { X: 0xd83a34, Y: 0x2f9e44, Z: 0x2f6fd6 };
const SHAFT = new CylinderGeometry(0.016, 0.016, 1, 8).translate(0, 0.5, 0);

/** The three axes of a frame, of length one. */
export function triad() {
  const [x, y, z] = Object.values(AXES).map((color) => new Mesh(SHAFT, new MeshBasicMaterial({ color })));
  x.rotation.z = -Math.PI / 2;
  z.rotation.x = Math.PI / 2;
  return new Group().add(x, y, z);
}

/** The ends of the axes of the base with their letters. size: that of the triad. */
export function lettersOf(size) {
  return Object.keys(AXES).map((text, k) => ({ text, at: [0, 1, 2].map((i) => (i === k ? 1.15 * size : 0)) }));
}

export class Ground {
  /** The length of a side of a cell. */
  step = 0;

  constructor() {
    this.group = new Group();
  }

  /** Lay it below an extent, in the colours of a theme. */
  lay({ low, centre, size }, theme) {
    this.group.children.forEach((child) => {
      child.geometry.dispose();
      child.material.dispose();
    });
    this.group.clear();
    this.step = 10 ** Math.round(Math.log10(size / 10));
    const count = Math.ceil((1.6 * size) / this.step) * 2;
    const [middle, line, plain] = FLOOR[theme];
    const grid = new GridHelper(count * this.step, count, middle, line);
    grid.rotation.x = Math.PI / 2;
    const material = new MeshBasicMaterial({ color: plain, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
    this.group.add(new Mesh(new PlaneGeometry(count * this.step, count * this.step), material), grid);
    const [x, y] = [0, 1].map((i) => Math.round(centre[i] / this.step) * this.step);
    this.group.position.set(x, y, groundOf({ low, size }));
  }
}

/** The height of the ground: below all of a machine, and of its foot. */
export function groundOf({ low, size }) {
  return Math.min(low[2], 0) - 0.07 * size;
}
