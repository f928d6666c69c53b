/** A slice of the workspace: which plane, at which height, coloured by what; computed in a worker, with progress. */

import { element, numberIn, section, shown } from "./element.js";

/** Cells along a side, and the parts along a side of a cell at a border. */
const [CELLS, FINE] = [96, 4];
const PLANES = { XY: [0, 1, 2], XZ: [0, 2, 1], YZ: [1, 2, 0] };
/** From singular to far from it, and from one solution to many: readable without telling red from green. */
const STOPS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const REACHED = [46, 134, 171];
/** How much a colour covers, of 255: the machine is seen through it. */
const COVER = 120;
/** Numbers that are typed, or a slider that moves, are waited for. */
const AGAIN_AFTER = 200;

export class SlicePanel {
  #worker = null;

  constructor(model, stage) {
    Object.assign(this, { model, stage });
    const choice = (id, names) => element("select", { id }, ...names.map(([value, name]) => element("option", { value }, name)));
    this.plane = choice("slice-plane", Object.keys(PLANES).map((name) => [name, name]));
    this.height = element("input", { type: "number", step: "any", id: "slice-height", "aria-label": "Height of the slice", input: () => this.#again() });
    this.what = element("select", { id: "slice-what", "aria-label": "Colour by", change: () => this.#again() });
    this.progress = element("progress", { max: CELLS, value: 0, "aria-label": "Progress of the slice", hidden: true });
    this.said = element("p", { role: "status", class: "soft" });
    this.legend = element("div", { class: "legend" });
    this.run = element("button", { click: () => (this.#worker ? this.#stop("Stopped.") : this.#begin()) }, "Compute");
    const clear = element("button", { click: () => this.#clear() }, "Clear");
    const here = element("button", { click: () => this.#atTool() }, "at the tool");
    this.element = section("Slice of the workspace", false,
      element("div", { class: "row" }, element("label", { for: "slice-plane" }, "Plane"), this.plane, element("label", { for: "slice-height" }, "at"), this.height, here),
      element("div", { class: "row" }, element("label", { for: "slice-what" }, "Colour by"), this.what, this.run, clear),
      this.progress, this.legend, this.said);
    this.plane.addEventListener("change", () => this.#atTool());
    model.onChange((what) => {
      if (what === "machine") this.#clear();
      if (what === "machine") this.#offer();
      if (what === "dimensions") this.#again();
    });
  }

  /** Another choice: what is shown, or computed, is computed again. */
  #again() {
    clearTimeout(this.waiting);
    if (this.#worker || this.stage.slice) this.waiting = setTimeout(() => this.#begin(), AGAIN_AFTER);
  }

  #offer() {
    const { margins, task } = this.model.description;
    const names = [["reach", "reachable"], ["number", "number of solutions"], ...margins.map(({ name }) => [name, `margin ${name.replaceAll("_", " ")}`])];
    this.what.replaceChildren(...names.map(([value, name]) => element("option", { value }, name)));
    this.run.disabled = task.position === "";
    this.plane.value = task.position.includes("y") ? "XY" : "XZ";
    this.#atTool();
  }

  #atTool() {
    const { pose } = this.model;
    if (pose) this.height.value = shown(pose.frame.position[PLANES[this.plane.value][2]], 4);
    this.#again();
  }

  #begin() {
    const { model } = this;
    const height = numberIn(this.height);
    if (!model.pose || !this.stage.extent || height === null) return;
    this.#stop("");
    const [along, up, across] = PLANES[this.plane.value];
    const { centre, size } = this.stage.extent;
    const half = 1.25 * size;
    const origin = [0, 0, 0];
    [origin[along], origin[up], origin[across]] = [centre[along] - half, centre[up] - half, height];
    const basis = [along, up].map((k) => [0, 1, 2].map((i) => (i === k ? 2 * half : 0)));
    this.corners = [origin, ...basis];
    this.values = [];
    this.parts = [];
    this.canvas = element("canvas", { width: CELLS * FINE, height: CELLS * FINE });
    const address = URL.createObjectURL(new Blob([document.getElementById("program").textContent], { type: "text/javascript" }));
    this.#worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.#worker.onmessage = ({ data }) => this.#receive(data);
    this.#worker.onerror = ({ message }) => this.#stop(`The slice failed: ${message}`);
    this.#worker.postMessage({
      name: model.name, parameters: model.parameters, cells: CELLS, fine: FINE, corners: this.corners, rotation: model.pose.frame.rotation,
      what: this.what.value, bytes: model.branches(), reference: model.axes,
    });
    this.progress.hidden = false;
    this.run.textContent = "Stop";
    this.said.textContent = "Computing …";
  }

  #receive({ until, rows, parts }) {
    this.values.push(...rows);
    this.parts = parts ?? [];
    this.progress.value = until;
    this.#paint();
    if (!parts) return;
    const all = this.values.flatMap((row) => [...row]);
    const reached = all.filter((value) => value >= 0).length;
    this.#stop(`${((100 * reached) / all.length).toFixed(1)} % of the slice is reached, with the rotation of this pose.`);
  }

  #paint() {
    const context = this.canvas.getContext("2d");
    const kind = this.what.value;
    const most = kind === "number" ? Math.max(1, ...this.values.map((row) => Math.max(...row))) : 1;
    const tinted = (value) => (kind === "reach" ? REACHED : tint(value / most));
    const paint = (value, x, y, size) => {
      context.fillStyle = value < 0 ? "transparent" : `rgb(${tinted(value).join(" ")} / ${COVER / 255})`;
      context.clearRect(x, y, size, size);
      context.fillRect(x, y, size, size);
    };
    this.values.forEach((row, i) => row.forEach((value, k) => paint(value, k * FINE, i * FINE, FINE)));
    for (const { row, column, values } of this.parts) {
      values.forEach((value, k) => paint(value, column * FINE + (k % FINE), row * FINE + Math.floor(k / FINE), 1));
    }
    this.stage.showSlice(this.canvas, this.corners);
    const entries = kind === "reach" ? [[1, "reached"]]
      : kind === "number" ? Array.from({ length: most }, (_, i) => [(i + 1) / most, String(i + 1)])
        : [[0, "0, singular"], [0.5, "0.5"], [1, "1"]];
    this.legend.replaceChildren(...entries.map(([value, name]) => {
      const key = element("i");
      key.style.background = `rgb(${tinted(value * most).join()})`;
      return element("span", {}, key, name);
    }), element("span", {}, "no colour: not reached"));
  }

  #stop(words) {
    this.#worker?.terminate();
    this.#worker = null;
    this.progress.hidden = true;
    this.progress.value = 0;
    this.run.textContent = "Compute";
    this.said.textContent = words;
  }

  #clear() {
    clearTimeout(this.waiting);
    this.#stop("");
    this.legend.replaceChildren();
    this.stage.showSlice(null);
  }
}

function tint(part) {
  const place = Math.min(Math.max(part, 0), 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(place), STOPS.length - 2);
  return STOPS[i].map((value, k) => Math.round(value + (place - i) * (STOPS[i + 1][k] - value)));
}
