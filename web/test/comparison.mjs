// usage: node comparison.mjs REPORT.html [SCREENSHOT_FOLDER]
// Opens the report of a comparison in headless Chromium: pictures that are drawn, values under the pointer, the ways to
// hold pictures against each other, and where the variance comes from. Exit status: 0 all good, 1 not, 77 no Chromium here.
import {
  brokenNames, crowdedTexts, cutOff, drawnColors, examineReport, examineSlider, excessWidth, keepTexts, pixels,
} from "./browser.mjs";

await examineReport(process.argv[2], process.argv[3], async ({ page, expect, shot, ground }) => {
  await page.waitForSelector(".comparison canvas");
  await shot("comparison-light", { fullPage: true });

  const facts = await page.locator(".facts").textContent();
  for (const [what, pattern] of [["the resolution", /64 × 48 pixels/], ["the samples", /4 samples per pixel in each repeat/],
    ["the repeats", /4 of each method/], ["the measure", /relMSE/], ["the version", /Montelux \d+\.\d+/],
    ["the reference", /reference.*samples per pixel/]])
    expect(pattern.test(facts), `the conditions have ${what}`);
  const place = await page.locator(".facts").boundingBox();
  expect(place.y + place.height < 900, `and stand on top (${Math.round(place.y)} to ${Math.round(place.y + place.height)})`);
  const verdict = await page.locator("article > p").first().textContent();
  expect(/^path(:mis=balance)? (is|and) .*path/.test(verdict) && / by relMSE/.test(verdict) && / by MSE /.test(verdict),
    `the verdict has names and measures ("${verdict}")`);
  expect((await excessWidth(page)) <= 0, "the page fits 1280 pixels");
  const cut = await page.locator(".scroll").evaluateAll((all) =>
    all.filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent.slice(0, 40)));
  expect(cut.length === 0, `no table is cut at 1280 pixels ${cut.join("; ")}`);

  const viewer = page.locator(".comparison .viewer");
  const canvases = viewer.locator(".pictures canvas");
  expect((await canvases.count()) === 3, "the reference and both methods are shown");
  const colors = await drawnColors(canvases.first());
  expect(colors > 20, `the reference has colours (${colors})`);
  const plain = await pixels(canvases.nth(1));
  expect(plain !== (await pixels(canvases.first())), "a method is not the reference");

  const frame = viewer.locator(".pictures .frame").nth(1);
  await frame.scrollIntoViewIfNeeded();
  const box = await frame.boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.6 * box.height);
  const text = await page.locator(".pixel table").textContent();
  expect(/pixel \d+, \d+/.test(text) && /\d ± \d/.test(text), `the pointer reads a pixel with its error bars ("${text}")`);
  const cells = await page.locator(".pixel td.number").allTextContents();
  const figures = cells.map((cell) => /^[−]?\d+\.(\d+) ± (\d+\.(\d+))$/.exec(cell));
  expect(cells.length === 9 && figures.every((f) => f && f[1].length === f[3].length && f[2].replace(".", "").replace(/^0+/, "").length === 2),
    "with two digits of the error and as many places of the value");
  expect((await page.locator("canvas.settling").count()) === 1, "and shows how its mean settled");

  const errors = viewer.locator("button", { hasText: "errors" });
  await errors.click();
  expect((await pixels(canvases.nth(1))) !== plain, "errors are shown in false colours");
  await shot("comparison-errors");
  await errors.click();
  expect((await pixels(canvases.nth(1))) === plain, "and the picture comes back");
  await page.locator("input[aria-label=exposure]").fill("2");
  expect((await pixels(canvases.nth(1))) !== plain, "the exposure can be set");
  await page.locator("input[aria-label=exposure]").fill("0");

  await viewer.locator(".switcher button", { hasText: "Slider" }).click();
  await examineSlider({ page, expect, shot }, viewer);
  const stage = viewer.locator(".stage .frame");
  await viewer.locator(".switcher button", { hasText: "Flip" }).click();
  const caption = () => viewer.locator(".stage .caption").textContent();
  const first = await caption();
  await stage.click();
  expect(first !== (await caption()), "a click flips to the other picture");
  await stage.press("f");
  expect(first === (await caption()), "and a key flips back");
  await shot("comparison-flip");
  await viewer.locator(".choose select").first().selectOption("0");
  expect((await caption()) === "reference", "any of them can be chosen");

  await viewer.locator(".switcher button", { hasText: "Side by side" }).click();
  await viewer.locator("select[aria-label=show]").selectOption("variance of path by bounces");
  expect((await drawnColors(canvases.nth(1))) > 20, "the share of a layer in the variance is a picture");
  await viewer.locator(".pictures .frame").first().hover({ position: { x: 50, y: 40 } });
  const shares = await page.locator(".pixel table").textContent();
  expect(/share/.test(shares) && /bounce1/.test(shares), `the pointer reads shares ("${shares}")`);
  await shot("comparison-shares");
  await viewer.locator("select[aria-label=show]").selectOption("pictures");
  expect((await canvases.count()) === 3, "and the pictures come back");
  expect((await page.locator("figcaption", { hasText: "Shares of the variance of the image" }).count()) === 2,
    "the shares are charts by bounces and by techniques, but not by the only light group");

  for (const [i, family] of ["bounces", "techniques"].entries()) {
    const chart = page.locator("figure", { has: page.locator("figcaption", { hasText: `variance of the image by ${family}` }) });
    await chart.scrollIntoViewIfNeeded();
    await chart.locator(".plot canvas").waitFor({ timeout: 10000 });
    await page.waitForTimeout(100);
    expect((await drawnColors(chart.locator(".plot canvas"))) >= 8, `the chart by ${family} is drawn`);
    const plot = chart.locator(".u-over");
    await plot.hover({ position: { x: 80, y: 60 } });
    const read = await chart.locator(".readout.shown").textContent().catch(() => "");
    if (i === 0) expect(/bounces: bounce0/.test(read), `and reads out the layer by name ("${read}")`);
    await shot(`comparison-${family.replace(" ", "-")}`);
  }

  const light = await ground();
  await page.evaluate(() => scrollTo(0, 0));
  await page.locator("button.theme").click();
  await page.waitForTimeout(200);
  expect(light !== (await ground()), "the page turns dark");
  await shot("comparison-dark", { fullPage: true });

  await page.setViewportSize({ width: 390, height: 800 });
  await page.waitForTimeout(300);
  await viewer.locator(".pictures .frame").first().hover({ position: { x: 30, y: 20 } });
  const wide = await excessWidth(page);
  expect(wide <= 0, `a telephone need not scroll sideways (${wide} pixels too wide)`);
  const lost = await cutOff(page, "td, th, .facts dd, article p, button, select, math");
  expect(lost.length === 0, `and nothing is cut off there ${lost.slice(0, 3).join("; ")}`);
  const broken = await brokenNames(page, ".facts dt, .picture .caption, th:first-child, td:first-child, article > p, .legend button");
  expect(broken.length === 0, `names wrap between their parts ${broken.slice(0, 3).join("; ")}`);
  await shot("comparison-narrow", { fullPage: true });
  await viewer.locator(".switcher button", { hasText: "Slider" }).click();
  await stage.scrollIntoViewIfNeeded();
  await shot("comparison-narrow-slider");

  await keepTexts(page);
  for (const width of [320, 390, 640, 1280]) {
    await page.setViewportSize({ width, height: 800 });
    await page.reload();
    for (const family of ["bounces", "techniques"]) {
      const chart = page.locator("figure", { has: page.locator("figcaption", { hasText: `variance of the image by ${family}` }) });
      await chart.scrollIntoViewIfNeeded();
      await chart.locator(".plot canvas").waitFor({ timeout: 10000 });
      await page.waitForTimeout(200);
      const crowded = await crowdedTexts(chart.locator(".plot canvas"));
      expect(crowded.length === 0, `no name of ${family} covers another at ${width} pixels ${crowded.slice(0, 3).join("; ")}`);
      if (width === 390) await shot(`comparison-narrow-${family}`);
    }
  }
});
