/** An imported robot with its meshes. Arguments: the page, axis values as JSON, the folder of pictures, the file of the answer. */

import { writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { launched } from "./browser.mjs";
import { isOfTheDriver, settled } from "./shown.mjs";

const SIZES = { phone: [390, 844], tablet: [820, 1180], desktop: [1366, 768] };
const [file, rows, pictures, answer] = process.argv.slice(2);
const { browser } = await launched();
const seen = { errors: [], inside: {} };

/** What is shown of the meshes: by body the colours, the corners of a box around them, and whether its own shape is gone. */
function shown() {
  const { stage } = softkinPage;
  const found = {};
  stage.world.updateMatrixWorld(true);
  for (const holder of stage.world.children.filter((one) => one.userData.body)) {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    const colours = [];
    holder.traverse((one) => {
      if (!one.isMesh) return;
      colours.push(one.material.color.getHex());
      const places = one.geometry.getAttribute("position");
      for (let i = 0; i < places.count; i += 1) {
        const point = one.position.clone().fromBufferAttribute(places, i).applyMatrix4(one.matrixWorld).toArray();
        point.forEach((value, k) => { low[k] = Math.min(low[k], value); high[k] = Math.max(high[k], value); });
      }
    });
    found[holder.userData.body] = { low, high, colours };
  }
  return found;
}

for (const theme of ["light", "dark"]) {
  for (const [name, [width, height]] of Object.entries(SIZES)) {
    const page = await browser.newPage({ viewport: { width, height }, colorScheme: theme, offline: true });
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && !isOfTheDriver(message) && seen.errors.push(message.text()));
    page.on("pageerror", (error) => seen.errors.push(error.message));
    page.on("request", (request) => /^https?:/.test(request.url()) && seen.errors.push(request.url()));
    await page.goto(pathToFileURL(file).href);
    await page.waitForFunction(() => globalThis.softkinPage?.stage.world.children.some((one) => one.userData.body));
    await settled(page);
    await page.screenshot({ path: `${pictures}/meshes_${name}_${theme}.png` });
    seen.inside[`${name} ${theme}`] = await page.evaluate(() => document.getElementById("outside").hidden);
    if (theme === "light" && name === "desktop") {
      seen.poses = [];
      for (const axes of JSON.parse(rows)) {
        await page.evaluate((values) => softkinPage.model.moveAxes(values), axes);
        seen.poses.push(await page.evaluate(shown));
      }
      await page.evaluate(() => { const { model } = softkinPage; model.moveTo({ ...model.pose.frame, position: [9e4, 0, 0] }); });
      seen.refused = await page.evaluate(shown);
    }
    await page.close();
  }
}
writeFileSync(answer, JSON.stringify(seen));
await browser.close();
