// A page in headless Chromium, and claims about it. Without Chromium the program ends with status 77.
import { existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const browsers = [process.env.MONTELUX_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

// The path of the browser; undefined: there is none.
export const findBrowser = () => browsers.find((path) => path && existsSync(path));

// Opens a report and calls examine({ page, expect, shot, ground }); then it is held to a silent console and to no request to
// a network. `expect(good, claim)` states a claim; `shot(name)` keeps a picture where a folder for them is given. The
// program ends with 0 where all claims hold, else with 1.
export async function examineReport(report, shots, examine) {
  const executablePath = findBrowser();
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

// ---- dragging -------------------------------------------------------------------------------------------------------

// From one place of an element to another, in parts of its width and height, by a mouse.
export async function dragByMouse(page, element, from, to) {
  const box = await element.boundingBox();
  const at = ([u, v]) => [box.x + u * box.width, box.y + v * box.height];
  await page.mouse.move(...at(from));
  await page.mouse.down();
  await page.mouse.move(...at(to), { steps: 6 });
  await page.mouse.up();
}

// The same by a finger, as the browser gets it from a touch screen: what the page does not claim scrolls the page.
export async function dragByTouch(page, element, from, to) {
  const box = await element.boundingBox();
  const session = await page.context().newCDPSession(page);
  await session.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  const send = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  const at = (t) => ({
    x: box.x + (from[0] + t * (to[0] - from[0])) * box.width,
    y: box.y + (from[1] + t * (to[1] - from[1])) * box.height,
  });
  await send("touchStart", [at(0)]);
  for (let i = 1; i <= 8; ++i) await send("touchMove", [at(i / 8)]);
  await send("touchEnd", []);
  await session.send("Emulation.setTouchEmulationEnabled", { enabled: false });
  await session.detach();
}

// A slider between two pictures: it stays under a pointer that only passes, follows a drag by mouse and by touch, and moves
// by keys. `viewer` shows it.
export async function examineSlider({ page, expect, shot }, viewer) {
  const stage = viewer.locator(".stage .frame");
  const at = async () => {
    const clip = await viewer.locator(".curtain").evaluate((element) => element.style.clipPath);
    return 100 - Number(/inset\(0(?:px)? ([\d.]+)%/.exec(clip)?.[1]);
  };
  const near = (value, wanted) => Math.abs(value - wanted) < 2;
  await stage.scrollIntoViewIfNeeded();
  const before = await at();
  await stage.hover({ position: { x: 30, y: 40 } });
  expect(near(await at(), before), `the line stays where it is under a pointer that passes (${await at()})`);
  await dragByMouse(page, stage, [before / 100, 0.5], [0.25, 0.5]);
  expect(near(await at(), 25), `a mouse drags the line by its handle (${await at()})`);
  await dragByMouse(page, stage, [0.6, 0.2], [0.7, 0.2]);
  expect(near(await at(), 70), `and from anywhere in the picture (${await at()})`);
  await dragByTouch(page, stage, [0.7, 0.5], [0.2, 0.5]);
  expect(near(await at(), 20), `a finger drags it (${await at()})`);
  const line = viewer.locator(".divider");
  await line.press("ArrowRight");
  await line.press("Shift+ArrowRight");
  expect(near(await at(), 32), `arrow keys move it (${await at()})`);
  expect((await line.getAttribute("aria-valuenow")) === "32", "and its value can be read by a screen reader");
  await shot("slider");
  // Zoomed, a drag of the picture pans, and the handle still moves the line.
  await stage.dblclick({ position: { x: 20, y: 20 } });
  const zoomed = await at();
  await dragByMouse(page, stage, [0.9, 0.8], [0.7, 0.7]);
  expect(near(await at(), zoomed), "zoomed, a drag pans and leaves the line");
  await dragByMouse(page, stage, [zoomed / 100, 0.5], [0.5, 0.5]);
  expect(near(await at(), 50), `and the handle moves it all the same (${await at()})`);
  await stage.dblclick({ position: { x: 20, y: 20 }, modifiers: ["Shift"] });
}

// ---- widths and places ----------------------------------------------------------------------------------------------

// How many pixels the page is wider than the window.
export const excessWidth = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

// What reaches beyond the window, and cannot be scrolled to: cut off for the reader.
export const cutOff = (page, selector) =>
  page.evaluate((wanted) => {
    const scrolls = (element) => {
      for (let e = element; e; e = e.parentElement)
        if (["auto", "scroll"].includes(getComputedStyle(e).overflowX) && e.getBoundingClientRect().right <= innerWidth + 1) return true;
      return false;
    };
    return [...document.querySelectorAll(wanted)]
      .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && !scrolls(e))
      .map((e) => e.textContent.slice(0, 40));
  }, selector);

// Names of methods that break within one of their parts ("mis=bal-ance") instead of between two, among these elements.
export const brokenNames = (page, selector) =>
  page.locator(selector).evaluateAll((all) =>
    all.filter((element) => {
      const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
      for (let node = walker.nextNode(); node; node = walker.nextNode())
        for (const { 0: part, index } of node.data.matchAll(/[\p{L}\d]+/gu)) {
          const range = document.createRange();
          range.setStart(node, index);
          range.setEnd(node, index + part.length);
          if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) return true;
        }
      return false;
    }).map((element) => element.textContent.slice(0, 40)));

// From the next load of the page on, what is written on canvases is kept, so that drawnTexts() knows it.
export const keepTexts = (page) =>
  page.addInitScript(() => {
    const kept = new WeakMap();
    window.textsOf = (canvas) => kept.get(canvas) ?? [];
    const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      kept.delete(this.canvas);
      return clearRect.apply(this, box);
    };
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
      const { actualBoundingBoxLeft: left, actualBoundingBoxRight: right, actualBoundingBoxAscent: up, actualBoundingBoxDescent: down } =
        this.measureText(text);
      const turn = this.getTransform();
      const corners = [[-left, -up], [right, -up], [right, down], [-left, down]].map(([dx, dy]) => {
        const at = turn.transformPoint(new DOMPoint(x + dx, y + dy));
        return [at.x, at.y];
      });
      if (text.trim()) kept.set(this.canvas, [...window.textsOf(this.canvas), { text, corners }]);
      return fillText.call(this, text, x, y);
    };
  });

// Pairs of texts on a canvas that cover each other, and texts that reach beyond its edge.
export const crowdedTexts = (canvas) =>
  canvas.evaluate((element) => {
    const texts = window.textsOf(element);
    if (texts.length === 0) return ["no text at all"];
    // Two rectangles are apart where a side of one of them divides them.
    const apart = (a, b) => [a, b].some(({ corners: c }) => [[0, 1], [1, 2]].some(([i, j]) => {
      const [nx, ny] = [c[j][0] - c[i][0], c[j][1] - c[i][1]];
      const along = ({ corners }) => corners.map(([x, y]) => nx * x + ny * y);
      const [p, q] = [along(a), along(b)];
      return Math.max(...p) <= Math.min(...q) || Math.max(...q) <= Math.min(...p);
    }));
    const crowded = texts.flatMap((a, i) => texts.slice(i + 1).filter((b) => !apart(a, b)).map((b) => `${a.text} on ${b.text}`));
    const outside = texts.filter(({ corners }) => corners.some(([x, y]) => x < 0 || y < 0 || x > element.width || y > element.height));
    return [...crowded, ...outside.map(({ text }) => `${text} beyond the edge`)];
  });

// Links of the contents whose targets do not come to the top of the window, unless the page ends before. Each is followed on
// a page that was just opened: the way leads past figures that have not been drawn yet.
export async function misplacedLinks(page) {
  const links = page.locator("nav a");
  const count = await links.count();
  const missed = [];
  for (const i of [Math.floor(count / 3), Math.floor((2 * count) / 3), count - 1]) {
    await page.reload();
    await page.waitForSelector("article h2");
    await links.nth(i).click();
    for (let before = -1, now = 0; before !== now; ) {
      before = now;
      await page.waitForTimeout(400);
      now = await page.evaluate(() => scrollY);
    }
    const off = await links.nth(i).evaluate((link) => {
      const top = document.querySelector(link.hash).getBoundingClientRect().top;
      const atEnd = scrollY + innerHeight >= document.documentElement.scrollHeight - 2;
      return atEnd && top >= 0 && top < innerHeight ? 0 : Math.round(top);
    });
    // The page leaves a margin of 1 rem.
    if (Math.abs(off) > 20) missed.push(`${await links.nth(i).getAttribute("href")}: ${off} pixels off`);
  }
  return missed;
}

// Links of the contents whose mark, as the report being read, changes the height of the contents.
export const restlessLinks = (page) =>
  page.locator("nav").evaluate((nav) => {
    const links = [...nav.querySelectorAll("a")];
    links.forEach((link) => link.classList.remove("here"));
    const unmarked = nav.scrollHeight;
    return links.filter((link) => {
      link.classList.add("here");
      const change = nav.scrollHeight - unmarked;
      link.classList.remove("here");
      return change !== 0;
    }).map((link) => link.getAttribute("href"));
  });

// How many pages of paper the page takes; they are kept where a folder is given.
export async function paperPages(page, folder) {
  const pdf = await page.pdf({ format: "A4", ...(folder ? { path: join(folder, "print.pdf") } : {}) });
  return (pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length;
}
