/** The line from A to B in the panel: its ends, plots of the axes, play, pause, scrub. */

import { element, section, shown, unitOf } from "./element.js";
import { alongLine } from "./line.js";

const [WIDTH, HEIGHT, LEFT, GAP] = [370, 62, 44, 16];
const SECONDS = 4;
const GOOD = 0x2f7fd6, REFUSED = 0xd83a34, SINGULAR = 0xe0a100;

export class LinePanel {
  #samples = [];
  #playing = null;

  constructor(model, stage) {
    Object.assign(this, { model, stage, ends: { A: null, B: null } });
    const end = (name) => element("button", { click: () => this.set(name) }, `${name} = this pose`);
    this.play = element("button", { click: () => this.#toggle(), disabled: true }, "Play");
    this.scrub = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0, disabled: true, class: "grow",
      "aria-label": "Place on the line", input: () => this.#show(Number(this.scrub.value)) });
    this.said = element("p", { role: "status", class: "soft" }, "Set A, move the tool, set B.");
    this.plots = element("div");
    this.element = section("Line from A to B", false, element("div", { class: "row" }, end("A"), end("B"), this.play),
      element("div", { class: "row" }, this.scrub), this.said, this.plots);
    model.onChange((what) => (what === "machine" || what === "dimensions") && this.#clear());
  }

  /** Take the present pose for an end; with both ends the line is computed. */
  set(name) {
    const { pose } = this.model;
    if (!pose) return;
    const frame = this.model.target ?? pose.frame;
    this.ends[name] = { frame, axes: this.model.axes, bytes: this.model.branches() };
    if (this.ends.A && this.ends.B) this.#compute();
    else this.said.textContent = `${name} is set. Move the tool, and set ${name === "A" ? "B" : "A"}.`;
  }

  #clear() {
    this.#stop();
    this.ends = { A: null, B: null };
    this.#samples = [];
    this.plots.replaceChildren();
    this.play.disabled = this.scrub.disabled = true;
    this.said.textContent = "Set A, move the tool, set B.";
    this.stage.showPath([], []);
  }

  #compute() {
    const { A, B } = this.ends;
    this.#samples = alongLine(this.model.machine, A.frame, B.frame, A.bytes, A.axes);
    this.play.disabled = this.scrub.disabled = false;
    const refused = this.#samples.filter((sample) => !sample.axes);
    const counted = [
      refused.length ? `Refused from ${percent(refused[0].at)}: ${refused[0].words}.` : "There is a way on this branch.",
      this.#samples.some((one) => one.isSingular) ? "Singular stretches are marked." : "",
      this.#samples.some((one) => one.isJump) ? "An axis jumps." : "",
    ];
    this.said.textContent = counted.filter(Boolean).join(" ");
    this.said.className = refused.length ? "bad" : "soft";
    const colours = this.#samples.map((one) => (!one.axes ? REFUSED : one.isSingular ? SINGULAR : GOOD));
    this.stage.showPath(this.#samples.map((one) => one.frame.position), colours);
    this.plots.replaceChildren(this.#drawn());
    this.#cursor(Number(this.scrub.value));
  }

  #toggle() {
    if (this.#playing !== null) {
      this.#stop();
      return;
    }
    let begin = null;
    const from = Number(this.scrub.value) >= 1 ? 0 : Number(this.scrub.value);
    this.play.textContent = "Pause";
    const step = (now) => {
      begin ??= now;
      const at = Math.min(1, from + (now - begin) / (1000 * SECONDS));
      this.scrub.value = at;
      this.#show(at);
      if (at < 1) this.#playing = requestAnimationFrame(step);
      else this.#stop();
    };
    this.#playing = requestAnimationFrame(step);
  }

  #stop() {
    if (this.#playing !== null) cancelAnimationFrame(this.#playing);
    this.#playing = null;
    this.play.textContent = "Play";
  }

  #show(at) {
    const sample = this.#samples[Math.round(at * (this.#samples.length - 1))];
    if (!sample) return;
    if (sample.axes) this.model.take(sample.axes, sample.frame);
    else this.model.moveTo(sample.frame, this.ends.A.bytes);
    this.#cursor(at);
  }

  #cursor(at) {
    this.plots.querySelector(".now")?.setAttribute("transform", `translate(${LEFT + at * (WIDTH - LEFT)} 0)`);
  }

  #drawn() {
    const { axes } = this.model.description;
    const bottom = axes.length * (HEIGHT + GAP);
    const height = bottom + GAP;
    const svg = drawn("svg", { viewBox: `0 0 ${WIDTH} ${height}`, class: "plots", role: "img", "aria-label": "The axes along the line" });
    axes.forEach((axis, i) => svg.append(this.#plot(axis, i)));
    for (const [text, x, anchor] of [["A, 0 s", LEFT, "start"], [`B, ${SECONDS} s`, WIDTH, "end"]]) {
      const time = drawn("text", { x, y: bottom + 8, "text-anchor": anchor });
      time.textContent = text;
      svg.append(time);
    }
    svg.append(drawn("line", { class: "now", x1: 0, x2: 0, y1: 0, y2: bottom }));
    return svg;
  }

  #plot(axis, i) {
    const values = this.#samples.filter((one) => one.axes).map((one) => one.axes[i]);
    const { lower, upper } = this.model.machine.limits[i];
    let [low, high] = [Math.min(...values), Math.max(...values)];
    if (!values.length) [low, high] = [0, 1];
    const room = Math.max(0.08 * (high - low), 1e-6 * (1 + Math.abs(low)), axis.unit === "deg" ? 0.5 : 0);
    [low, high] = [low - room, high + room];
    const group = drawn("g", { transform: `translate(0 ${i * (HEIGHT + GAP) + GAP - 4})` });
    const x = (at) => LEFT + at * (WIDTH - LEFT);
    const y = (value) => HEIGHT * (1 - (value - low) / (high - low));
    group.append(drawn("rect", { class: "frame", x: LEFT, y: 0, width: WIDTH - LEFT, height: HEIGHT }));
    for (const [isIn, kind] of [[(one) => !one.axes, "stop"], [(one) => one.isSingular, "singular"]]) {
      for (const [from, to] of stretches(this.#samples, isIn)) {
        group.append(drawn("rect", { class: kind, x: x(from), y: 0, width: Math.max(2, x(to) - x(from)), height: HEIGHT }));
      }
    }
    for (const end of [lower, upper]) {
      if (end !== null && end >= low && end <= high) group.append(drawn("line", { class: "limit", x1: LEFT, x2: WIDTH, y1: y(end), y2: y(end) }));
    }
    let path = "";
    this.#samples.forEach((one, k) => {
      if (!one.axes) return;
      const joins = k > 0 && this.#samples[k - 1].axes && !one.isJump;
      path += `${joins ? "L" : "M"}${x(one.at).toFixed(1)} ${y(one.axes[i]).toFixed(1)}`;
      if (one.isJump) group.append(drawn("line", { class: "jump", x1: x(one.at), x2: x(one.at), y1: 0, y2: HEIGHT }));
    });
    group.append(drawn("path", { class: "curve", d: path }));
    const label = (text, at, anchor = "end") => {
      const found = drawn("text", { x: anchor === "end" ? LEFT - 4 : 0, y: at, "text-anchor": anchor });
      found.textContent = text;
      group.append(found);
    };
    label(shown(high - room, 1), 10);
    label(shown(low + room, 1), HEIGHT);
    label(`${axis.name} ${unitOf(axis.unit)}`, HEIGHT / 2 + 4, "start");
    return group;
  }
}

function percent(part) {
  return `${(100 * part).toFixed(0)} %`;
}

/** From where to where samples have a property. */
function stretches(samples, isIn) {
  const found = [];
  let from = null;
  samples.forEach((one, i) => {
    if (isIn(one)) from ??= one.at;
    if (from !== null && (!isIn(one) || i === samples.length - 1)) {
      found.push([from, one.at]);
      from = null;
    }
  });
  return found;
}

function drawn(tag, attributes) {
  const found = document.createElementNS("http://www.w3.org/2000/svg", tag);
  Object.entries(attributes).forEach(([name, value]) => found.setAttribute(name, value));
  return found;
}
