/** The page: the picture, the panel, and what keeps both at the same pose. Without a page it is the worker of a slice. */

import { fragmentOf, readFragment } from "./address.js";
import { AxesPanel } from "./axes.js";
import { CopyPanel } from "./copy.js";
import { element } from "./element.js";
import { Live, tokenOf } from "./live.js";
import { MachineChoice } from "./machines.js";
import { meshesOf } from "./meshes.js";
import { Model, inWords } from "./model.js";
import { LinePanel } from "./plots.js";
import { PosesPanel } from "./poses.js";
import { refusing } from "./refusing.js";
import { DimensionsPanel, MarginsPanel, SolutionsPanel, nearestOf, stateOf } from "./said.js";
import { SlicePanel } from "./slice.js";
import { Stage } from "./stage.js";
import { ConfigurationPanel, ToolPanel } from "./tool.js";
import { serve } from "./worker.js";

const STATES = { good: ["regular pose", "good"], near: ["near a singular pose", "warn"], singular: ["singular pose", "bad"] };
/** Ghosts of more solutions would hide the machine. */
const MOST_GHOSTS = 32;
const REMEMBER_AFTER = 120;
const ZOOM = { "+": 0.9, "-": 1 / 0.9 };

class Page {
  constructor() {
    this.data = JSON.parse(document.getElementById("page").textContent);
    this.model = new Model();
    const by = (id) => document.getElementById(id);
    this.parts = Object.fromEntries(["state", "live", "refusal", "canvas", "labels", "panel", "scale", "outside", "move", "turn", "ghosts", "names", "fit", "start"].map((id) => [id, by(id)]));
    this.stage = new Stage(this.parts.canvas, this.parts.labels, {
      onDrag: (frame, isFinished) => (isFinished ? this.#show("pose") : this.model.moveTo(frame)),
      onGhost: (index) => this.model.take(this.ghosts[index].axes),
      onAssembly: () => {
        const { assembly } = this.model.description;
        if (assembly) this.model.setParameter(assembly, !this.model.parameters[assembly]);
      },
      onView: () => this.#remember(),
      onDrawn: (isInside) => { this.parts.outside.hidden = isInside; },
    });
    this.mode = "translate";
    this.ghosts = [];
    this.hasGhosts = true;
    this.#panel();
    this.#theme();
    this.#listen();
    this.model.onChange((what) => this.#show(what));
    const token = tokenOf(location.hash);
    this.isLive = token !== null; // the address stays that of the run
    this.#restore();
    if (!this.model.name) this.model.open(this.data.first);
    if (this.isLive) this.follow(token);
  }

  /** Follow a controller; the state of the connection stands in the head of the page. */
  follow(token, Socket) {
    this.isLive = true;
    this.live = new Live(this.model, token, (words, isGood) => this.#say(words, isGood), this.data.keywords, Socket);
  }

  #say(words, isGood) {
    this.parts.live.textContent = words;
    this.parts.live.className = isGood ? "good" : "bad";
  }

  #panel() {
    const { model, stage } = this;
    this.solutions = new SolutionsPanel(model);
    const dimensions = new DimensionsPanel(model);
    this.poses = new PosesPanel(model, () => this.#otherPoses());
    const first = [this.solutions, new AxesPanel(model), new ToolPanel(model), new MarginsPanel(model), new ConfigurationPanel(model), this.poses, dimensions];
    const line = new LinePanel(model, stage);
    this.line = line;
    this.slice = new SlicePanel(model, stage);
    const rest = [{ element: dimensions.second }, line, this.slice, new CopyPanel(model, this.data)];
    this.parts.panel.append(...[...first, ...rest].map((one) => one.element), this.#about());
  }

  #about() {
    this.summary = element("p", { class: "soft" });
    const licence = element("pre", { class: "soft wrapped" }, this.data.licences);
    const keys = element("p", { class: "soft" }, "Keys: T move, R turn, G ghosts, N names, F fit, 0 start, + and - nearer and farther; in the picture, arrows shift it, with Shift they turn it; in a number, arrows step by 1, with Shift by 10, with Alt by 0.1.");
    this.report = element("a", { id: "report" }, "The derivation of this machine");
    const command = this.model.names.length > 1 ? "make report" : "softkin explain --html";
    const report = element("p", { class: "soft" }, this.report, `, line by line on paper: ${command} writes it beside this page.`);
    const isOnDisk = location.protocol === "file:"; // a server of `softkin live` has this page alone
    return element("details", {}, element("summary", {}, "About"), this.summary, isOnDisk ? report : null, keys, licence);
  }

  #theme() {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const paint = () => this.stage.paint(dark.matches ? "dark" : "light");
    dark.addEventListener("change", paint);
    paint();
  }

  #listen() {
    const { parts, model } = this;
    this.choice = new MachineChoice(model, this.data, (name) => {
      if (!this.isLive) this.#say("", true);
      model.open(name);
    });
    document.querySelector("header h1").after(this.choice.button);
    addEventListener("hashchange", () => location.hash.slice(1) !== this.written && this.#restore());
    const actions = {
      move: () => this.#handle("translate"), turn: () => this.#handle("rotate"),
      ghosts: () => { this.hasGhosts = !this.hasGhosts; this.#press("ghosts", this.hasGhosts); this.#show("pose"); },
      names: () => { parts.labels.hidden = !parts.labels.hidden; this.#press("names", !parts.labels.hidden); this.stage.ask(); },
      fit: () => model.pose.scene.status || this.stage.fit(model.pose.scene), start: () => model.moveAxes(model.start),
    };
    const keys = { t: "move", r: "turn", g: "ghosts", n: "names", f: "fit", 0: "start" };
    parts.outside.addEventListener("click", actions.fit);
    Object.entries(actions).forEach(([name, action]) => parts[name].addEventListener("click", action));
    addEventListener("keydown", (event) => {
      const isTyping = event.target.matches("input, select, textarea, dialog *") || event.ctrlKey || event.metaKey || event.altKey;
      const name = keys[event.key.toLowerCase()];
      if (name && !isTyping && model.pose) actions[name]();
      if (event.key in ZOOM && !isTyping) this.stage.closer(ZOOM[event.key]);
    });
  }

  #press(name, isPressed) {
    this.parts[name].setAttribute("aria-pressed", String(isPressed));
  }

  /** One kind of handles, or none if it is chosen again. */
  #handle(mode) {
    this.mode = this.mode === mode ? "" : mode;
    this.#handles();
  }

  #handles() {
    const { task, readsRotation } = this.model.description;
    this.#press("move", this.mode === "translate");
    this.#press("turn", this.mode === "rotate");
    const isAboutZ = task.turning === "about z";
    const turns = [readsRotation && !isAboutZ, readsRotation && !isAboutZ, readsRotation];
    const free = this.mode === "rotate" ? turns : [..."xyz"].map((name) => task.position.includes(name));
    this.stage.handleAs(this.model.isCommanded && free.some(Boolean) ? this.mode : "", free);
  }

  #restore() {
    const found = readFragment(location.hash, this.model);
    if (!found) return;
    this.#say(found.name ? "" : `unknown machine: ${found.unknown}`, Boolean(found.name));
    if (!found.name) return;
    this.model.open(found.name, found.given);
    if (found.given.view) this.stage.view = found.given.view;
  }

  #show(what) {
    const { model, stage, parts } = this;
    if (what === "refused parameter") return;
    const { pose, refusal } = model;
    if (what === "machine") {
      this.choice.show(model.name);
      document.title = `${model.name}: Softkin`;
      this.report.href = this.data.reports[model.name];
      this.summary.textContent = `${model.description.summary} ${model.description.notes.join(" ")}`;
      this.#meshes();
      this.#handles();
    }
    const isWhole = Boolean(pose) && !pose.scene.status;
    if (isWhole && (what === "machine" || (what === "dimensions" && !stage.view))) stage.fit(pose.scene);
    else if (isWhole && what === "dimensions") stage.measure(pose.scene);
    const said = refusal ?? pose?.beyond ?? (isWhole ? null : pose?.scene);
    stage.figure.group.visible = isWhole;
    parts.scale.textContent = isWhole ? `grid ${Number(stage.ground.step.toPrecision(1))} u` : "";
    if (isWhole) {
      this.refusing = said ? refusing(said.reason, pose.scene.bodies, model.description.margins) : new Set();
      stage.show(pose.scene, refusal ? model.target : null, (body) => this.refusing.has(body), model.joints(pose.axes));
      stage.figure.mark(refusal ? "refused" : stateOf(pose));
    }
    parts.refusal.hidden = !said;
    parts.refusal.textContent = said ? inWords(said) : "";
    this.#state(said);
    this.#others();
    this.#remember();
  }

  #state(said) {
    const { pose } = this.model;
    const [state, kind] = said ? ["refused", "bad"] : STATES[stateOf(pose)];
    const { name } = nearestOf(pose);
    const words = said || kind === "good" || !name ? state : `${state}: ${name.replaceAll("_", " ")}`;
    this.parts.state.textContent = words;
    this.parts.state.className = kind;
    this.parts.canvas.setAttribute("aria-label", `${this.model.name}, ${words}${pose ? `, tool at ${pose.frame.position.map((value) => value.toFixed(1)).join(", ")}` : ""}`);
  }

  /** The other solutions: in the list, and as ghosts. */
  #others() {
    const found = this.model.solutions();
    this.solutions.show(found);
    this.ghosts = this.hasGhosts ? found.filter((slot) => !slot.status && !slot.isPresent).slice(0, MOST_GHOSTS) : [];
    const scenes = this.ghosts.map((slot) => this.model.machine.scene(slot.axes, this.model.pose.frame));
    this.ghosts = this.ghosts.filter((_, i) => !scenes[i].status);
    this.stage.showGhosts(scenes.filter((scene) => !scene.status));
    this.#otherPoses();
  }

  /** Poses at the same axes: the other assembly mode, or those that were found. */
  #otherPoses() {
    const other = this.model.otherAssembly();
    const others = other ? [{ scene: other, text: "other assembly mode" }] : this.poses.shown;
    this.stage.showOthers(this.hasGhosts ? others : []);
  }

  async #meshes() {
    const { data, model, stage } = this;
    if (!data.models.length || !model.pose) return;
    const { machine } = model.module.create(model.nominal);
    stage.replaceBodies(await meshesOf(data.models, machine.scene(model.axes.map(() => 0))));
    if (!stage.view) stage.fit(model.pose.scene);
    this.#show("pose");
  }

  /** The state in the address, at most once in a while: browsers refuse to write it faster. */
  #remember() {
    if (this.isLive || !this.model.pose) return; // the address names the run of the server, and the pose is over in a moment
    clearTimeout(this.remembering);
    this.remembering = setTimeout(() => {
      this.written = fragmentOf(this.model, this.stage.view);
      history.replaceState(null, "", `#${this.written}`);
    }, REMEMBER_AFTER);
  }
}

/** The page, or in a sentence why there is none: a browser without WebGL 2 cannot draw it. */
function started() {
  performance.mark("program");
  try {
    return new Page();
  } catch (error) {
    const place = document.getElementById("refusal");
    place.hidden = false;
    place.textContent = `The viewer could not start: ${error.message}`;
    throw error;
  }
}

if (typeof document === "undefined") serve();
else globalThis.softkinPage = started();
