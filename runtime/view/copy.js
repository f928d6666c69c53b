/** A pose as text to be copied: Python, Structured Text, CSV, the address. */

import { element, section } from "./element.js";
import { limitsOf } from "./limits.js";
import { numbersOf } from "./pose.js";

const AXES = ["X", "Y", "Z", "A", "B", "C"];

/** A number with all its digits, as all three languages read it. */
function exact(value) {
  const text = String(value === 0 ? 0 : value);
  return /^-?\d+$/.test(text) ? `${text}.0` : text.replace(/^(-?\d+)e/, "$1.0e");
}

/** The lines of Python that make this machine, and give these axes. names: {package, classes, keywords}. */
export function pythonOf(model, names) {
  const { description, parameters, pose, axes } = model;
  const keywords = names.keywords[model.name] ?? {};
  const ends = new Set(description.limits.flatMap(({ lower, upper }) => [lower, upper]));
  const given = description.parameters
    .filter(({ name, default: usual }) => !ends.has(name) && (usual === null || Number(usual) !== Number(parameters[name])))
    .map(({ name, kind }) => `${keywords[name] ?? name}=${kind === "flag" ? (parameters[name] ? "True" : "False") : exact(parameters[name])}`);
  const limits = limitsOf(description, parameters)
    .map(([name, pair]) => `${JSON.stringify(name)}: ${pair ? tuple(pair.map((end) => (end === null ? "None" : exact(end)))) : "None"}`);
  if (limits.length) given.push(`limits={${limits.join(", ")}}`);
  const [x, y, z, a, b, c] = numbersOf(pose.frame).map(exact);
  return [
    `import ${names.package}`, "",
    `robot = ${names.package}.${names.classes[model.name]}(${given.join(", ")})`,
    `frame = ${names.package}.Frame.from_euler(${a}, ${b}, ${c}, position=(${x}, ${y}, ${z}))`,
    `axes = robot.inverse(frame, ${tuple(pose.configuration.map(String))}, reference=${tuple(axes.map(exact))})`,
    "",
  ].join("\n");
}

function tuple(words) {
  return `(${words.join(", ")}${words.length === 1 ? "," : ""})`;
}

/** The configuration and the target in Structured Text. */
export function structuredTextOf({ description, pose }) {
  const bytes = pose.configuration.map((byte, i) => {
    const { name, kind, branches } = description.configuration[i];
    const said = kind === "period" ? `turn of ${name}${byte ? "" : ", open"}` : `${name}: ${branches[byte - 1] ?? (byte === 3 ? "both meet" : "automatic")}`;
    return `Config.abyData[${i}] := ${byte < 0 ? byte + 256 : byte};  // ${said}${byte < 0 ? `, the byte of ${byte}` : ""}`;
  });
  const target = numbersOf(pose.frame).map((value, i) => `target.c.${AXES[i]} := ${exact(value)};`);
  return [`// ${description.name}; VAR Config : TRAFO.CONFIGDATA; target : SMC_POS_REF; END_VAR`, ...bytes, ...target, ""].join("\n");
}

/** Axes, frame and configuration, a header line before them. */
export function csvOf({ description, pose, axes }) {
  const names = [...description.axes.map(({ name }) => `axis ${name}`), ...AXES, ...description.configuration.map(({ name }) => `byte ${name}`)];
  const values = [...axes, ...numbersOf(pose.frame), ...pose.configuration];
  return `${names.join(",")}\n${values.map((value) => String(value === 0 ? 0 : value)).join(",")}\n`;
}

export class CopyPanel {
  constructor(model, names) {
    this.text = element("textarea", { readonly: true, "aria-label": "The text that was copied", spellcheck: "false" });
    this.said = element("span", { role: "status", class: "soft" });
    const kinds = {
      Python: () => pythonOf(model, names),
      "Structured Text": () => structuredTextOf(model),
      CSV: () => csvOf(model),
      Address: () => location.href,
    };
    const buttons = Object.entries(kinds).map(([name, make]) => element("button", { click: () => this.#copy(name, make()) }, name));
    this.element = section("Copy this pose", false, element("div", { class: "row" }, ...buttons), this.text, this.said);
  }

  async #copy(name, text) {
    this.text.value = text;
    try {
      await navigator.clipboard.writeText(text);
      this.said.textContent = `${name} was copied.`;
    } catch {
      this.text.select();
      this.said.textContent = document.execCommand("copy") ? `${name} was copied.` : "Copy the text from this field.";
    }
  }
}
