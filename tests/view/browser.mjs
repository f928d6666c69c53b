/** A real browser without a window: one that the machine has, else the one that npm brings with the libraries it needs. */

import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const INSTALLED = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const FLAGS = [
  "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--force-color-profile=srgb",
];

/** The browser, and what it is called. which: "installed", "npm", or nothing for the first that can be started. */
export async function launched(which) {
  const installed = which === "npm" ? [] : INSTALLED.filter((path) => existsSync(path));
  const all = which === "installed" ? installed : [...installed, null];
  let problem = new Error("no browser is installed");
  for (const path of all) {
    try {
      const browser = await chromium.launch({ executablePath: path ?? (await unpacked()), args: FLAGS, headless: true });
      return { browser, name: `Chromium ${browser.version()} (${path ?? "from npm"})` };
    } catch (error) {
      problem = error; // a command of that name may only tell how to install a browser
    }
  }
  throw problem;
}

/** The browser of @sparticuz/chromium: the package carries the libraries, too, and unpacks them where it says so. */
async function unpacked() {
  process.env.AWS_EXECUTION_ENV ??= "AWS_Lambda_nodejs22.x"; // by this name the package knows that libraries are wanted
  const { default: packed } = await import("@sparticuz/chromium");
  packed.setGraphicsMode = true;
  return packed.executablePath();
}
