/** What the machine says of a pose: margins as gauges, other solutions, dimensions and why one is refused. */

import { element, numberIn, section, shown, unitOf } from "./element.js";
import { isFree, limitOf } from "./limits.js";

/** A margin below this is worth a warning colour. */
const NEAR = 0.1;
const KINDS = {
  "type 1": "there an axis moves without moving the tool, and a direction of the tool is lost",
  "type 2": "there the axes do not hold the tool",
};

/** "good", "near" or "singular", by the least margin of a pose. */
export function stateOf(pose) {
  if (!pose || pose.singularity.status || pose.singularity.isSingular) return "singular";
  return nearestOf(pose).margin < NEAR ? "near" : "good";
}

/** The singularity that is nearest to a pose: its name, and its margin in size. */
export function nearestOf(pose) {
  const sizes = Object.entries(pose?.singularity.margins ?? {}).map(([name, margin]) => ({ name, margin: Math.abs(margin) }));
  return sizes.reduce((least, one) => (one.margin < least.margin ? one : least), { name: "", margin: Infinity });
}

export class MarginsPanel {
  #gauges = [];

  constructor(model) {
    this.model = model;
    this.list = element("div");
    this.element = section("Singularity margins", true, this.list);
    model.onChange((what) => {
      if (what === "machine") this.#build();
      if (what !== "refused parameter") this.#update();
    });
  }

  #build() {
    const { margins } = this.model.description;
    this.#gauges = margins.map(({ name, kind }) => {
      const [fill, value] = [element("i"), element("span")];
      const words = name.replaceAll("_", " ");
      const bar = element("div", { class: "bar", role: "meter", "aria-label": `${words}, ${kind} singularity`, "aria-valuemin": "0", "aria-valuemax": "1" }, fill);
      const row = element("div", { class: "gauge", title: `${kind}: ${KINDS[kind] ?? ""}` }, element("span", {}, words, " ", element("small", {}, kind)), bar, value);
      return { name, fill, value, bar, element: row };
    });
    this.list.replaceChildren(...this.#gauges.map((gauge) => gauge.element));
    if (!margins.length) this.list.append(element("p", { class: "soft" }, "This machine has no singular pose."));
  }

  #update() {
    const { pose, parameters, description } = this.model;
    const near = parameters[description.settings.warningDistance];
    const margins = pose?.singularity.margins ?? {};
    for (const gauge of this.#gauges) {
      const value = margins[gauge.name];
      const size = value === undefined ? 0 : Math.min(1, Math.abs(value));
      gauge.fill.style.width = `${(100 * Math.sqrt(size)).toFixed(2)}%`;
      gauge.value.textContent = value === undefined ? "none" : shown(value, 4);
      gauge.bar.setAttribute("aria-valuenow", String(size));
      gauge.element.className = `gauge ${size < near ? "singular" : size < NEAR ? "near" : ""}`;
    }
  }
}

export class SolutionsPanel {
  constructor(model) {
    this.model = model;
    this.list = element("ol", { class: "solutions", "aria-label": "Solutions for this frame" });
    this.refused = element("ol", { class: "solutions", "aria-label": "Refused slots" });
    this.count = element("summary", { class: "soft" });
    this.others = element("details", { class: "refused" }, this.count, this.refused);
    this.element = section("Solutions", true, this.list, this.others);
    model.onChange((what) => {
      if (what === "machine") this.list.style.minHeight = "0";
    });
  }

  /** Solutions as the model gives them. */
  show(solutions) {
    const { axes } = this.model.description;
    const entry = (slot) => {
      const name = this.model.nameOf(slot.branches ?? []);
      if (slot.status) return element("li", { class: "soft" }, name && slot.branches ? `${name}: ${slot.words}` : slot.words);
      const values = slot.axes.map((value, i) => `${axes[i].name} ${shown(value, 2)}`).join("  ");
      const button = element("button", { "aria-pressed": String(slot.isPresent), click: () => this.model.take(slot.axes) }, name, element("small", {}, values));
      return element("li", {}, button);
    };
    const held = this.list.contains(document.activeElement) ? [...this.list.querySelectorAll("button")].indexOf(document.activeElement) : -1;
    const refused = solutions.filter((slot) => slot.status);
    this.list.replaceChildren(...solutions.filter((slot) => !slot.status).map(entry));
    this.list.querySelectorAll("button")[held]?.focus();
    this.refused.replaceChildren(...refused.map(entry));
    this.count.textContent = `${refused.length} refused`;
    this.others.hidden = !refused.length;
    this.element.hidden = !solutions.length;
    this.list.style.minHeight = `${Math.max(parseFloat(this.list.style.minHeight), this.list.clientHeight)}px`; // what is below stays in its place
  }
}

export class DimensionsPanel {
  #rows = [];

  constructor(model) {
    this.model = model;
    this.dimensions = element("div");
    this.limits = element("div");
    this.element = section("Dimensions", false, this.dimensions);
    this.second = section("Limits and settings", false, this.limits);
    model.onChange((what) => {
      if (what === "machine") this.#build();
      if (what !== "pose") this.#update();
    });
  }

  #build() {
    const { description } = this.model;
    const ends = new Set(description.limits.flatMap(({ lower, upper }) => [lower, upper]));
    const settings = new Set([...ends, ...Object.values(description.settings)]);
    this.#rows = description.parameters.map((parameter, i) => ({ ...this.#row(parameter, i), isSetting: settings.has(parameter.name) }));
    this.dimensions.replaceChildren(...this.#rows.filter((row) => !row.isSetting).map((row) => row.element));
    this.limits.replaceChildren(...this.#rows.filter((row) => row.isSetting).map((row) => row.element));
  }

  #row(parameter, i) {
    const { name, kind, meaning, unit } = parameter;
    const isFlag = kind === "flag";
    const wrong = element("span", { class: "wrong", id: `wrong-${i}`, role: "alert" });
    const isEnd = limitOf(this.model.description, name) !== undefined;
    const field = element("input", { type: isFlag ? "checkbox" : "number", step: "any", id: `parameter-${i}`, "aria-describedby": `wrong-${i}`, placeholder: isEnd ? "none" : null,
      [isFlag ? "change" : "input"]: ({ target }) => {
        const value = isFlag ? target.checked : numberIn(target);
        const isOpen = isEnd && target.value === "" && !target.validity.badInput;
        if (value !== null || isOpen) this.model.setParameter(name, value);
      } });
    const label = element("label", { for: `parameter-${i}`, title: meaning }, name.replaceAll("_", " "));
    const row = element("div", { class: "dimension" }, label, field, element("span", { class: "soft" }, unitOf(unit)), wrong);
    return { element: row, field, wrong, parameter, isFlag };
  }

  #update() {
    const { parameters, wrong } = this.model;
    for (const row of this.#rows) {
      const { name } = row.parameter;
      const isWrong = Boolean(wrong?.names.includes(name));
      row.field.setAttribute("aria-invalid", String(isWrong));
      row.wrong.textContent = isWrong && name === wrong.names[0] ? `Refused: ${wrong.words}` : "";
      if (row.isFlag) row.field.checked = Boolean(parameters[name]);
      else if (document.activeElement !== row.field) row.field.value = this.#written(name);
    }
  }

  /** A parameter as its field has it; the end of a limit that is open is an empty field. */
  #written(name) {
    const { parameters, wrong, description } = this.model;
    const given = { ...parameters, ...wrong?.values };
    const limit = limitOf(description, name);
    return (limit && isFree(limit, given)) || !Number.isFinite(given[name]) ? "" : String(given[name]);
  }
}
