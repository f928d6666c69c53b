/** The picture: camera, light, floor, the machine, its ghosts, the tool's frame that is dragged, a path, a slice. */

import {
  Box3, BufferAttribute, BufferGeometry, CanvasTexture, DoubleSide, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, Object3D,
  PerspectiveCamera, PlaneGeometry, Raycaster, Scene, Vector2, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import { lights, lookAt, rangeOf } from "./camera.js";
import { COLOURS, Figure } from "./figure.js";
import { Ground, lettersOf, triad } from "./ground.js";
import { Labels } from "./labels.js";
import { motionOf } from "./meshes.js";
import { rowsOf } from "./pose.js";
import { extentOf, pointsOf, quaternionFrom, stand } from "./space.js";

/** The size of the frame of the base, of the machine's. */
const BASE = 0.1;
/** A label is shown at the border for what is so many pixels above it. */
const ABOVE = 40;
/** A point is outside so far beyond the border of the picture, of half its width. */
const OUTSIDE = 1.02;

export class Stage {
  #ghosts = [];
  #others = [];
  others = [];
  #isAsked = false;
  #meshes = [];
  #fitted = null;

  /** heard: {onDrag(frame, isFinished), onGhost(index), onAssembly(), onView(), onDrawn(isInside)}. */
  constructor(canvas, labels, heard) {
    this.canvas = canvas;
    this.labels = labels;
    this.names = new Labels(labels);
    this.heard = heard;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.debug.checkShaderErrors = false;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(38, 1, 1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.scene.add(...lights());
    this.world = new Group(); // what is given in the frame of the work
    this.figure = new Figure();
    this.world.add(this.figure.group);
    this.ground = new Ground();
    this.floor = this.ground.group;
    this.extra = new Group();
    this.scene.add(this.floor, this.world);
    this.triad = triad();
    this.origin = triad();
    this.assembly = new Group(); // ghosts of other poses at the same axes
    this.world.add(this.assembly, this.extra, this.triad, this.origin);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.listenToKeyEvents(canvas);
    this.orbit.addEventListener("change", () => {
      this.ask();
      this.heard.onView();
    });
    this.#handles();
    canvas.addEventListener("click", (event) => this.#clicked(event));
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
  }

  /** The colours of a theme, "light" or "dark". */
  paint(theme) {
    this.theme = theme;
    [this.figure, ...this.#ghosts, ...this.#others].forEach((figure) => figure.paint(COLOURS[theme]));
    if (this.extent) this.#layFloor();
    this.ask();
  }

  /** Take the size of a machine from its scene. */
  measure(scene) {
    stand(this.world, scene);
    this.#showMeshes(scene, () => false);
    this.world.updateMatrixWorld(true);
    this.extent = extentOf(scene, this.world, this.#meshes.map(({ holder }) => new Box3().setFromObject(holder)));
    this.size = this.extent.size;
    rangeOf(this.camera, this.size);
    this.#layFloor();
    this.ask();
  }

  /** From where one looks, and at what: six lengths; null where `fit` has decided that. */
  get view() {
    const view = [...this.camera.position.toArray(), ...this.orbit.target.toArray()];
    return view.every((value, i) => Math.abs(value - (this.#fitted?.[i] ?? value)) < 1e-6 * this.size) ? null : view;
  }

  set view(view) {
    this.camera.position.set(...view.slice(0, 3));
    this.orbit.target.set(...view.slice(3));
    this.orbit.update();
    this.ask();
  }

  /** Look from a part of the distance. */
  closer(part) {
    this.camera.position.sub(this.orbit.target).multiplyScalar(part).add(this.orbit.target);
    this.orbit.update();
  }

  /** Look at all of a machine. */
  fit(scene) {
    this.measure(scene);
    const { centre } = this.extent;
    this.orbit.target.set(...centre);
    lookAt(this.camera, this.extent);
    this.orbit.update();
    this.#fitted = [...this.camera.position.toArray(), ...centre];
    this.ask();
  }

  /**
   * Show a scene, and the frame that is wanted where it is not that of the tool. refused: whether a body refuses;
   * values: those of the joints, in radians and lengths.
   */
  show(scene, target, refused, values) {
    this.figure.show(scene, this.size, { refused, hidden: this.#showMeshes(scene, refused, values) });
    this.shown = scene;
    if (!this.isDragged) stand(this.world, scene);
    const tool = scene.bodies[scene.bodies.length - 1].frame;
    this.#place(this.triad, tool, 0.14);
    if (!this.isDragged) this.#place(this.handle, target ?? tool, null);
    this.ask();
  }

  /** Ghosts of scenes, each with the number by which it is taken. */
  showGhosts(scenes) {
    this.#fill(this.#ghosts, scenes, "ghost", this.world);
  }

  /** Other poses at the same axes, seen through: {scene, text}. The ground lies below them. */
  showOthers(others) {
    const isAnother = others.length !== this.others.length;
    this.others = others;
    if (isAnother) this.#layFloor();
    this.#fill(this.#others, others.map(({ scene }) => scene), "assembly", this.assembly);
  }

  #fill(figures, scenes, ghost, parent) {
    while (figures.length < scenes.length) {
      figures.push(new Figure({ isGhost: true, ghost, colours: COLOURS[this.theme] }));
      parent.add(figures.at(-1).group);
    }
    figures.forEach((figure, i) => {
      figure.group.visible = i < scenes.length;
      if (figure.group.visible) figure.show(scenes[i], this.size);
    });
    this.ask();
  }

  /** Which handles the tool has: "translate", "rotate" or "" without any; the directions that it may take. */
  handleAs(mode, [x, y, z]) {
    this.transform.enabled = Boolean(mode);
    this.transformed.visible = Boolean(mode);
    if (mode) this.transform.setMode(mode);
    Object.assign(this.transform, { showX: x, showY: y, showZ: z });
    this.transform.setSpace(mode === "rotate" ? "local" : "world");
    this.ask();
  }

  /** A path in space: points with a colour each, 0xrrggbb; without points it is gone. */
  showPath(points, colours) {
    this.path?.geometry.dispose();
    this.path?.removeFromParent();
    this.path = null;
    if (points.length > 1) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(points.flat()), 3));
      const parts = colours.flatMap((colour) => [(colour >> 16) / 255, ((colour >> 8) & 255) / 255, (colour & 255) / 255]);
      geometry.setAttribute("color", new BufferAttribute(new Float32Array(parts), 3));
      this.path = new Line(geometry, new LineBasicMaterial({ vertexColors: true }));
      this.extra.add(this.path);
    }
    this.ask();
  }

  /** A slice: a picture on a square of the width, its corners given by a frame-like basis. null takes it away. */
  showSlice(picture, corners) {
    if (this.slice) {
      this.slice.material.map.dispose();
      this.slice.material.dispose();
      this.slice.geometry.dispose();
      this.slice.removeFromParent();
      this.slice = null;
    }
    if (picture) {
      const map = new CanvasTexture(picture);
      const geometry = new PlaneGeometry(1, 1);
      const [origin, along, up] = corners;
      const at = (a, b) => origin.map((value, i) => value + a * along[i] + b * up[i]);
      [at(0, 1), at(1, 1), at(0, 0), at(1, 0)].forEach((point, i) => geometry.getAttribute("position").setXYZ(i, ...point));
      const material = new MeshBasicMaterial({ map, transparent: true, side: DoubleSide, depthWrite: false });
      this.slice = new Mesh(geometry, material);
      this.slice.frustumCulled = false;
      this.extra.add(this.slice);
    }
    this.ask();
  }

  /** Meshes as `meshesOf` finds them, each in the place of a body; those before them are gone. */
  replaceBodies(found) {
    this.#meshes.forEach(({ holder }) => holder.removeFromParent());
    this.#meshes = found.map((one) => ({ ...one, holder: new Object3D().add(one.mesh) }));
    for (const { holder, body, moves } of this.#meshes) holder.userData.body = [body, ...moves.map(({ drives }) => drives.map(([k]) => k + 1))].join("+");
    this.#meshes.forEach(({ holder }) => this.world.add(holder));
  }

  /** Meshes where their bodies are, in the colour of a body that refuses. Returns the bodies that they are. */
  #showMeshes(scene, refused, values) {
    return new Set(this.#meshes.map(({ body: name, number, holder, node, moves }) => {
      const body = scene.bodies.filter((one) => one.name === name)[number];
      holder.visible = Boolean(body);
      if (!body) return null;
      this.#place(holder, body.frame, null);
      if (moves.length && values) motionOf(moves, values).decompose(node.position, node.quaternion, node.scale);
      const { materials } = this.figure;
      holder.traverse((one) => {
        const { kind, own } = one.userData;
        if (kind) one.material = refused(body) ? materials.refused : own ?? materials[kind];
      });
      return moves.length ? null : body;
    }));
  }

  /** Draw soon, once. */
  ask() {
    if (this.#isAsked) return;
    this.#isAsked = true;
    requestAnimationFrame(() => {
      this.#isAsked = false;
      this.draw();
    });
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    this.#label();
    if (this.shown) this.heard.onDrawn(pointsOf(this.shown).every((point) => this.#isInside(point)));
    if (this.figure.group.children.length && !this.isDrawn) performance.mark("first picture");
    this.isDrawn ||= this.figure.group.children.length > 0;
  }

  /** Where the tool's handle is on the screen, in pixels of the page. */
  placeOf(position) {
    const point = this.#projected(position);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + ((point.x + 1) / 2) * box.width, box.top + ((1 - point.y) / 2) * box.height];
  }

  #handles() {
    this.handle = new Object3D();
    this.world.add(this.handle);
    this.transform = new TransformControls(this.camera, this.canvas);
    this.transform.setSize(0.75);
    this.transform.attach(this.handle);
    this.transformed = this.transform.getHelper();
    this.scene.add(this.transformed);
    this.transform.addEventListener("change", () => this.ask());
    this.transform.addEventListener("dragging-changed", ({ value }) => {
      this.isDragged = value;
      this.orbit.enabled = !value;
      this.wasDragged = true;
      this.heard.onDrag(this.#handleFrame(), !value);
    });
    this.transform.addEventListener("objectChange", () => this.heard.onDrag(this.#handleFrame(), false));
  }

  #handleFrame() {
    const { position, quaternion } = this.handle;
    return { position: position.toArray(), rotation: rowsOf(quaternion.normalize().toArray()) };
  }

  #place(object, frame, size) {
    object.position.set(...frame.position);
    object.quaternion.copy(quaternionFrom(frame));
    if (size !== null) object.scale.setScalar(size * this.size);
  }

  #layFloor() {
    const { low, size, centre } = this.extent;
    const depths = this.others.map(({ scene }) => extentOf(scene, this.world).low[2]);
    this.ground.lay({ low: [low[0], low[1], Math.min(low[2], ...depths)], size, centre }, this.theme);
    this.origin.scale.setScalar(BASE * this.size);
  }

  #clicked(event) {
    if (this.wasDragged || this.isDragged) {
      this.wasDragged = false;
      return;
    }
    const box = this.canvas.getBoundingClientRect();
    const point = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(point, this.camera);
    const shown = this.#ghosts.filter((ghost) => ghost.group.visible).map((ghost) => ghost.group);
    const hit = ray.intersectObjects(shown, true).find(({ object }) => object.visible);
    const others = this.#others.filter((other) => other.group.visible).map((other) => other.group);
    if (!hit && ray.intersectObjects(others, true).some(({ object }) => object.visible)) this.heard.onAssembly();
    if (!hit) return;
    this.heard.onGhost(shown.findIndex((group) => group.children.includes(hit.object)));
  }

  /** The names of the joints beside them, the letters of the base, and what a ghost of an assembly mode is. */
  #label() {
    if (this.labels.hidden || !this.shown) return;
    const { width, height } = this.canvas.getBoundingClientRect();
    const placed = (point) => {
      const { x, y } = this.#projected(point);
      return [((x + 1) / 2) * width, ((1 - y) / 2) * height];
    };
    const letters = lettersOf(BASE * this.size).map(({ text, at }) => ({ text, at: placed(at).map((value) => value - 7), isFixed: true }));
    const other = this.others.map(({ text, scene }) => ({ text, at: placed(scene.bodies.at(-1).frame.position) }));
    const { joints: moved, belt } = this.shown;
    const named = moved.filter((joint) => !belt || joint.joints.length === 1).map(({ joints, at }) => ({ name: joints.join(" "), at }));
    named.push(...(belt?.wheels ?? []).filter(({ joint }) => joint).map(({ joint, at }) => ({ name: joint, at })));
    const joints = named.map(({ name, at }) => ({ text: name, at: placed(at) }));
    const seen = [...letters, ...joints, ...other].filter(({ at: [x, y] }) => x > 0 && x < width && y > -ABOVE && y < height);
    this.names.show(seen, placed(this.handle.position.toArray()));
  }

  #projected(point) {
    return this.handle.position.clone().set(...point).applyMatrix4(this.world.matrixWorld).project(this.camera);
  }

  #isInside(point) {
    const { x, y, z } = this.#projected(point);
    return Math.abs(x) < OUTSIDE && Math.abs(y) < OUTSIDE && z < 1;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.ask();
  }
}
