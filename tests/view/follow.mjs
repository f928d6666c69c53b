/**
 * A page that follows a controller: what it shows, as a line of JSON for each line of input, until the input ends.
 *
 * node follow.mjs ADDRESS
 */

import { createInterface } from "node:readline";
import { launched } from "./browser.mjs";

const { browser } = await launched();
const page = await browser.newPage({ viewport: { width: 900, height: 600 } });
const errors = [];
page.on("pageerror", (error) => errors.push(String(error)));
await page.goto(process.argv[2]);
await page.waitForFunction(() => globalThis.softkinPage?.stage.isDrawn);

for await (const line of createInterface({ input: process.stdin })) {
  const shown = await page.evaluate(() => {
    const { model } = softkinPage;
    return {
      machine: model.name, axes: model.axes, frame: model.pose.frame, limits: model.machine.limits,
      bodies: Object.fromEntries(model.pose.scene.bodies.map((body) => [body.name, body.frame])),
      said: document.getElementById("live").textContent, fields: model.description.axes.map((_, i) => document.getElementById(`axis-${i}`).value),
    };
  });
  process.stdout.write(`${JSON.stringify({ ...shown, asked: line, errors })}\n`);
}
await browser.close();
