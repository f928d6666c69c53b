/** A real browser without a window: one that the machine has, else the one that npm brings with the libraries it needs. */

import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const INSTALLED = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const FLAGS = [
  "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--force-color-profile=srgb",
];

/** The browser, and what it is called. which: "installed", "npm", or nothing for the first that is there. */
export async function launched(which) {
  const installed = which === "npm" ? undefined : INSTALLED.find((path) => existsSync(path));
  if (which === "installed" && !installed) throw new Error("no browser is installed");
  const executablePath = installed ?? (await unpacked());
  const browser = await chromium.launch({ executablePath, args: FLAGS, headless: true });
  return { browser, name: `Chromium ${browser.version()} (${installed ?? "from npm"})` };
}

/** The browser of @sparticuz/chromium: the package carries the libraries, too, and unpacks them where it says so. */
async function unpacked() {
  process.env.AWS_EXECUTION_ENV ??= "AWS_Lambda_nodejs22.x"; // by this name the package knows that libraries are wanted
  const { default: packed } = await import("@sparticuz/chromium");
  packed.setGraphicsMode = true;
  return packed.executablePath();
}
