/** A slice of the workspace: which plane, at which height, coloured by what; computed in a worker, with progress. */

import { element, numberIn, section, shown } from "./element.js";

const CELLS = 96;
const PLANES = { XY: [0, 1, 2], XZ: [0, 2, 1], YZ: [1, 2, 0] };
/** From singular to far from it, and from one solution to many: readable without telling red from green. */
const STOPS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

export class SlicePanel {
  #worker = null;

  constructor(model, stage) {
    Object.assign(this, { model, stage });
    const choice = (id, names) => element("select", { id }, ...names.map(([value, name]) => element("option", { value }, name)));
    this.plane = choice("slice-plane", Object.keys(PLANES).map((name) => [name, name]));
    this.height = element("input", { type: "number", step: "any", id: "slice-height", "aria-label": "Height of the slice" });
    this.what = element("select", { id: "slice-what", "aria-label": "Colour by" });
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
      if (what === "machine") this.#offer();
      if (what === "machine" || what === "dimensions") this.#clear();
    });
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
  }

  #begin() {
    const { model } = this;
    const height = numberIn(this.height);
    if (!model.pose || !this.stage.extent || height === null) return;
    const [along, up, across] = PLANES[this.plane.value];
    const { centre, size } = this.stage.extent;
    const half = 1.25 * size;
    const origin = [0, 0, 0];
    [origin[along], origin[up], origin[across]] = [centre[along] - half, centre[up] - half, height];
    const basis = [along, up].map((k) => [0, 1, 2].map((i) => (i === k ? 2 * half : 0)));
    this.corners = [origin, ...basis];
    this.values = [];
    this.canvas = element("canvas", { width: CELLS, height: CELLS });
    const address = URL.createObjectURL(new Blob([document.getElementById("program").textContent], { type: "text/javascript" }));
    this.#worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.#worker.onmessage = ({ data }) => this.#receive(data);
    this.#worker.onerror = ({ message }) => this.#stop(`The slice failed: ${message}`);
    this.#worker.postMessage({
      name: model.name, parameters: model.parameters, cells: CELLS, corners: this.corners, rotation: model.pose.frame.rotation,
      what: this.what.value, bytes: model.branches(), reference: model.axes,
    });
    this.progress.hidden = false;
    this.run.textContent = "Stop";
    this.said.textContent = "Computing …";
  }

  #receive({ until, rows }) {
    this.values.push(...rows);
    this.progress.value = until;
    this.#paint();
    if (until < CELLS) return;
    const all = this.values.flatMap((row) => [...row]);
    const reached = all.filter((value) => value >= 0).length;
    this.#stop(`${((100 * reached) / all.length).toFixed(1)} % of the slice is reached, with the rotation of this pose.`);
  }

  #paint() {
    const context = this.canvas.getContext("2d");
    const image = context.createImageData(CELLS, CELLS);
    const most = this.what.value === "number" ? Math.max(1, ...this.values.map((row) => Math.max(...row))) : 1;
    this.values.forEach((row, i) => row.forEach((value, k) => {
      const colour = value < 0 ? [128, 128, 128, 40] : [...tint(value / most), 255];
      image.data.set(colour, 4 * (i * CELLS + k));
    }));
    context.putImageData(image, 0, 0);
    this.stage.showSlice(this.canvas, this.corners);
    const entries = this.what.value === "reach" ? [[1, "reached"]]
      : this.what.value === "number" ? Array.from({ length: most }, (_, i) => [(i + 1) / most, String(i + 1)])
        : [[0, "0, singular"], [0.5, "0.5"], [1, "1"]];
    this.legend.replaceChildren(...entries.map(([value, name]) => {
      const key = element("i");
      key.style.background = `rgb(${tint(value).join()})`;
      return element("span", {}, key, name);
    }), element("span", {}, "grey: not reached"));
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
