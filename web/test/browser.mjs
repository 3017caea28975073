// A page in headless Chromium, and claims about it. Without Chromium the program ends with status 77.
import { existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const browsers = [process.env.MONTELUX_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

// Opens a report and calls examine({ page, expect, shot, ground }); then it is held to a silent console and to no request to
// a network. `expect(good, claim)` states a claim; `shot(name)` keeps a picture where a folder for them is given. The
// program ends with 0 where all claims hold, else with 1.
export async function examineReport(report, shots, examine) {
  const executablePath = browsers.find((path) => path && existsSync(path));
  if (!executablePath) {
    console.log("skipped: no Chromium on this machine");
    process.exit(77);
  }
  if (shots) mkdirSync(shots, { recursive: true });
  let failed = false;
  const expect = (good, claim) => {
    console.log(`${good ? "ok  " : "FAIL"} ${claim}`);
    failed ||= !good;
  };
  const profile = mkdtempSync(join(tmpdir(), "montelux-page-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath,
    headless: true,
    viewport: { width: 1280, height: 900 },
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--disable-extensions"],
  });
  try {
    const page = context.pages()[0] ?? (await context.newPage());
    const errors = [];
    const requests = [];
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("request", (request) => /^https?:|^wss?:/.test(request.url()) && requests.push(request.url()));
    const shot = (name, options = {}) => shots && page.screenshot({ path: join(shots, `${name}.png`), ...options });
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.emulateMedia({ colorScheme: "light" });
    await page.goto(pathToFileURL(resolve(report)).href);
    await page.waitForSelector("article h2");
    await examine({ page, expect, shot, ground });
    expect(errors.length === 0, `nothing on the console ${errors.slice(0, 3).join("; ")}`);
    expect(requests.length === 0, `no request to a network ${requests.slice(0, 3).join("; ")}`);
  } finally {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  }
  process.exit(failed ? 1 : 0);
}

// How many colours a canvas shows: a blank one shows one at most.
export const drawnColors = (canvas) =>
  canvas.evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    const colors = new Set();
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200) colors.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    return colors.size;
  });
export const pixels = (canvas) => canvas.evaluate((element) => element.toDataURL());
