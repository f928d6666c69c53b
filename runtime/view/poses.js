/** All poses that a platform has at its axes: in both assembly modes, found on demand in small slices, and shown as ghosts. */

import { element, section, shown } from "./element.js";
import { anglesOf } from "./pose.js";
import { isSame, posesFrom } from "./search.js";
import { pointsOf } from "./space.js";
import { lengthOf } from "./start.js";

/** Milliseconds after which the page has its turn. */
const SLICE = 12;

export class PosesPanel {
  /** The other poses to be shown: {scene, text}. */
  shown = [];

  /** changed() is called when others are to be shown. */
  constructor(model, changed) {
    Object.assign(this, { model, changed });
    this.run = element("button", { click: () => (this.isRunning ? this.#stop() : this.#begin()) }, "Find all poses");
    this.said = element("p", { role: "status", class: "soft" });
    this.list = element("ol", { class: "solutions", "aria-label": "Poses at these axes" });
    this.element = section("Poses at these axes", true, element("div", { class: "row" }, this.run), this.said, this.list);
    model.onChange((what) => {
      if (what === "refused parameter") return;
      this.isRunning = false;
      this.run.textContent = "Find all poses";
      this.said.textContent = "";
      this.list.replaceChildren();
      this.shown = [];
      this.element.hidden = !model.description.startsForward;
    });
  }

  async #begin() {
    const { machine, pose } = this.model;
    if (!pose) return;
    this.isRunning = true;
    this.run.textContent = "Stop";
    const search = posesFrom(machine, pose.axes, pointsOf(pose.scene), pose.frame);
    let [found, until] = [null, performance.now() + SLICE];
    for (const step of search) {
      found = step;
      if (performance.now() < until) continue;
      this.said.textContent = `${step.poses.length} poses from ${step.starts} starts …`;
      await new Promise((done) => { setTimeout(done); });
      if (this.model.pose !== pose) return; // the axes, or the machine, are others
      if (!this.isRunning) break;
      until = performance.now() + SLICE;
    }
    this.#end(found, pose);
  }

  #stop() {
    this.isRunning = false;
  }

  #end({ starts, poses }, pose) {
    const { machine } = this.model;
    const least = Math.min(...poses.map(({ count }) => count));
    this.isRunning = false;
    this.run.textContent = "Find all poses";
    this.said.textContent = `${poses.length} poses found, by Newton's method from ${starts} starts all around the machine; each was found ${least} times or more. This is a search, no proof: there may be more.`;
    const others = poses.map((one, i) => ({ ...one, text: String(i + 1), scene: machine.scene(pose.axes, one.frame) }));
    const ghosts = others.filter(({ frame, scene }) => !scene.status && !isSame(frame, pose.frame, lengthOf(machine)));
    this.list.replaceChildren(...others.map((one) => this.#entry(one, ghosts)));
    this.shown = ghosts;
    this.changed();
  }

  #entry(one, ghosts) {
    const { frame, isOther, text } = one;
    const values = [...frame.position, ...anglesOf(frame.rotation)].map((value, i) => `${"XYZABC"[i]} ${shown(value, 2)}`).join("  ");
    const name = ghosts.includes(one) ? `${text}: ${isOther ? "the other" : "this"} assembly mode` : `${text}: the pose that is shown`;
    return element("li", {}, element("button", { "aria-pressed": "false", title: "Show this one alone", click: ({ currentTarget: target }) => {
      const isAlone = target.getAttribute("aria-pressed") === "true";
      this.list.querySelectorAll("button").forEach((button) => button.setAttribute("aria-pressed", String(button === target && !isAlone)));
      this.shown = isAlone ? ghosts : ghosts.filter((ghost) => ghost === one);
      this.changed();
    } }, name, element("small", {}, values)));
  }
}
