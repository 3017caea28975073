// usage: node comparison.mjs REPORT.html
// Opens the report of a comparison in headless Chromium: no error on the console, pictures that are drawn, values under
// the pointer, and the ways to hold pictures against each other. Exit status: 0 all good, 1 not, 77 no Chromium here.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const browsers = [process.env.MONTELUX_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const executablePath = browsers.find((path) => path && existsSync(path));
if (!executablePath) {
  console.log("skipped: no Chromium on this machine");
  process.exit(77);
}
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
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(pathToFileURL(resolve(process.argv[2])).href);
  await page.waitForSelector(".comparison canvas");

  const canvases = page.locator(".stage canvas");
  const pixels = (i) => canvases.nth(i).evaluate((canvas) => canvas.toDataURL());
  expect((await canvases.count()) === 3, "the reference and both methods are shown");
  const colors = await canvases.first().evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(Array.from({ length: data.length / 4 }, (_, p) => data.slice(4 * p, 4 * p + 3).join())).size;
  });
  expect(colors > 20, `the reference has colours (${colors})`);
  const plain = await pixels(1);
  expect(plain !== (await pixels(0)), "a method is not the reference");

  const frame = page.locator(".stage .frame").nth(1);
  await frame.scrollIntoViewIfNeeded();
  const box = await frame.boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.6 * box.height);
  const text = await page.locator(".pixel table").textContent();
  expect(/pixel \d+, \d+/.test(text) && /\d ± \d/.test(text), `the pointer reads a pixel with its error bars ("${text}")`);
  expect((await page.locator("canvas.settling").count()) === 1, "and shows how its mean settled");

  await page.locator(".controls button", { hasText: "errors" }).click();
  expect((await pixels(1)) !== plain, "errors are shown in false colours");
  await page.locator(".controls button", { hasText: "errors" }).click();
  expect((await pixels(1)) === plain, "and the picture comes back");
  await page.locator("input[aria-label=exposure]").fill("2");
  expect((await pixels(1)) !== plain, "the exposure can be set");

  await page.locator(".controls button", { hasText: "slider" }).click();
  const clip = () => page.locator(".stage .over .frame").evaluate((element) => element.style.clipPath);
  const before = await clip();
  await page.locator("input[aria-label=line]").fill("0.25");
  expect(before !== (await clip()), "the slider moves the line between two pictures");
  await page.locator(".controls button", { hasText: "flip" }).click();
  const caption = () => page.locator(".stage .caption").first().textContent();
  const first = await caption();
  await page.locator(".stage .frame").first().click();
  expect(first !== (await caption()), "a click flips to the other picture");
  expect(errors.length === 0, `the console is silent (${errors.join("; ")})`);
} finally {
  await context.close();
  rmSync(profile, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
