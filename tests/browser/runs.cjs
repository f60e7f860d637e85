// Opens a page of two runs side by side in a headless browser: node runs.cjs CHROMIUM RUNS.html
//
// The bodies of both runs must have one view, one update and one field, whichever of them is used.
const assert = require("node:assert");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const [executablePath, runs] = process.argv.slice(2);
const url = pathToFileURL(runs).href;
const PATIENCE_MS = 120_000;
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

async function pictures(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.waitForFunction(() => document.querySelectorAll(".stage canvas[data-still]").length === 2);
  return page.$$eval(".stage canvas", (all) => all.map((canvas) => canvas.toDataURL()));
}

async function changesBoth(page, what, act) {
  const before = await pictures(page);
  await act();
  const after = await pictures(page);
  after.forEach((picture, index) => assert.notStrictEqual(picture, before[index], `${what} does not change picture ${index + 1}`));
}

async function main() {
  const browser = await chromium.launch({ executablePath, args });
  try {
    const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
    page.setDefaultTimeout(PATIENCE_MS);
    const heard = [];
    page.on("request", (request) => /^(data|blob):/.test(request.url()) || request.url() === url || heard.push(request.url()));
    page.on("console", (message) => message.type() === "error" && heard.push(message.text()));
    page.on("pageerror", (error) => heard.push(String(error)));
    await page.goto(url, { waitUntil: "load" });
    await page.waitForSelector("html[data-ready]");
    assert.match(await page.locator(".lede").innerText(), / wears /);
    await changesBoth(page, "a key on the first", () => page.locator(".stage canvas").first().press("ArrowLeft"));
    await changesBoth(page, "a key on the second", () => page.locator(".stage canvas").last().press("ArrowUp"));
    await changesBoth(page, "an update of the second", () => page.getByLabel("After update").last().fill("2"));
    await changesBoth(page, "a field of the first", () => page.getByLabel("Colours show").first().selectOption("sliding_distance_mm"));
    await changesBoth(page, "an instant of the second", () => page.getByLabel("Through the cycle").last().fill("30"));
    assert.deepStrictEqual(heard, [], "the page asks for other files or reports errors");
    await page.setViewportSize({ width: 390, height: 800 });
    const overhang = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert(overhang <= 0, `the page is ${overhang} px wider than a telephone`);
    console.log("two runs in one view");
  } finally {
    await browser.close();
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
