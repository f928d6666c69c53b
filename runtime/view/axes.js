/** A slider and a number for every axis, with its limits and turns. */

import { element, numberIn, section, shown, unitOf, write } from "./element.js";
import { lengthOf } from "./start.js";

/** A limit farther away than so many times the way of an axis limits nothing that is looked at. */
const FAR = 1000;

export class AxesPanel {
  #rows = [];

  constructor(model) {
    this.model = model;
    this.list = element("div", { role: "group", "aria-label": "Axes" });
    this.element = section("Axes", true, this.list);
    model.onChange((what) => {
      if (what === "machine") this.#build();
      if (what !== "refused parameter") this.#update();
    });
  }

  #build() {
    this.#rows = this.model.description.axes.map((axis, i) => this.#row(axis, i));
    this.list.replaceChildren(...this.#rows.map((row) => row.element));
    if (!this.#rows.length) this.list.append(element("p", { class: "soft" }, "This machine has no axes."));
  }

  #row(axis, i) {
    const changed = (field) => {
      const value = numberIn(field);
      if (value === null) return;
      this.model.moveAxes(this.model.axes.map((one, k) => (k === i ? value : one)));
    };
    const id = `axis-${i}`;
    const slider = element("input", { type: "range", step: "any", "aria-label": `${axis.name}: ${axis.meaning}`, title: axis.meaning,
      input: ({ target }) => changed(target) });
    const number = element("input", { type: "number", step: "any", id, input: ({ target }) => changed(target), keydown: stepped });
    const [range, turn] = [element("div", { class: "soft" }), element("small")];
    const row = element("div", { class: "axis" }, element("label", { for: id, title: axis.meaning }, axis.name), slider, number,
      element("span", {}, unitOf(axis.unit)), turn, range);
    return { element: row, slider, number, range, turn, axis };
  }

  #update() {
    const { axes, machine, refusal, description } = this.model;
    const travel = lengthOf(machine);
    this.#rows.forEach((row, i) => {
      const { lower, upper } = machine.limits[i];
      const reach = row.axis.unit === "deg" ? (row.axis.multiTurn ? 540 : 180) : travel;
      const [hasLower, hasUpper] = [lower, upper].map((end) => end !== null && Math.abs(end) < FAR * reach);
      const [low, high] = [hasLower ? lower : Math.min(-reach, axes[i]), hasUpper ? upper : Math.max(hasLower ? lower + 2 * reach : reach, axes[i])];
      Object.assign(row.slider, { min: low, max: high });
      write(row.slider, axes[i], 6);
      write(row.number, axes[i]);
      const isBeyond = (lower !== null && axes[i] < lower) || (upper !== null && axes[i] > upper);
      row.number.setAttribute("aria-invalid", String(isBeyond));
      row.range.hidden = !hasLower && !hasUpper;
      row.range.textContent = `limits ${hasLower ? shown(lower) : "none"} … ${hasUpper ? shown(upper) : "none"}`;
      const byte = description.periodAxes.indexOf(i);
      const turn = byte < 0 || refusal ? 0 : this.model.pose?.configuration[description.branchCount + byte];
      row.turn.textContent = turn ? `turn ${turn}` : "";
    });
  }
}

/** Arrow keys step a field by 1, by 10 with shift, by 0.1 with alt. */
export function stepped(event) {
  const sense = { ArrowUp: 1, ArrowDown: -1 }[event.key];
  const value = numberIn(event.target);
  if (!sense || value === null) return;
  event.preventDefault();
  event.target.value = shown(value + sense * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1), 6);
  event.target.dispatchEvent(new Event("input", { bubbles: true }));
}
