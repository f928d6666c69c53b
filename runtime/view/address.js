/** The state as the fragment of the address: a pose that can be sent to a colleague. */

import { frameOf, numbersOf } from "./pose.js";

/**
 * The fragment of a model: machine, parameters that differ from the nominal ones, axes, a frame that was refused.
 *
 * view: from where one looks, and at what, six numbers; null if one looks at the whole machine.
 */
export function fragmentOf(model, view = null) {
  const parts = [`machine=${encodeURIComponent(model.name)}`, `axes=${(model.pose?.axes ?? model.axes).join()}`];
  const changed = Object.entries(model.parameters).filter(([name, value]) => Number(value) !== Number(model.nominal[name]));
  if (changed.length) parts.push(`with=${changed.map(([name, value]) => `${encodeURIComponent(name)}:${Number(value)}`).join()}`);
  if (model.automatic.size) parts.push(`automatic=${[...model.automatic].sort().join()}`);
  if (model.refusal && model.target) parts.push(`target=${numbersOf(model.target).join()}`);
  if (view) parts.push(`view=${view.map((value) => Number(value.toPrecision(5))).join()}`);
  return parts.join("&");
}

/**
 * What a fragment says: the name of a machine, that of its mechanism or of its block, and what is given of it. Anything
 * else that is wrong in it is left out. null if it names none; `unknown` is a name that no machine has.
 */
export function readFragment(fragment, model) {
  const parts = new Map(fragment.replace(/^#/, "").split("&").map((part) => part.split(/=(.*)/s)));
  if (!parts.has("machine")) return null;
  const unknown = decoded(parts.get("machine"));
  const name = [unknown, ...model.names.filter((one) => model.describe(one).block === unknown)].find((one) => model.names.includes(one));
  if (name === undefined) return { unknown };
  const given = { axes: numbersIn(parts.get("axes")) ?? undefined };
  const target = numbersIn(parts.get("target"));
  if (target?.length === 6) given.target = frameOf(target);
  const parameters = (parts.get("with") ?? "").split(",").filter(Boolean).map((pair) => pair.split(":"));
  const valid = parameters.filter(([, value]) => value && !Number.isNaN(Number(value)));
  given.parameters = Object.fromEntries(valid.map(([key, value]) => [decoded(key), Number(value)]));
  const view = numbersIn(parts.get("view"));
  if (view?.length === 6) given.view = view;
  given.automatic = numbersIn(parts.get("automatic")) ?? [];
  return { name, given };
}

function numbersIn(text) {
  if (text === undefined || text === "") return null;
  const found = text.split(",").map(Number);
  return found.every(Number.isFinite) ? found : null;
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return "";
  }
}
