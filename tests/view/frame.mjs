/** What the viewer shows in the frame of a notebook. Arguments: the page around the frame, the file of the answer. */

import { writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { launched } from "./browser.mjs";
import { isOfTheDriver, settled, state } from "./shown.mjs";

const [page, answer] = process.argv.slice(2);
const { browser } = await launched();
const window = await browser.newPage();
const errors = [];
window.on("console", (message) => message.type() === "error" && !isOfTheDriver(message) && errors.push(message.text()));
window.on("pageerror", (error) => errors.push(error.message));
window.on("request", (request) => /^https?:/.test(request.url()) && errors.push(request.url()));
await window.goto(pathToFileURL(page).href);
const frame = window.frames()[1];
await frame.waitForFunction(() => globalThis.softkinPage?.model.pose);
await settled(frame);
writeFileSync(answer, JSON.stringify({ ...(await state(frame)), errors }));
await browser.close();
