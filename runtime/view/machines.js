/** The choice of a machine: all of them by families, each with its picture, found by any of its names. */

import { PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { lights, lookAt } from "./camera.js";
import { element } from "./element.js";
import { COLOURS, Figure } from "./figure.js";
import { created } from "./limits.js";
import { catalogue } from "./machines/index.js";
import { extentOf, stand } from "./space.js";
import { nominalOf, startOf } from "./start.js";

const PICTURE = { width: 144, height: 104 };

export class MachineChoice {
  #cards = [];
  #renderer = null;

  /** model; data: `classes` and `families` by the names of machines; open(name) shows a machine. */
  constructor(model, data, open) {
    this.search = element("input", { type: "search", "aria-label": "Search a machine by its name, or by a word", placeholder: "Search",
      input: () => this.#find(), keydown: (event) => this.#entered(event) });
    this.none = element("p", { role: "status", class: "soft" });
    this.dialog = element("dialog", { id: "choice", "aria-label": "Machines" },
      element("div", { class: "row" }, this.search, element("button", { click: () => this.dialog.close() }, "Close")), this.none);
    this.button = element("button", { id: "machine", "aria-haspopup": "dialog", title: "Choose a machine", disabled: model.names.length < 2, click: () => this.#open() });
    const families = {};
    for (const name of model.names) (families[data.families[name] ?? ""] ??= []).push(name);
    this.groups = Object.entries(families).sort(([one], [other]) => (one < other ? -1 : 1)).map(([family, names]) => {
      const cards = names.map((name) => this.#card(name, model.describe(name), data.classes[name] ?? "", () => open(name)));
      const group = element("section", {}, element("h2", {}, family.replaceAll("_", " ")), element("div", { class: "cards" }, ...cards.map((card) => card.element)));
      this.#cards.push(...cards);
      return { element: group, cards };
    });
    this.dialog.append(...this.groups.map((group) => group.element));
    document.body.append(this.dialog);
    this.seen = new IntersectionObserver((entries) => entries.filter((one) => one.isIntersecting).forEach(({ target }) => {
      this.seen.unobserve(target);
      requestAnimationFrame(() => this.#draw(this.#cards.find((card) => card.picture === target)));
    }), { root: this.dialog });
  }

  /** The machine that is shown. */
  show(name) {
    this.button.textContent = name;
    for (const card of this.#cards) card.element.setAttribute("aria-current", String(card.name === name));
  }

  #card(name, { block, summary }, own, open) {
    const picture = element("canvas", { ...PICTURE, "aria-hidden": "true" });
    const others = [...new Set([block, own])].filter((one) => one && one !== name);
    const take = () => {
      this.dialog.close();
      open();
    };
    const button = element("button", { title: summary, click: take }, picture, name, element("small", {}, others.join(", ")));
    return { name, picture, element: button, words: [name, ...others, summary].join(" ").toLowerCase() };
  }

  #open() {
    this.search.value = "";
    this.#find();
    this.dialog.showModal();
    for (const card of this.#cards.filter((one) => !one.isDrawn)) this.seen.observe(card.picture);
    this.dialog.querySelector('[aria-current="true"]')?.scrollIntoView({ block: "center" });
  }

  /** Enter takes the first that is found; it is not a press of the button that has the focus then. */
  #entered(event) {
    if (event.key !== "Enter") return;
    event.preventDefault();
    this.#cards.find((card) => !card.element.hidden)?.element.click();
  }

  /** Every word that is typed stands in the names or in the summary. */
  #find() {
    const words = this.search.value.toLowerCase().split(/\s+/);
    for (const card of this.#cards) card.element.hidden = !words.every((word) => card.words.includes(word));
    for (const { element: group, cards } of this.groups) group.hidden = cards.every((card) => card.element.hidden);
    this.none.textContent = this.groups.every((group) => group.element.hidden) ? "No machine has such a name." : "";
  }

  /** The machine where it stands at first, drawn once. */
  #draw(card) {
    card.isDrawn = true;
    const module = catalogue[card.name];
    const { machine } = created(module, nominalOf(module.description));
    const axes = startOf(machine);
    const found = machine.forward(axes);
    const scene = found.status ? found : machine.scene(axes, found.frame);
    if (scene.status) return;
    if (!this.#renderer) {
      this.#renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
      this.#renderer.setSize(PICTURE.width, PICTURE.height);
      this.scene = new Scene().add(...lights());
      this.camera = new PerspectiveCamera(38, PICTURE.width / PICTURE.height, 1, 1e5);
      this.figure = new Figure({ colours: COLOURS[matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"] });
      this.scene.add(this.figure.group);
    }
    stand(this.figure.group, scene);
    const extent = extentOf(scene, this.figure.group);
    this.figure.show(scene, extent.size);
    lookAt(this.camera, extent);
    this.#renderer.render(this.scene, this.camera);
    card.picture.getContext("2d").drawImage(this.#renderer.domElement, 0, 0, PICTURE.width, PICTURE.height);
  }
}
