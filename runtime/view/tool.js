/** The frame of the tool as six numbers, to be read and typed; and the bytes of the configuration by their names. */

import { stepped } from "./axes.js";
import { element, numberIn, section, write } from "./element.js";
import { frameOf, numbersOf } from "./pose.js";

const NAMES = ["X", "Y", "Z", "A", "B", "C"];

export class ToolPanel {
  constructor(model) {
    this.model = model;
    this.fields = NAMES.map((name) => element("input", { type: "number", step: "any", id: `tool-${name}`, keydown: stepped,
      input: ({ target }) => this.#typed(target) }));
    const labels = NAMES.map((name, i) => element("label", { for: `tool-${name}` }, name, this.fields[i]));
    this.reached = element("p", { class: "soft" });
    this.element = section("Tool frame", true, element("div", { class: "six", role: "group", "aria-label": "Frame of the tool" }, ...labels),
      element("p", { class: "soft" }, "A, B, C in degrees: Rz(A) Ry(B) Rz(C)"), this.reached);
    model.onChange((what) => what !== "refused parameter" && this.#update());
  }

  /** One number is typed; the others stay as they are, with all their digits. */
  #typed(field) {
    const value = numberIn(field);
    if (value === null) return;
    const { pose, target, refusal } = this.model;
    const values = numbersOf(refusal && target ? target : pose.frame);
    values[this.fields.indexOf(field)] = value;
    this.model.moveTo(frameOf(values));
  }

  #update() {
    const { pose, target, refusal, isCommanded, description } = this.model;
    if (!pose) return;
    const asked = refusal && target ? target : pose.frame;
    numbersOf(asked).forEach((value, i) => write(this.fields[i], value));
    this.fields.forEach((field) => {
      field.disabled = !isCommanded;
      field.setAttribute("aria-invalid", String(Boolean(refusal && target)));
    });
    const commanded = [...description.task.position].map((name) => name.toUpperCase()).join(", ");
    const turning = { none: "", "about z": "the turn about Z", full: "the whole rotation", direction: "a direction" }[description.task.turning] ?? description.task.turning;
    this.reached.textContent = `Commanded: ${[commanded, turning].filter(Boolean).join(" and ") || "nothing"}.`;
  }
}

export class ConfigurationPanel {
  #bytes = [];

  constructor(model) {
    this.model = model;
    this.list = element("div");
    this.element = section("Configuration", true, this.list);
    model.onChange((what) => {
      if (what === "machine") this.#build();
      if (what !== "refused parameter") this.#update();
    });
  }

  #build() {
    this.#bytes = this.model.description.configuration.map((byte, i) => (byte.kind === "branch" ? this.#branch(byte, i) : this.#turn(byte, i)));
    const ofKind = (kind) => this.#bytes.filter((byte) => byte.kind === kind).map((byte) => byte.element);
    const turns = ofKind("period");
    this.list.replaceChildren(...ofKind("branch"));
    if (turns.length) {
      this.list.append(element("div", { class: "six", role: "group", "aria-label": "Turns" }, ...turns),
        element("p", { class: "soft" }, "Turns of the axes: 1 is −180° to 180°, 2 the one above, −1 the one below, 0 leaves it open."));
    }
    if (!this.#bytes.length) this.list.append(element("p", { class: "soft" }, "There is one solution, and nothing to choose."));
  }

  #branch(byte, i) {
    const buttons = [...byte.branches, "automatic"].map((name, k) => element("button", { "aria-pressed": "false",
      click: () => this.#choose(i, k === 2 ? 0 : k + 1) }, name));
    const value = element("small");
    const label = element("span", { id: `byte-${i}` }, element("b", {}, byte.name.replaceAll("_", " ")), value);
    const choice = element("div", { class: "row" }, ...buttons);
    return { kind: "branch", buttons, value, element: element("div", { class: "byte", role: "group", "aria-labelledby": `byte-${i}` }, label, choice) };
  }

  #turn(byte, i) {
    const field = element("input", { type: "number", step: "1", min: "-127", max: "127", id: `byte-${i}`, change: ({ target }) => {
      const number = numberIn(target);
      if (number !== null) this.#choose(i, Math.trunc(number));
    } });
    return { kind: "period", field, element: element("label", { for: `byte-${i}`, title: `Turn of ${byte.name}, byte ${i}` }, byte.name, field) };
  }

  #choose(i, byte) {
    const { model } = this;
    if (i < model.description.branchCount) model.automatic[byte === 0 ? "add" : "delete"](i);
    const bytes = model.branches();
    bytes[i] = byte;
    model.moveTo(model.target ?? model.pose.frame, bytes);
  }

  #update() {
    const bytes = this.model.pose?.configuration ?? [];
    this.#bytes.forEach((entry, i) => {
      if (entry.kind === "period") {
        write(entry.field, bytes[i]);
        return;
      }
      entry.buttons.forEach((button, k) => {
        const isOn = k === 2 ? this.model.automatic.has(i) : bytes[i] === k + 1;
        button.setAttribute("aria-pressed", String(isOn));
      });
      entry.value.textContent = `byte ${i}: ${bytes[i]}${bytes[i] === 3 ? ", both meet here" : ""}`;
    });
  }
}
