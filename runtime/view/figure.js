/** A machine as solid bodies: rods along its lines, a barrel for every turn, a carriage for every slide, plates, the tool. */

import {
  BoxGeometry, BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Group, Matrix4, Mesh,
  MeshLambertMaterial, SphereGeometry, Vector3,
} from "three";
import { groundOf } from "./ground.js";
import { motorPlace, shapesOf } from "./shapes.js";
import { extentOf, levelAlong } from "./space.js";

const ROUND = new CylinderGeometry(1, 1, 1, 24);
const BALL = new SphereGeometry(1, 20, 14);
const BLOCK = new BoxGeometry(1, 1, 1);
const POINT = new ConeGeometry(1, 1, 24);
const UP = new Vector3(0, 1, 0);

/** Radii and sizes over the size of the machine. */
const THICK = { base: 0.02, link: 0.022, rod: 0.009, cable: 0.003, plate: 0.011, tool: 0.01 };
const BARREL = { radius: 0.034, length: 0.1 };
const TABLE = { radius: 0.1, length: 0.03 };
const TRUNNION = { radius: 0.03, length: 0.24 };
const SPINDLE = { radius: 0.034, part: 0.6 };
/** A beam across and in height, what it is longer than the way of its carriage at both ends, and the carriage. */
const BEAM = { width: 0.05, height: 0.022, beyond: 0.06 };
const CARRIAGE = [0.07, 0.09, 0.05];
const QUILL = 0.022;
const LEG = 0.016;
const CYLINDER = 0.017;
/** A motor, how far it stands from a joint beside which it is, and that of a belt. */
const MOTOR = { radius: 0.026, length: 0.055, aside: 0.07, cap: 0.7 };
/** A belt's width, its height above the frame, and the carriage that holds its ends. */
const BELT = { width: 0.012, thick: 0.003, above: 0.03 };
const LARGEST_PLATE = 24;
/** A ghost is thinner, so that it does not shine through the machine where both are at one place. */
const GHOST = 0.86;

export const COLOURS = {
  light: { base: 0x8b95a3, link: 0xe08a2e, rod: 0x5b6b80, plate: 0x3f7fbf, joint: 0x39424f, motor: 0x2f4a75, belt: 0x15181c, tool: 0x1f9d61, ghost: 0x4d7cc9, assembly: 0x9556c4 },
  dark: { base: 0x6d7886, link: 0xe59a45, rod: 0x9fb0c6, plate: 0x5b9be0, joint: 0xb6c0cc, motor: 0x7f9bd0, belt: 0xdde3ea, tool: 0x35c47f, ghost: 0x86aef0, assembly: 0xc79bef },
};
export const STATES = { good: null, near: 0xe0a100, singular: 0xd83a34, refused: 0xd83a34 };

const KINDS = ["base", "link", "rod", "plate", "joint", "motor", "belt", "tool"];

/** One figure. `solid`: the machine itself; else a ghost, which is seen through. */
export class Figure {
  #pools = new Map();
  #used = new Map();
  #plates = [];

  /** ghost: the name of its colour. */
  constructor({ isGhost = false, ghost = "ghost", colours = COLOURS.light } = {}) {
    this.group = new Group();
    Object.assign(this, { isGhost, ghost });
    this.materials = {};
    for (const kind of [...KINDS, "refused"]) {
      this.materials[kind] = new MeshLambertMaterial({
        transparent: isGhost, opacity: isGhost ? 0.2 : 1, depthWrite: !isGhost, side: DoubleSide, forceSinglePass: true,
        polygonOffset: isGhost, polygonOffsetFactor: 2, polygonOffsetUnits: 8,
      });
    }
    this.materials.refused.color.set(STATES.refused);
    this.paint(colours);
  }

  /** The colours of a theme. */
  paint(colours) {
    for (const kind of KINDS) {
      this.materials[kind].color.set(colours[this.isGhost ? this.ghost : kind]);
    }
    this.colours = colours;
  }

  /** The tool in the colour of a state: good, near to a singular pose, singular, refused; joints, where one is near. */
  mark(state) {
    this.materials.tool.color.set(STATES[state] ?? this.colours.tool);
    this.materials.joint.color.set((state !== "refused" && STATES[state]) || this.colours.joint);
  }

  /** Stand as a scene says. hidden: bodies that a mesh of their own shows; refused: whether a body refuses. */
  show(scene, size, { hidden = new Set(), refused = () => false } = {}) {
    this.#used.clear();
    const { shapes, isTool } = shapesOf(scene);
    this.shapes = shapes;
    let plates = 0;
    scene.bodies.forEach((body, i) => {
      if (hidden.has(body) || (this.isGhost && body.kind === "base")) return;
      const material = refused(body) ? "refused" : body.kind;
      const thick = size * THICK[body.isCable ? "cable" : body.kind] * (this.isGhost ? GHOST : 1);
      const isSpindle = isTool && i === scene.bodies.length - 2;
      const isBed = ["table", "trunnion"].includes(shapes[scene.joints.findIndex((joint) => joint.body === i)]);
      body.lines.forEach(([start, end], k) => {
        const shape = isBed ? this.#bed : isSpindle && k === body.lines.length - 1 ? this.#spindle : this.#rod;
        shape.call(this, start, end, thick, material, size);
      });
      if (body.kind === "plate" || body.kind === "base") plates += this.#face(plates, body, material);
      if (body.kind === "base" && !body.lines.length) this.#foot(body.frame.position, size, shapes[0]);
      if (body.kind === "tool") this.#tool(body.frame, size, material);
      for (const joint of scene.joints.filter((one) => one.body === i)) {
        if (body.isCable) continue;
        if (body.kind === "rod") this.#cylinder(body, joint, size, refused(body));
        else this.#joint(joint, shapes[scene.joints.indexOf(joint)], size, refused(body), scene);
      }
      if (this.isGhost) return;
      for (const motor of scene.motors.filter((one) => one.body === i)) {
        this.#motor(motor, shapes[scene.joints.findIndex((joint) => joint.body === i)], size, scene);
      }
    });
    if (scene.belt) this.#belt(scene.belt, size, scene);
    this.#plates.forEach((plate, i) => { plate.visible = i < plates; });
    for (const [geometry, meshes] of this.#pools) {
      const count = this.#used.get(geometry) ?? 0;
      meshes.forEach((mesh, i) => { mesh.visible = i < count; });
    }
  }

  dispose() {
    Object.values(this.materials).forEach((material) => material.dispose());
    this.#plates.forEach((plate) => plate.geometry.dispose());
  }

  #mesh(geometry, kind) {
    const meshes = this.#pools.get(geometry) ?? [];
    const count = this.#used.get(geometry) ?? 0;
    this.#pools.set(geometry, meshes);
    this.#used.set(geometry, count + 1);
    if (!meshes[count]) {
      meshes[count] = new Mesh(geometry);
      this.group.add(meshes[count]);
    }
    meshes[count].material = this.materials[kind];
    return meshes[count];
  }

  #rod(start, end, radius, kind) {
    const [a, b] = [new Vector3(...start), new Vector3(...end)];
    this.#along(ROUND, a, b, radius, kind);
    for (const place of [a, b]) {
      const ball = this.#mesh(BALL, kind);
      ball.position.copy(place);
      ball.scale.setScalar(radius * (kind === "rod" ? 1.5 : 1));
    }
  }

  /** A line of what carries the work: a beam of the machine's bed. */
  #bed(start, end, thick, kind) {
    this.#beam(new Vector3(...start), new Vector3(...end), 2.4 * thick, 2.4 * thick, kind === "link" ? "base" : kind);
  }

  #beam(a, b, height, width, kind) {
    const axis = b.clone().sub(a).normalize();
    const beam = this.#mesh(BLOCK, kind);
    beam.position.copy(a).lerp(b, 0.5);
    beam.quaternion.copy(levelAlong(axis));
    beam.scale.set(height, a.distanceTo(b) + height, width);
  }

  #along(geometry, a, b, radius, kind) {
    const way = b.clone().sub(a);
    const length = way.length();
    const mesh = this.#mesh(geometry, kind);
    mesh.position.copy(a).addScaledVector(way, 0.5);
    mesh.quaternion.setFromUnitVectors(UP, length > 0 ? way.normalize() : UP);
    mesh.scale.set(radius, Math.max(length, 1e-6), radius);
    return mesh;
  }

  /** The line of a spindle: its thick body, then the tool. */
  #spindle(start, end, thick, kind, size) {
    const [a, b] = [new Vector3(...start), new Vector3(...end)];
    const middle = a.clone().lerp(b, SPINDLE.part);
    this.#along(ROUND, a, middle, size * SPINDLE.radius, kind);
    this.#along(ROUND, middle, b, 0.5 * thick, "joint");
  }

  #joint(joint, shape, size, isRefused, scene) {
    const kind = isRefused ? "refused" : "joint";
    const thin = (this.isGhost ? GHOST : 1) * size;
    const [at, axis] = [new Vector3(...joint.at), new Vector3(...joint.axis)];
    if (joint.kind === "turn") {
      const { radius, length } = { barrel: BARREL, table: TABLE, trunnion: TRUNNION }[shape];
      const half = axis.clone().multiplyScalar((thin * length) / 2);
      this.#along(ROUND, at.clone().sub(half), at.clone().add(half), thin * radius, kind);
      return;
    }
    if (scene.belt && joint.joints.length > 1) return;
    const from = at.clone().addScaledVector(axis, -joint.travel);
    if (shape === "quill") this.#along(ROUND, from, at, thin * QUILL, kind);
    else this.#rail(from, at, axis, thin, joint.body === 1 && !scene.bodies[0].lines.length, scene);
    const block = this.#mesh(BLOCK, kind);
    block.position.copy(at);
    block.quaternion.copy(levelAlong(axis));
    block.scale.set(...CARRIAGE.map((part) => thin * part));
  }

  /** A motor at an end of the axis that it turns, or beside it. */
  #motor(motor, shape, size, scene) {
    const { axis, isAside } = motorPlace(scene, motor);
    const [at, out] = [new Vector3(...motor.at), new Vector3(...axis)];
    const length = ({ table: TABLE, trunnion: TRUNNION }[shape] ?? BARREL).length;
    const along = isAside ? new Vector3(...motor.axis) : out;
    const start = isAside ? at.addScaledVector(out, size * MOTOR.aside).addScaledVector(along, -0.5 * size * MOTOR.length) : at.addScaledVector(out, 0.5 * size * length);
    this.#drive(start, along, size);
  }

  /** The body of a motor, and the cap at its end. */
  #drive(start, along, size) {
    const end = start.clone().addScaledVector(along, size * MOTOR.length);
    this.#along(ROUND, start, end, size * MOTOR.radius, "motor");
    this.#along(ROUND, end, end.clone().addScaledVector(along, 0.2 * size * MOTOR.length), size * MOTOR.radius * MOTOR.cap, "joint");
  }

  /** A belt on its wheels above its frame, the frame on legs, the motors below, and the carriage. */
  #belt({ path, wheels, frame, carriage, radius, normal }, size, scene) {
    const thin = this.isGhost ? GHOST : 1;
    const up = new Vector3(...normal);
    const raised = (point) => new Vector3(...point).addScaledVector(up, size * BELT.above);
    for (const { line: [start, end], kind } of frame) {
      const [a, b] = [new Vector3(...start), new Vector3(...end)];
      this.#beam(a, b, thin * size * BEAM.height, thin * size * BEAM.width, kind);
      if (kind === "base" && !this.isGhost && Math.abs(up.z) > 0.5) this.#legs([a, b], size, scene);
    }
    path.slice(1).forEach((end, i) => {
      const [a, b] = [raised(path[i]), raised(end)];
      if (a.distanceTo(b) > 0) this.#strand(a, b, up, thin * size);
    });
    for (const { at, joint } of wheels) {
      const [top, low] = [1, -1].map((side) => raised(at).addScaledVector(up, 0.6 * side * size * BELT.width));
      this.#along(ROUND, low, top, radius, "joint");
      if (joint) this.#drive(new Vector3(...at).addScaledVector(up, 0.5 * size * BEAM.height), up.clone().negate(), size);
    }
    const block = this.#mesh(BLOCK, "joint");
    block.position.set(...carriage);
    block.quaternion.copy(levelAlong(new Vector3(...path[1]).sub(new Vector3(...path[0])).normalize()));
    block.scale.set(...CARRIAGE.map((part) => thin * size * part));
  }

  /** A straight piece of a belt: its width stands along the normal. */
  #strand(a, b, up, size) {
    const way = b.clone().sub(a);
    const strand = this.#mesh(BLOCK, "belt");
    strand.position.copy(a).lerp(b, 0.5);
    const along = way.clone().normalize();
    strand.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(along.clone().cross(up), along, up));
    strand.scale.set(size * BELT.thick, way.length() + size * BELT.thick, size * BELT.width);
  }

  #legs(tops, size, scene) {
    const floor = groundOf(extentOf(scene));
    for (const top of tops) this.#along(ROUND, new Vector3(top.x, top.y, floor), top, size * LEG, "base");
  }

  /** A beam that is longer than the way of its carriage; the first of a machine stands on legs if it lies. */
  #rail(from, at, axis, thin, isFirst, scene) {
    const sense = Math.sign(at.clone().sub(from).dot(axis)) || 1;
    const [a, b] = [from.clone().addScaledVector(axis, -sense * BEAM.beyond * thin), at.clone().addScaledVector(axis, sense * BEAM.beyond * thin)];
    this.#beam(a, b, thin * BEAM.height, thin * BEAM.width, "base");
    if (isFirst && !this.isGhost && Math.abs(axis.z) <= 0.5) this.#legs([a, b], thin, scene);
  }

  /** A rod that grows: the cylinder of its drive around its first half. */
  #cylinder({ lines: [[start]] }, { at }, size, isRefused) {
    const thin = this.isGhost ? GHOST : 1;
    this.#along(ROUND, new Vector3(...start), new Vector3(...at), thin * size * CYLINDER, isRefused ? "refused" : "joint");
  }

  /** A foot, or the table that carries the work; none below a beam, which has legs. */
  #foot(position, size, shape) {
    if (shape === "beam") return;
    const [radius, height] = shape === "table" ? [0.13, 0.02] : [0.07, 0.06];
    const foot = this.#mesh(ROUND, "base");
    foot.position.set(...position);
    foot.position.z -= size * (shape === "table" ? 0.5 * height : 0.04);
    foot.quaternion.setFromUnitVectors(UP, new Vector3(0, 0, 1));
    foot.scale.set(size * radius, size * height, size * radius);
  }

  #tool({ position, rotation }, size, kind) {
    const z = new Vector3(rotation[0][2], rotation[1][2], rotation[2][2]);
    const at = new Vector3(...position);
    const cone = this.#along(POINT, at.clone().addScaledVector(z, -size * 0.07), at, size * 0.024, kind);
    cone.scale.x = cone.scale.z = size * 0.024;
  }

  /** The face that the ring of a plate or base encloses; 1 if there is one. */
  #face(place, body, kind) {
    const ring = ringOf(body.lines);
    if (ring.length < 3 || ring.length > LARGEST_PLATE) return 0;
    if (!this.#plates[place]) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(9 * LARGEST_PLATE), 3));
      this.#plates[place] = new Mesh(geometry);
      this.#plates[place].frustumCulled = false;
      this.group.add(this.#plates[place]);
    }
    const mesh = this.#plates[place];
    mesh.material = this.materials[kind];
    const centre = ring.reduce((sum, point) => sum.map((value, i) => value + point[i] / ring.length), [0, 0, 0]);
    const points = mesh.geometry.getAttribute("position");
    ring.forEach((point, i) => {
      [centre, point, ring[(i + 1) % ring.length]].forEach((corner, k) => points.setXYZ(3 * i + k, ...corner));
    });
    points.needsUpdate = true;
    mesh.geometry.setDrawRange(0, 3 * ring.length);
    mesh.geometry.computeVertexNormals();
    return 1;
  }
}

/** The points of a closed ring at the begin of lines. */
function ringOf(lines) {
  const points = [];
  for (const [start, end] of lines) {
    points.push(start);
    if (points.length > 2 && isSame(end, points[0])) return points;
    if (points.length > 1 && !isSame(points[points.length - 1], start)) return [];
  }
  return [];
}

function isSame(one, other) {
  return one.every((value, i) => value === other[i]);
}
