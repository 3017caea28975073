// usage: node page.mjs REPORT.html [SCREENSHOT_FOLDER]
// Opens a report in headless Chromium and holds it to what a reader expects: no error on the console, plots that are
// drawn, a read-out under the pointer, zoom, pictures that zoom together, and colours of its own in the dark. Exit status:
// 0 all good, 1 not, 77 no Chromium here.
import { drawnColors, examineReport, pixels } from "./browser.mjs";

await examineReport(process.argv[2], process.argv[3], async ({ page, expect, shot, ground }) => {
  await shot("top-light");

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
    const stage = views.locator(".stage .frame");
    const place = await stage.boundingBox();
    await stage.scrollIntoViewIfNeeded();
    await stage.hover({ position: { x: 0.25 * place.width, y: 40 } });
    const shown25 = await views.locator(".curtain").evaluate((curtain) => curtain.style.clipPath);
    expect(/inset\(0(px)? 7[45]/.test(shown25), `a slider parts two pictures (${shown25})`);
    await shot("slider");
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
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(wide <= 0, `a telephone need not scroll sideways (${wide} pixels too wide)`);
  await shot("narrow");
});
