/**
 * What is shown: a machine with its parameters, its axes, the frame that is wanted, and what the machine says about it.
 *
 * Every number comes from the module of the machine. Whoever shows something asks to be told of changes.
 */

import { changesWith, created } from "./limits.js";
import { catalogue, inWords } from "./machines/index.js";
import { nominalOf, startOf } from "./start.js";

const SAME = 1e-6;

export class Model {
  #heard = [];
  #other = null;

  /** All names of machines, in the order of the catalogue. */
  names = Object.keys(catalogue);

  onChange(listener) {
    this.#heard.push(listener);
  }

  /** What is known of a machine without its parameters. */
  describe(name) {
    return catalogue[name].description;
  }

  /** Show a machine. given: {parameters, axes, target, automatic}, each may be left out. */
  open(name, given = {}) {
    this.name = name;
    this.module = catalogue[name];
    this.description = this.module.description;
    this.nominal = nominalOf(this.description);
    this.automatic = new Set(given.automatic ?? []);
    this.wrong = null;
    const parameters = { ...this.nominal, ...given.parameters };
    const made = created(this.module, parameters);
    this.parameters = made.status ? { ...this.nominal } : parameters;
    this.machine = made.status ? this.module.create(this.nominal).machine : made.machine;
    if (made.status) this.wrong = { names: made.parameters, words: inWords(made), values: {} };
    this.start = startOf(this.machine);
    const count = this.description.axes.length;
    this.axes = given.axes?.length === count ? given.axes : this.start;
    this.pose = null;
    this.refusal = null;
    this.target = null;
    this.#stand(this.axes);
    if (given.target) this.aim(given.target);
    this.#tell("machine");
  }

  /** Whether the tool can be commanded at all. */
  get isCommanded() {
    return this.description.axes.length > 0;
  }

  /** Move the axes. If the machine has no pose there, it is drawn in its last one, and the reason is shown. */
  moveAxes(axes) {
    this.#stand(axes);
    this.#tell("pose");
  }

  /** Ask for a frame on the branches of the present pose, or on those that `bytes` name. */
  moveTo(target, bytes = this.branches()) {
    this.aim(target, bytes);
    this.#tell("pose");
  }

  aim(target, bytes = this.branches()) {
    this.target = target;
    const found = this.machine.inverse(target, bytes, this.axes);
    if (found.status) this.refusal = found;
    else this.#stand(found.axes, target);
  }

  /** Stand at axes that are known to be an answer for a frame, by default for the one that is wanted. */
  take(axes, target = this.target) {
    this.#stand(axes, target);
    this.#tell("pose");
  }

  /**
   * Another value of a parameter. A value that the machine refuses is kept beside the machine as it was, and tried
   * again with the next: the two ends of a range may be allowed together alone. null: the end of a limit is open.
   */
  setParameter(name, value) {
    const known = this.wrong?.values ?? {};
    const values = { ...known, ...changesWith(this.description, { ...this.parameters, ...known }, name, value) };
    const alone = changesWith(this.description, this.parameters, name, value);
    const tried = [values, alone].map((some) => ({ ...this.parameters, ...some }));
    const made = tried.map((parameters) => created(this.module, parameters));
    const place = made.findIndex(({ status }) => !status);
    if (place < 0) {
      this.wrong = { names: [name, ...made[1].parameters], words: inWords(made[1]), values };
      this.#tell("refused parameter");
      return;
    }
    this.wrong = null;
    this.parameters = tried[place];
    this.machine = made[place].machine;
    this.pose = null;
    this.#stand(this.axes);
    if (!this.pose) {
      const refused = this.refusal;
      this.#stand(startOf(this.machine));
      this.refusal = this.pose ? null : refused;
    }
    this.#tell("dimensions");
  }

  /** The bytes that keep the branches of the present pose; turns are open, and so are automatic branches. */
  branches() {
    const bytes = this.pose?.configuration ?? this.description.defaultConfiguration;
    const { branchCount } = this.description;
    return bytes.map((byte, i) => (i >= branchCount || this.automatic.has(i) || byte === 3 ? 0 : byte));
  }

  /** All slots at the frame that is wanted, and whether each is the pose that is shown. */
  solutions() {
    if (!this.pose || !this.isCommanded) return [];
    const found = this.machine.inverseAll(this.target ?? this.pose.frame, this.axes);
    if (found.status) return [{ ...found, configuration: [], words: inWords(found), isPresent: false }];
    const { branchCount } = this.description;
    const known = [];
    for (const slot of found.slots) {
      const branches = slot.configuration.slice(0, branchCount);
      if (slot.status) {
        known.push({ ...slot, branches, words: inWords(slot), isPresent: false });
        continue;
      }
      for (const axes of [slot.axes, ...slot.others]) {
        if (known.some((one) => !one.status && this.#areSame(one.axes, axes))) continue;
        const isPresent = !this.refusal && this.#areSame(axes, this.axes);
        known.push({ ...slot, branches, axes, isPresent });
      }
    }
    return known;
  }

  /** The machine at the same axes in the other assembly mode, as a scene; null where it has no other, or no pose there. */
  otherAssembly() {
    const { assembly } = this.description;
    if (!assembly || !this.pose) return null;
    if (this.#other?.of !== this.machine) {
      this.#other = { of: this.machine, ...created(this.module, { ...this.parameters, [assembly]: !this.parameters[assembly] }) };
    }
    const { machine } = this.#other;
    const found = machine?.forward(this.pose.axes);
    const scene = found && !found.status ? machine.scene(this.pose.axes, found.frame) : null;
    return scene && !scene.status ? scene : null;
  }

  /** Axis values in radians and lengths. */
  joints(axes) {
    return axes.map((value, i) => (this.description.axes[i].unit === "deg" ? (value * Math.PI) / 180 : value));
  }

  /** What a slot is called: the names of its branches. */
  nameOf(branches) {
    const words = branches.map((byte, i) => {
      const { name, branches: names } = this.description.configuration[i];
      return `${name.replaceAll("_", " ")} ${byte === 1 || byte === 2 ? names[byte - 1] : byte === 3 ? "where both meet" : "automatic"}`;
    });
    return words.join(", ") || "the one solution";
  }

  #areSame(one, other) {
    return one.every((value, i) => {
      const { period } = this.description.axes[i];
      const away = Math.abs(value - other[i]);
      return Math.min(away, period ? Math.abs(away - period * Math.round(away / period)) : away) < SAME * (1 + Math.abs(value));
    });
  }

  /** Stand at axis values; without a pose there the last one stays drawn. */
  #stand(axes, wanted = null) {
    this.axes = axes;
    const found = this.machine.forward(axes, this.#near());
    if (found.status) {
      this.refusal = found;
      return;
    }
    const scene = this.machine.scene(axes, found.frame);
    const limited = this.machine.limited(axes);
    this.pose = {
      ...found, axes, scene, limited, singularity: this.machine.singularity(axes, found.frame),
      beyond: limited.status ? limited : limited.beyond,
    };
    this.target = wanted;
    this.refusal = null;
  }

  /** Where a search for the frame begins: at the last pose, which is nearby. */
  #near() {
    return this.pose?.frame;
  }

  #tell(what) {
    this.#heard.forEach((listener) => listener(what));
  }
}

export { inWords };
