/**
 * What a user does in the viewer, in one browser; what was seen is written as JSON, and judged in Python.
 *
 * node drive.mjs CATALOGUE_PAGE OWN_PAGE PICTURES RESULT [installed | npm]
 */

import { writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { launched } from "./browser.mjs";
import { isOfTheDriver, settled, state, unfold } from "./shown.mjs";

const [cataloguePage, ownPage, pictures, result, which] = process.argv.slice(2);
const LAPTOP = { width: 1366, height: 768 };
const SMALL = { width: 560, height: 420 };
const TABLET = { width: 820, height: 1180 };
setTimeout(() => process.exit(3), 480_000).unref(); // what waits for the browser in a page has no end of its own
const { browser, name } = await launched(which).catch((error) => {
  writeFileSync(result, JSON.stringify({ missing: error.message }));
  process.exit(0);
});
const seen = { browser: name, errors: [], pictures: { catalogue: [], own: [] } };

/** A page at a fragment; what its console complains of is kept. */
async function opened(fragment, { size = SMALL, theme = "light", file = cataloguePage } = {}) {
  const context = await browser.newContext({ viewport: size, colorScheme: theme, offline: true });
  const page = await context.newPage();
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !isOfTheDriver(message) && seen.errors.push(`${fragment}: ${message.text()}`));
  page.on("pageerror", (error) => seen.errors.push(`${fragment}: ${error}`));
  page.on("request", (request) => /^(file|blob|data):/.test(request.url()) || seen.errors.push(`${fragment} asks for ${request.url()}`));
  await page.goto(`${pathToFileURL(file)}${fragment}`);
  await page.waitForFunction(() => globalThis.softkinPage?.model.pose && globalThis.softkinPage.stage.isDrawn);
  const marks = await page.evaluate(() => performance.getEntriesByType("mark").map((mark) => [mark.name, mark.startTime]));
  seen.pictures[file === ownPage ? "own" : "catalogue"].push(Object.fromEntries(marks));
  return page;
}

/** A picture at a size; what comes before it is drawn smaller, which takes a software renderer less. */
async function pictured(page, size, name, isFitted = true) {
  await page.setViewportSize(size);
  await settled(page);
  if (isFitted) await page.evaluate(() => document.getElementById("fit").click());
  await settled(page);
  await page.screenshot({ path: `${pictures}/${name}.png` });
}

/** Every machine in turn: how many pixels its figure alone covers, and what stands in it. */
async function everyMachine() {
  const page = await opened("");
  seen.machines = await page.evaluate(async () => {
    const { model, stage } = softkinPage;
    const found = {};
    for (const name of model.names) {
      model.open(name);
      stage.draw();
      const labels = [...document.querySelectorAll("#labels span:not([hidden])")].map((one) => {
        const { x, y, width, height } = one.getBoundingClientRect();
        return { text: one.textContent, kind: one.className, x, y, width, height };
      });
      const isOutside = !document.getElementById("outside").hidden;
      const others = [stage.floor, stage.transformed, stage.triad, stage.origin, stage.assembly];
      const were = others.map((one) => one.visible);
      others.forEach((one) => { one.visible = false; });
      stage.showGhosts([]);
      stage.draw();
      const gl = stage.renderer.getContext();
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      let covered = 0;
      for (let i = 3; i < pixels.length; i += 4) covered += pixels[i] > 0;
      others.forEach((one, i) => { one.visible = were[i]; });
      found[name] = {
        covered, labels, isOutside, shapes: stage.figure.shapes, scale: document.getElementById("scale").textContent, refusal: model.refusal, axes: model.axes, frame: model.pose?.frame ?? null, configuration: model.pose?.configuration ?? [],
        parameters: model.parameters, solutions: model.solutions().filter((slot) => !slot.status).length, margins: model.pose?.singularity.margins,
        isLabelled: [...document.querySelectorAll("input, select, button")].every((one) => one.labels?.length || one.ariaLabel || one.getAttribute("aria-labelledby") || one.textContent.trim()),
      };
      if (model.isCommanded) {
        const { position, rotation } = model.pose.frame;
        model.moveTo({ position: position.map((value) => value + 20 * stage.size), rotation });
        found[name].farAway = { reason: model.refusal?.reason ?? null, marked: [...softkinPage.refusing].map((body) => `${body.kind} ${body.name}`) };
      }
      await new Promise(requestAnimationFrame);
    }
    return found;
  });
  seen.times = await page.evaluate(() => {
    const { model, stage } = softkinPage;
    const least = (work, count = 25) => {
      let best = Infinity;
      for (let i = 0; i < count; i += 1) {
        const start = performance.now();
        work(i);
        best = Math.min(best, performance.now() - start);
      }
      return best;
    };
    const found = {};
    for (const name of ["Kin_ArticulatedRobot_6DOF", "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"]) {
      model.open(name);
      const { machine, pose, axes } = model;
      found[name] = {
        frame: least((i) => { model.moveAxes(axes.map((value) => value + 1e-3 * i)); stage.draw(); }),
        all: least(() => { for (let i = 0; i < 50; i += 1) machine.inverseAll(pose.frame, axes); }, 10) / 50,
        ghosts: softkinPage.ghosts.length, isSearched: machine.isSearched,
      };
    }
    return found;
  });
  await page.context().close();
}

/** The tool dragged by the mouse, at the middle of its handles; then the address opened elsewhere. */
async function dragged() {
  const page = await opened("#machine=Kin_ArticulatedRobot_6DOF");
  seen.before = await state(page);
  const [x, y] = await page.evaluate(() => softkinPage.stage.placeOf(softkinPage.model.pose.frame.position));
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 6; i += 1) await page.mouse.move(x + 4 * i, y - 2 * i);
  await page.mouse.up();
  await settled(page);
  seen.dragged = await state(page);
  seen.address = await page.evaluate(() => location.hash);
  const other = await opened(seen.address);
  seen.restored = await state(other);
  await other.locator("#canvas").press("r");
  const [u, v] = await other.evaluate(() => softkinPage.stage.placeOf(softkinPage.model.pose.frame.position));
  await other.mouse.move(u, v);
  await other.mouse.down();
  for (let i = 1; i <= 4; i += 1) await other.mouse.move(u + 3 * i, v + 2 * i);
  await other.mouse.up();
  seen.turned = await state(other);
  await other.context().close();
  await clickGhost(page);
  await lookedAround(page);
  await pictured(page, LAPTOP, "laptop_light");
  await unfold(page);
  seen.report = await page.locator("#report").getAttribute("href");
  const click = (name) => page.locator("#panel").getByRole("button", { name, exact: true }).evaluate((button) => button.click());
  seen.copied = { pose: await state(page) };
  for (const kind of ["Python", "Structured Text", "CSV"]) {
    await click(kind);
    seen.copied[kind] = await page.locator("#panel textarea").inputValue();
  }
  await page.context().close();
}

/** The picture turned by the mouse: the address says from where one looks, until the whole machine is looked at again. */
async function lookedAround(page) {
  const camera = (one) => one.evaluate(() => [...softkinPage.stage.camera.position.toArray(), ...softkinPage.stage.orbit.target.toArray()]);
  const { height } = await page.evaluate(() => document.getElementById("canvas").getBoundingClientRect());
  await settled(page);
  const fitted = await page.evaluate(() => location.hash);
  await page.mouse.move(12, height - 12);
  await page.mouse.down();
  for (let i = 1; i <= 5; i += 1) await page.mouse.move(12 + 12 * i, height - 12 - 5 * i);
  await page.mouse.up();
  await settled(page);
  const turned = await page.evaluate(() => location.hash);
  const other = await opened(turned);
  seen.camera = { fitted, turned, here: await camera(page), there: await camera(other) };
  await other.context().close();
  await page.evaluate(() => document.getElementById("fit").click());
  await settled(page);
  seen.camera.again = await page.evaluate(() => location.hash);
}

/** A click on a ghost in the picture. */
async function clickGhost(page) {
  const places = await page.evaluate(() => {
    const { stage, ghosts, model } = softkinPage;
    return ghosts.flatMap((slot) => model.machine.scene(slot.axes).bodies.slice(1, -1).flatMap((body) => body.lines))
      .map(([start, end]) => stage.placeOf(start.map((value, i) => 0.5 * (value + end[i]))));
  });
  for (const [x, y] of places) {
    await page.mouse.click(x, y);
    const now = await state(page);
    if (now.axes.some((value, i) => Math.abs(value - seen.dragged.axes[i]) > 1)) {
      seen.taken = now;
      return;
    }
  }
}

/** What is typed: a frame out of reach, a dimension that is not allowed and one that is, an axis beyond its limit; keys. */
async function typed() {
  const page = await opened("#machine=Kin_Scara4_ZCcoupled_Type1&axes=20,40,5,30");
  await page.locator("#tool-X").fill("700");
  await settled(page);
  seen.refused = await state(page);
  seen.refusedSlots = await page.evaluate(() => {
    const { open, textContent } = document.querySelector(".refused");
    return { open, textContent, listed: softkinPage.solutions.list.children.length };
  });
  seen.refusedAddress = await page.evaluate(() => location.hash);
  const other = await opened(seen.refusedAddress);
  seen.refusedRestored = await state(other);
  await other.context().close();
  await page.locator("#tool-X").fill("400");
  seen.reached = await state(page);
  await unfold(page);
  const dimension = (label) => page.getByLabel(label, { exact: true });
  await dimension("link length 1").fill("0");
  seen.dimension = await page.evaluate(() => [...document.querySelectorAll(".wrong")].map((one) => one.textContent).filter(Boolean));
  seen.afterWrong = await state(page);
  await dimension("link length 1").fill("300");
  seen.longer = await state(page);
  await dimension("lower a1").fill("-20");
  await dimension("upper a1").fill("25");
  await page.locator("#axis-0").fill("30");
  seen.beyond = await state(page);
  await page.locator("#axis-0").press("ArrowDown");
  await page.locator("#axis-0").press("Shift+ArrowDown");
  seen.stepped = await state(page);
  await page.getByRole("button", { name: "left", exact: true }).evaluate((button) => button.click());
  seen.left = await state(page);
  await dimension("lower a1").fill("28");
  seen.lowerAlone = await page.evaluate(() => [...document.querySelectorAll(".wrong")].map((one) => one.textContent).filter(Boolean));
  await dimension("upper a1").fill("60");
  seen.bothEnds = await state(page);
  await dimension("lower a1").fill("");
  await page.locator("#axis-0").fill("-200");
  seen.openEnd = await state(page);
  seen.endFields = await page.evaluate(() => ["a1", "a2"].map((axis) => ["lower", "upper"].map((end) => [...document.querySelectorAll(".dimension")]
    .find((one) => one.textContent.startsWith(`${end} ${axis}`)).querySelector("input").value)));
  await page.getByRole("button", { name: "Python", exact: true }).evaluate((button) => button.click());
  seen.openEndCopied = await page.locator("#panel textarea").inputValue();
  await settled(page);
  const third = await opened(await page.evaluate(() => location.hash));
  seen.openEndRestored = await state(third);
  await third.context().close();
  await dimension("upper a1").fill("");
  seen.noLimit = await state(page);
  await dimension("upper a1").fill("60");
  seen.upperAlone = await state(page);
  await page.locator("#canvas").press("g");
  seen.withoutGhosts = await state(page);
  const away = () => page.evaluate(() => softkinPage.stage.camera.position.distanceTo(softkinPage.stage.orbit.target));
  seen.away = [await away()];
  await page.locator("#canvas").press("+");
  seen.away.push(await away());
  seen.order = await page.evaluate(() => [...document.querySelectorAll("a, button, select, input, summary, canvas, textarea")]
    .filter((one) => one.tabIndex >= 0 && !one.disabled).map((one) => one.id || one.textContent.trim() || one.ariaLabel));
  await page.context().close();
}

/** A line that crosses the inside of a SCARA, where nothing reaches; then one that is reached. */
async function line() {
  const page = await opened("#machine=Kin_Scara4_ZCcoupled_Type1&axes=10,40,5,30", { theme: "dark" });
  await unfold(page);
  const end = (letter) => page.getByRole("button", { name: `${letter} = this pose` }).evaluate((button) => button.click());
  const to = async (x, y) => {
    await page.locator("#tool-X").fill(String(x));
    await page.locator("#tool-Y").fill(String(y));
    await page.locator("#tool-Y").blur();
  };
  const read = () => page.evaluate(() => ({
    said: document.querySelector(".plots").closest("details").querySelector("p").textContent,
    curves: document.querySelectorAll(".plots .curve").length, stops: document.querySelectorAll(".plots .stop").length,
    singular: document.querySelectorAll(".plots .singular").length, jumps: document.querySelectorAll(".plots .jump").length,
    path: softkinPage.stage.path?.geometry.getAttribute("position").count ?? 0,
  }));
  await to(300, -200);
  await end("A");
  seen.lineFrom = await state(page);
  await to(-300, 10);
  await end("B");
  seen.crossing = await read();
  await to(350, 250);
  await end("B");
  seen.line = await read();
  await page.getByLabel("Place on the line").evaluate((slider) => { slider.value = 0.5; slider.dispatchEvent(new Event("input")); });
  seen.halfway = await state(page);
  await page.getByRole("button", { name: "Play" }).evaluate((button) => button.click());
  await page.waitForTimeout(400);
  await page.getByRole("button", { name: "Pause" }).evaluate((button) => button.click());
  seen.played = await state(page);
  await unfold(page, "^(Axes|Line)");
  await pictured(page, TABLET, "tablet_dark");
  await page.context().close();
}

/** Lines that jump over a singular pose, and that end at a limit. */
async function marks() {
  const drawn = async (fragment, from, to) => {
    const page = await opened(fragment);
    const found = await page.evaluate(([start, end]) => {
      const { model, line } = softkinPage;
      const { rotation } = model.pose.frame;
      [["A", start], ["B", end]].forEach(([letter, position]) => {
        model.moveTo({ position, rotation });
        line.set(letter);
      });
      const count = (kind) => document.querySelectorAll(`.plots ${kind}`).length;
      return { jumps: count(".jump"), singular: count(".singular"), limits: count(".limit"), stops: count(".stop"), said: line.said.textContent };
    }, [from, to]);
    await page.context().close();
    return found;
  };
  seen.jump = await drawn("#machine=Kin_Polar&axes=0,200", [200, 0, 0], [-200, 0, 0]);
  seen.limit = await drawn("#machine=Kin_Scara2_Z&axes=10,40,0&with=lower_a1:-90,upper_a1:40", [400, -100, 0], [0, 430, 0]);
}

/** A slice of the workspace in a worker. */
async function slice() {
  const page = await opened("#machine=Kin_Scara2_Z&axes=20,60,-20", { theme: "dark" });
  await unfold(page, "^(Slice|Singul)");
  const computed = async (what, isFirst) => {
    await page.evaluate(() => { globalThis.last = softkinPage.slice.values; });
    await page.locator("#slice-what").selectOption(what);
    if (isFirst) await page.getByRole("button", { name: "Compute" }).click(); // later another choice is computed by itself
    await page.waitForFunction(() => softkinPage.slice.values !== last && /of the slice is reached/.test(document.getElementById("panel").textContent));
    return page.evaluate(() => {
      const { slice } = softkinPage;
      const parts = slice.parts.map(({ row, column, values }) => ({ row, column, values: [...values] }));
      return { corners: slice.corners, values: slice.values.map((row) => [...row]), parts };
    });
  };
  seen.slice = await computed("number", true);
  seen.slicePose = await state(page);
  seen.margin = await computed("elbow", false);
  await pictured(page, LAPTOP, "laptop_dark");
  await page.context().close();
}

/** The page of one machine, with a mesh of its own in the place of a body. */
async function own() {
  const page = await opened("", { size: TABLET, file: ownPage });
  await page.waitForFunction(() => softkinPage.stage.scene.getObjectByName("own") !== undefined);
  await settled(page);
  seen.own = await page.evaluate(() => ({
    names: softkinPage.model.names, at: softkinPage.stage.scene.getObjectByName("own").getWorldPosition(softkinPage.stage.handle.position.clone()).toArray(),
    body: softkinPage.model.pose.scene.bodies.find((body) => body.name === "A2").frame.position,
    licence: document.documentElement.outerHTML.includes("three.js authors"), report: document.getElementById("report").getAttribute("href"),
  }));
  await page.screenshot({ path: `${pictures}/tablet_light.png` });
  await unfold(page);
  seen.own.pose = await state(page);
  await page.getByRole("button", { name: "Python", exact: true }).evaluate((button) => button.click());
  seen.own.copied = await page.locator("#panel textarea").inputValue();
  await page.locator("#axis-0").fill("149.9");
  seen.own.inside = await state(page);
  await page.locator("#axis-0").fill("200");
  seen.own.beyond = await state(page);
  await page.context().close();
  const other = await opened("#machine=nonsense", { file: ownPage });
  seen.own.unknown = await other.locator("#live").textContent();
  await other.context().close();
}

/** The choice of a machine: families, pictures, a search by each of the names; then the one that is found. */
async function chosen() {
  const page = await opened("", { size: LAPTOP });
  const search = async (words) => {
    await page.locator("#choice input").fill(words);
    return page.evaluate(() => [...document.querySelectorAll("#choice .cards button")].filter((one) => one.checkVisibility()).map((one) => one.childNodes[1].textContent));
  };
  const pictures = () => [...document.querySelectorAll("#choice canvas")].filter((one, i, all) => one.toDataURL() !== all.at(-1).toDataURL()).length; // the last is not in view
  seen.choice = { first: await state(page), sections: await page.locator("#panel > details > summary").allTextContents() };
  await page.locator("#machine").click();
  await page.waitForFunction(pictures);
  await settled(page);
  await pictured(page, LAPTOP, "choice_light", false);
  Object.assign(seen.choice, {
    families: await page.locator("#choice h2").allTextContents(), all: await search(""), pictures: await page.evaluate(pictures),
    byBlock: await search("Softkin_Scara3_Z"), byClass: await search("scara3z "), byWords: await search("six axes"), none: await search("nonsense"),
    said: await page.locator("#choice [role=status]").textContent(),
  });
  await search("Softkin_Scara3_Z");
  await page.locator("#choice input").press("Enter");
  seen.choice.taken = await page.evaluate(() => ({ name: softkinPage.model.name, isOpen: document.getElementById("choice").open, button: document.getElementById("machine").textContent }));
  await page.locator("#machine").click();
  await page.locator("#choice").getByRole("button", { name: "Close" }).click();
  await page.locator("#machine").click();
  await page.locator("#choice .cards button", { hasText: "Kin_Gantry2" }).click();
  seen.choice.clicked = await page.evaluate(() => ({ name: softkinPage.model.name, isOpen: document.getElementById("choice").open }));
  await page.context().close();
}

/** A machine that leaves the picture, by the camera and by an axis: it is brought back by the button that is offered. */
async function left() {
  const page = await opened("#machine=Kin_Gantry3");
  const isOffered = async () => {
    await settled(page);
    return page.locator("#outside").isVisible();
  };
  seen.brought = [await isOffered()];
  for (let i = 0; i < 12; i += 1) await page.locator("#canvas").press("+");
  seen.brought.push(await isOffered());
  await page.locator("#outside").click();
  seen.brought.push(await isOffered());
  await page.locator("#axis-1").fill("4000");
  seen.brought.push(await isOffered());
  await page.locator("#outside").click();
  seen.brought.push(await isOffered());
  await page.context().close();
}

/** The other assembly mode of a delta, seen through, and taken by a click. */
async function assembled() {
  const page = await opened("#machine=Softkin_Delta_C&axes=10,20,30,40", { size: LAPTOP });
  seen.assembly = { before: await state(page), labels: await page.locator("#labels span:not([hidden])").allTextContents() };
  Object.assign(seen.assembly, await page.evaluate(() => {
    const { stage } = softkinPage;
    const { position, rotation } = stage.others[0].scene.bodies.at(-1).frame;
    return { there: position, click: stage.placeOf(position.map((value, i) => value - 0.04 * stage.size * rotation[i][2])) };
  }));
  await page.mouse.click(...seen.assembly.click);
  await settled(page);
  seen.assembly.after = await state(page);
  await page.locator("#ghosts").click();
  seen.assembly.hidden = await page.evaluate(() => !softkinPage.stage.others.length);
  await page.context().close();
}

/** All poses of a hexapod at its axes, found on demand; one alone; gone when it moves; other machines have no such search. */
async function everyPose() {
  const page = await opened("#machine=Kin_Hexapod");
  await page.getByRole("button", { name: "Find all poses" }).click();
  await page.waitForFunction(() => softkinPage.poses.said.textContent.includes(" found, "));
  const others = () => page.evaluate(() => ({
    frames: softkinPage.stage.others.map(({ scene }) => scene.bodies.at(-1).frame), drawn: softkinPage.stage.assembly.children.filter(({ visible }) => visible).length,
  }));
  seen.poses = { ...(await state(page)), said: await page.evaluate(() => softkinPage.poses.said.textContent), all: await others() };
  const entries = page.getByRole("list", { name: "Poses at these axes" }).getByRole("button");
  seen.poses.listed = await entries.allTextContents();
  await entries.nth(2).click();
  seen.poses.alone = await others();
  await page.locator("#axis-0").press("ArrowUp");
  seen.poses.moved = { ...(await others()), isListed: await entries.count() > 0 };
  await page.evaluate(() => softkinPage.model.open("Kin_ArticulatedRobot_6DOF"));
  seen.poses.ofAnArm = await page.getByRole("button", { name: "Find all poses" }).isVisible();
  await page.context().close();
}

/** Machines with tables, their first two turns moved: the directions of the last slide, and of Z of the work, as they are seen. */
async function tilted() {
  const page = await opened("");
  seen.tilted = await page.evaluate(() => Object.fromEntries(["Softkin_TableTable_AC", "Softkin_NutatingTable_BC", "Softkin_HeadTable_AC", "Kin_Gantry3"].map((name) => {
    const { model, stage } = softkinPage;
    model.open(name);
    const slide = () => model.pose.scene.joints.filter(({ kind }) => kind === "slide").at(-1).axis;
    const directions = () => [slide(), [0, 0, 1]].map((axis) => stage.camera.up.clone().set(...axis).transformDirection(stage.world.matrixWorld).toArray());
    const before = directions();
    model.moveAxes(model.axes.map((value, i) => (model.description.axes[i].unit === "deg" ? value + 20 : value)));
    return [name, { before, after: directions() }];
  })));
  await page.context().close();
}

/** A controller, played by a socket that the page is given: its machine, axes that move it, axes that must not. */
async function live() {
  const page = await opened("#machine=Kin_Gantry2");
  await page.evaluate(() => {
    softkinPage.follow("abc", class {
      constructor(address, protocols) {
        globalThis.asked = { address, protocols };
        globalThis.send = (message) => this.onmessage({ data: JSON.stringify(message) });
        globalThis.lose = () => this.onclose();
      }
    });
    send({ type: "machine", protocol: 1, name: "Kin_Scara4_ZCcoupled_Type1", source: { kind: "OPC UA" },
      machine: { mechanism: "Kin_Scara4_ZCcoupled_Type1", link_length_1: 300, link_length_2: 200,
        limits: { A1: [-170, 170], A2: null, A3: [null, 0], A4: [-300, null] } } });
  });
  const told = (axes, quality) => page.evaluate(([values, words]) => {
    send({ type: "axes", status: "live", message: "", complete: values.every((value) => value !== null), axes: values, quality: words, reasons: values.map(() => "") });
    return document.getElementById("live").textContent;
  }, [axes, quality]);
  const good = ["good", "good", "good", "good"];
  const before = await page.evaluate(() => softkinPage.model.pose.scene.bodies.map((body) => body.frame));
  seen.liveWords = [await told([10, 20, -30, 40], good)];
  seen.live = await state(page);
  const after = await page.evaluate(() => softkinPage.model.pose.scene.bodies.map((body) => body.frame));
  seen.liveBodies = { before, after };
  seen.liveWords.push(await told([50, null, -30, 40], ["good", "bad", "good", "good"]));
  seen.liveKept = await state(page);
  seen.liveAsked = await page.evaluate(() => asked);
  seen.liveUnknown = await page.evaluate(() => {
    send({ type: "machine", protocol: 1, name: "Kin_Gantry2", source: { kind: "OPC UA" }, machine: { mechanism: "Kin_Gantry2", tool: 7 } });
    return document.getElementById("live").textContent;
  });
  seen.liveWords.push(await told([1, 2], ["good", "good"]));
  seen.liveNotMoved = await state(page);
  seen.liveMounted = await page.evaluate(() => {
    const bare = { mechanism: "Kin_Gantry2", limits: { X: [-1, 99], Y: null } };
    send({ type: "machine", protocol: 1, name: "Kin_Gantry2", source: { kind: "OPC UA" }, machine: { mechanism: "Mounted", bare, base: 1, tool: 2 } });
    const said = document.getElementById("live").textContent;
    send({ type: "axes", status: "live", message: "", complete: true, axes: [3, 4], quality: ["good", "good"], reasons: ["", ""] });
    return { said, name: softkinPage.model.name, axes: softkinPage.model.axes, upper: softkinPage.model.machine.limits[0].upper };
  });
  await page.evaluate(() => lose());
  seen.liveWords.push(await page.locator("#live").textContent());
  await page.context().close();
}

/** The page of one machine again, at another time: how soon its picture is there depends on what else the machine does. */
async function ownAgain() {
  const page = await opened("", { file: ownPage });
  await page.context().close();
}

for (const work of [live, ownAgain, chosen, left, assembled, everyPose, tilted, everyMachine, dragged, ownAgain, typed, line, ownAgain, marks, slice, own]) {
  try {
    await work();
  } catch (error) {
    seen.errors.push(`${work.name}: ${error.stack}`);
  }
}
await browser.close();
writeFileSync(result, JSON.stringify(seen));
