/** What a page shows, and what it is asked to show. */

/** Reading pixels back makes the software renderer complain of its speed; the viewer itself reads none. */
export function isOfTheDriver(message) {
  return /GPU stall due to ReadPixels|GL Driver Message/.test(message.text());
}

/** What the page shows and knows of its pose. */
export function state(page) {
  return page.evaluate(() => {
    const { model } = softkinPage;
    const value = (id) => document.getElementById(id).value;
    const parameters = { ...model.parameters };
    const limits = {};
    for (const { name, lower, upper } of model.description.limits) {
      const pair = [lower, upper].map((end) => (Number.isFinite(parameters[end]) ? parameters[end] : null));
      if (!pair.includes(null)) continue;
      limits[name] = pair; // JSON has no infinite numbers
      [lower, upper].forEach((end) => delete parameters[end]);
    }
    return {
      machine: model.name, parameters, limits, axes: model.axes, frame: model.pose.frame, configuration: model.pose.configuration,
      branches: model.branches(), state: document.getElementById("state").textContent, margins: model.pose.singularity.margins,
      shownAxes: model.description.axes.map((_, i) => value(`axis-${i}`)), shownTool: [..."XYZABC"].map((letter) => value(`tool-${letter}`)),
      refusal: document.getElementById("refusal").hidden ? null : document.getElementById("refusal").textContent,
      isMarked: softkinPage.stage.figure.group.children.some((mesh) => mesh.visible && mesh.material === softkinPage.stage.figure.materials.refused),
      ghosts: softkinPage.ghosts.map((slot) => slot.axes),
    };
  });
}

/** Open these sections of the panel, or all. */
export function unfold(page, names = "") {
  return page.evaluate((pattern) => document.querySelectorAll("details").forEach((one) => {
    one.open = new RegExp(pattern).test(one.querySelector("summary").textContent);
  }), names);
}

/** Wait until what has changed is drawn, and written into the address. */
export async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.waitForTimeout(150); // the address is written after 120 ms
}
