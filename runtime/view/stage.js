/** The picture: camera, light, floor, the machine, its ghosts, the tool's frame that is dragged, a path, a slice. */

import {
  AmbientLight, AxesHelper, BufferAttribute, BufferGeometry, CanvasTexture, DirectionalLight, DoubleSide, GridHelper, Group,
  HemisphereLight, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, NearestFilter, Object3D, PerspectiveCamera, PlaneGeometry,
  Raycaster, Scene, Vector2, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import { COLOURS, Figure, extentOf, quaternionFrom } from "./figure.js";
import { rowsOf } from "./pose.js";

const FLOOR = { light: [0xb9c2cc, 0xdde3ea], dark: [0x3c4652, 0x2a323b] };

/** The direction from which one looks at first, of length one, and the room around the ball of the machine. */
const FROM = [0.605, -0.658, 0.447];
const ROOM = 1.12;
/** Width and height of a label in pixels: two do not stand closer. */
const LABEL = [36, 15];

export class Stage {
  #ghosts = [];
  #isAsked = false;
  #meshes = new Map();
  #fitted = null;

  /** heard: {onDrag(frame, isFinished), onGhost(index), onView()}. */
  constructor(canvas, labels, heard) {
    this.canvas = canvas;
    this.labels = labels;
    this.heard = heard;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.debug.checkShaderErrors = false;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(38, 1, 1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.#light();
    this.figure = new Figure();
    this.scene.add(this.figure.group);
    this.floor = new Group();
    this.extra = new Group();
    this.scene.add(this.floor, this.extra);
    this.triad = new AxesHelper(1);
    this.origin = new AxesHelper(1);
    this.scene.add(this.triad, this.origin);
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
    [this.figure, ...this.#ghosts].forEach((figure) => figure.paint(COLOURS[theme]));
    if (this.extent) this.#layFloor();
    this.ask();
  }

  /** Take the size of a machine from its scene. */
  measure(scene) {
    this.extent = extentOf(scene);
    this.size = this.extent.size;
    this.camera.near = this.size / 100;
    this.camera.far = this.size * 60;
    this.camera.updateProjectionMatrix();
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
    const { centre, size } = this.extent;
    this.orbit.target.set(...centre);
    const narrow = Math.min(1, this.camera.aspect) * Math.tan((this.camera.fov / 2) * (Math.PI / 180));
    const away = (ROOM * size) / 2 / Math.sin(Math.atan(narrow));
    this.camera.position.set(...FROM.map((value, i) => centre[i] + away * value));
    this.orbit.update();
    this.#fitted = [...this.camera.position.toArray(), ...centre];
    this.ask();
  }

  /** Show a scene, and the frame that is wanted where it is not that of the tool. */
  show(scene, target, options) {
    this.figure.show(scene, this.size, { ...options, hidden: new Set(this.#meshes.keys()) });
    this.joints = scene.joints;
    const tool = scene.bodies[scene.bodies.length - 1].frame;
    this.#place(this.triad, tool, 0.14);
    this.#meshes.forEach((mesh, name) => {
      const body = scene.bodies.find((one) => one.name === name);
      mesh.visible = Boolean(body);
      if (body) this.#place(mesh, body.frame, null);
    });
    if (!this.isDragged) this.#place(this.handle, target ?? tool, null);
    this.ask();
  }

  /** Ghosts of scenes, each with the number by which it is taken. */
  showGhosts(scenes) {
    while (this.#ghosts.length < scenes.length) {
      const ghost = new Figure({ isGhost: true, colours: COLOURS[this.theme] });
      this.#ghosts.push(ghost);
      this.scene.add(ghost.group);
    }
    this.#ghosts.forEach((ghost, i) => {
      ghost.group.visible = i < scenes.length;
      if (ghost.group.visible) ghost.show(scenes[i], this.size);
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
      map.magFilter = NearestFilter;
      const geometry = new PlaneGeometry(1, 1);
      const [origin, along, up] = corners;
      const at = (a, b) => origin.map((value, i) => value + a * along[i] + b * up[i]);
      [at(0, 1), at(1, 1), at(0, 0), at(1, 0)].forEach((point, i) => geometry.getAttribute("position").setXYZ(i, ...point));
      const material = new MeshBasicMaterial({ map, transparent: true, opacity: 0.75, side: DoubleSide, depthWrite: false });
      this.slice = new Mesh(geometry, material);
      this.slice.frustumCulled = false;
      this.extra.add(this.slice);
    }
    this.ask();
  }

  /** A mesh of the user's own in the place of a body. */
  replaceBody(name, mesh) {
    const holder = new Object3D();
    holder.add(mesh);
    this.#meshes.set(name, holder);
    this.scene.add(holder);
  }

  clearBodies() {
    this.#meshes.forEach((mesh) => mesh.removeFromParent());
    this.#meshes.clear();
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
    if (this.figure.group.children.length && !this.isDrawn) performance.mark("first picture");
    this.isDrawn ||= this.figure.group.children.length > 0;
  }

  /** Where the tool's handle is on the screen, in pixels of the page. */
  placeOf(position) {
    const point = this.handle.position.clone().set(...position).project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + ((point.x + 1) / 2) * box.width, box.top + ((1 - point.y) / 2) * box.height];
  }

  #light() {
    const sun = new DirectionalLight(0xffffff, 2.1);
    sun.position.set(2, -3, 4);
    const other = new DirectionalLight(0xffffff, 0.7);
    other.position.set(-3, 2, 1);
    const sky = new HemisphereLight(0xffffff, 0x8890a0, 1.0);
    sky.position.set(0, 0, 1);
    this.scene.add(sun, other, sky, new AmbientLight(0xffffff, 0.35));
  }

  #handles() {
    this.handle = new Object3D();
    this.scene.add(this.handle);
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
    this.floor.children.forEach((grid) => grid.dispose());
    this.floor.clear();
    const { low, centre, size } = this.extent;
    const step = 10 ** Math.round(Math.log10(size / 10));
    const count = Math.ceil((1.6 * size) / step) * 2;
    const grid = new GridHelper(count * step, count, ...FLOOR[this.theme]);
    grid.rotation.x = Math.PI / 2;
    grid.position.set(Math.round(centre[0] / step) * step, Math.round(centre[1] / step) * step, Math.min(low[2], 0) - 0.07 * size);
    this.floor.add(grid);
    this.origin.scale.setScalar(0.1 * size);
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
    if (!hit) return;
    this.heard.onGhost(shown.findIndex((group) => group.children.includes(hit.object)));
  }

  /** The names of the joints beside them. */
  #label() {
    const box = this.canvas.getBoundingClientRect();
    const joints = this.labels.hidden || !this.joints ? [] : this.joints;
    while (this.labels.children.length < joints.length) this.labels.append(document.createElement("span"));
    const taken = [];
    [...this.labels.children].forEach((label, i) => {
      label.hidden = i >= joints.length;
      if (label.hidden) return;
      const point = this.handle.position.clone().set(...joints[i].at).project(this.camera);
      label.textContent = joints[i].joints.join(" ");
      const x = ((point.x + 1) / 2) * box.width + 8;
      let y = ((1 - point.y) / 2) * box.height - 22;
      while (taken.some((other) => Math.abs(other[0] - x) < LABEL[0] && Math.abs(other[1] - y) < LABEL[1])) y -= LABEL[1];
      taken.push([x, y]);
      label.style.transform = `translate(${x}px, ${y}px)`;
    });
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
