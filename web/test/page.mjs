// usage: node page.mjs REPORT.html [SCREENSHOT_FOLDER]
// Opens a report in headless Chromium and holds it to what a reader expects: no error on the console, plots that are
// drawn, a read-out under the pointer, zoom, pictures that zoom together, and colours of its own in the dark. Exit status:
// 0 all good, 1 not, 77 no Chromium here.
import { cutOff, drawnColors, examineReport, examineSlider, excessWidth, misplacedLinks, paperPages, pixels, restlessLinks } from "./browser.mjs";

await examineReport(process.argv[2], process.argv[3], async ({ page, expect, shot, ground }) => {
  await shot("top-light");
  // First of all, while no figure has come near the window.
  const missed = await misplacedLinks(page);
  expect(missed.length === 0, `links of the contents land where they say ${missed.slice(0, 5).join("; ")}`);
  await page.reload();
  await page.waitForSelector("article h2");

  const figures = page.locator("figure:has(.plot)");
  const count = await figures.count();
  expect(count > 0, `there are figures (${count})`);
  expect((await page.locator("math").count()) > 0, "formulas are MathML");
  expect((await page.locator(".katex-error").count()) === 0, "every formula can be read");
  let blank = 0;
  for (let i = 0; i < count; ++i) {
    await figures.nth(i).scrollIntoViewIfNeeded();
    const canvas = figures.nth(i).locator("canvas");
    await canvas.waitFor({ timeout: 10000 });
    await page.waitForTimeout(30);
    if ((await drawnColors(canvas)) < 8) ++blank;
  }
  expect(blank === 0, `every plot is drawn (${blank} blank)`);

  const figure = figures.first();
  await figure.scrollIntoViewIfNeeded();
  const over = figure.locator(".u-over");
  const box = await over.boundingBox();
  await page.mouse.move(box.x + 0.55 * box.width, box.y + 0.45 * box.height);
  await page.waitForTimeout(100);
  const text = await figure.locator(".readout.shown").first().textContent().catch(() => "");
  expect(/\d/.test(text ?? ""), `the pointer reads values ("${text}")`);
  await shot("hover");

  const before = await pixels(figure.locator("canvas"));
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.7 * box.height, { steps: 8 });
  await page.mouse.up();
  await page.waitForTimeout(100);
  const zoomed = await pixels(figure.locator("canvas"));
  expect(zoomed !== before, "dragging zooms");
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.waitForTimeout(400);
  expect((await pixels(figure.locator("canvas"))) === before, "a double click shows all again");

  await figure.locator(".legend button").first().click();
  await page.waitForTimeout(100);
  expect((await pixels(figure.locator("canvas"))) !== before, "a click on a name hides its curve");
  await figure.locator(".legend button").first().click();

  const views = page.locator("figure:has(.pictures .picture ~ .picture)").first();
  if ((await views.count()) > 0) {
    const frames = views.locator(".pictures .frame");
    await frames.first().scrollIntoViewIfNeeded();
    await frames.first().dblclick();
    const shown = await frames.nth(1).locator("img").evaluate((image) => image.style.transform);
    expect(/scale\(2\.5\)/.test(shown), "pictures zoom together");
    await frames.first().dblclick({ modifiers: ["Shift"] });
    await shot("pictures");
    await views.locator(".switcher button", { hasText: "Slider" }).click();
    await examineSlider({ page, expect, shot }, views);
    await views.locator(".switcher button", { hasText: "Flip" }).click();
    const curtain = () => views.locator(".curtain").evaluate((element) => element.style.clipPath);
    const one = await curtain();
    await views.locator(".choose button").click();
    expect(one !== (await curtain()), "a flip shows the other picture");
    await views.locator(".switcher button", { hasText: "Side by side" }).click();
  }

  const light = await ground();
  await page.evaluate(() => scrollTo(0, 0));
  await page.locator("button.theme").click();
  await page.waitForTimeout(200);
  const dark = await ground();
  expect(light !== dark, `the switch turns the page dark (${light} to ${dark})`);
  await shot("top-dark");
  await figure.scrollIntoViewIfNeeded();
  expect((await pixels(figure.locator("canvas"))) !== before, "plots follow into the dark");
  await shot("figure-dark");
  await page.evaluate(() => localStorage.clear());
  await page.emulateMedia({ colorScheme: "dark" });
  await page.reload();
  await page.waitForSelector("article h2");
  expect((await ground()) === dark, "a dark system makes the page dark");

  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize({ width: 390, height: 800 });
  await page.reload();
  await page.waitForSelector("article h2");
  await page.waitForTimeout(300);
  const wide = await excessWidth(page);
  expect(wide <= 0, `a telephone need not scroll sideways (${wide} pixels too wide)`);
  await shot("narrow");
  const lost = await cutOff(page, "math, td, th, article p, button, select");
  expect(lost.length === 0, `and nothing is cut off there, no formula either (${lost.length}: ${lost.slice(0, 3).join("; ")})`);
  const wider = await page.locator(".formula").evaluateAll((all) =>
    all.filter((e) => e.scrollWidth > e.clientWidth + 1 && !e.classList.contains("scrolls")).map((e) => e.textContent.slice(0, 30)));
  expect(wider.length === 0, `formulas fit, or show that they scroll (${wider.length} do not: ${wider.slice(0, 3).join("; ")})`);
  const scrolling = page.locator(".formula.scrolls");
  if ((await scrolling.count()) > 0) {
    await scrolling.first().scrollIntoViewIfNeeded();
    await shot("narrow-formula");
  }
  const astray = await misplacedLinks(page);
  expect(astray.length === 0, `its links land where they say, too ${astray.slice(0, 5).join("; ")}`);

  for (const width of [320, 390, 640, 1280]) {
    await page.setViewportSize({ width, height: 800 });
    const restless = await restlessLinks(page);
    expect(restless.length === 0, `the mark of the report being read moves nothing at ${width} pixels ${restless.slice(0, 5).join("; ")}`);
  }

  // On A4 between margins of 16 mm: 673 x 1001 CSS pixels.
  await page.setViewportSize({ width: 673, height: 1001 });
  await page.emulateMedia({ media: "print" });
  const pages = await paperPages(page, process.argv[3]);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  const full = Math.ceil(height / 1001);
  expect(pages > 0 && pages <= 1.15 * full + 1, `paper is used: ${pages} pages for what fills ${full}`);
});
