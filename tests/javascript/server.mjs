// Answers questions, a line of JSON each: makes machines of a module, and calls their methods; `words` is a refusal in a
// sentence.
// A number that is not finite stands as {"$": "NaN"}, undefined as {"$": "undefined"}.
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

function decoded(value) {
  if (Array.isArray(value)) return value.map(decoded);
  if (value === null || typeof value !== "object") return value;
  if ("$" in value) return value.$ === "undefined" ? undefined : Number(value.$);
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, decoded(part)]));
}

function encoded(key, value) {
  return typeof value === "number" && !Number.isFinite(value) ? { $: String(value) } : value;
}

function answered(module, runtime, { parameters, limits, calls }) {
  const said = (result) => (result?.status ? { ...result, words: runtime.inWords(result) } : result);
  const told = (result) => (result?.slots ? { ...result, slots: result.slots.map(said) } : said(result));
  const { machine, ...made } = module.create(decoded(parameters), decoded(limits));
  const found = calls.map(([name, ...given]) => told(machine?.[name](...given.map(decoded)) ?? null));
  return { made, found, limits: machine?.limits, isSearched: machine?.isSearched };
}

async function answer({ module, machines, script }) {
  const loaded = await import(pathToFileURL(module).href);
  if (script) return new Function("module", `"use strict"; ${script}`)(loaded);
  const runtime = await import(new URL("softkin/softkin.js", pathToFileURL(module)).href);
  return { description: loaded.description, answers: machines.map((one) => answered(loaded, runtime, one)) };
}

for await (const line of createInterface({ input: process.stdin })) {
  let found;
  try {
    found = await answer(JSON.parse(line));
  } catch (error) {
    found = { error: error.stack };
  }
  process.stdout.write(`${JSON.stringify(found, encoded)}\n`);
}
