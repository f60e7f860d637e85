// Opens a report of a run in a headless browser and uses what moves: node moving.cjs CHROMIUM RESULTS [PICTURES]
//
// Every control must change the picture, values picked must be those of the run, and the gait play smoothly.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const [executablePath, results, pictures] = process.argv.slice(2);
const url = pathToFileURL(path.join(results, "report.html")).href;
// A machine at other work draws slowly.
const PATIENCE_MS = 120_000;
// Drawn by the processor: every machine has one.
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

function watch(page) {
  const heard = [];
  page.on("request", (request) => /^(data|blob):/.test(request.url()) || request.url() === url || heard.push(request.url()));
  page.on("console", (message) => message.type() === "error" && heard.push(message.text()));
  page.on("pageerror", (error) => heard.push(String(error)));
  return heard;
}

async function open(browser) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(PATIENCE_MS);
  const heard = watch(page);
  const began = Date.now();
  await page.goto(url, { waitUntil: "load" });
  await page.waitForSelector("html[data-ready] .stage canvas");
  const height_px = await page.evaluate(() => document.documentElement.scrollHeight);
  assert(height_px <= 5000, `the page is ${height_px} px long with everything folded`);
  await page.locator(".more summary").click();
  await drawn(page);
  return { page, heard, ready_ms: Date.now() - began };
}

// Two frames later whatever was asked for is under way, and at rest it is drawn finely.
async function drawn(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.waitForSelector(".stage canvas[data-still]");
}

async function picture(page) {
  await drawn(page);
  return page.$eval(".stage canvas", (canvas) => canvas.toDataURL());
}

async function keep(page, name) {
  if (pictures) await page.screenshot({ path: path.join(pictures, `${name}.png`) });
}

async function move(page, words, value) {
  await page.getByLabel(words, { exact: true }).fill(String(value));
}

async function choose(page, words, value) {
  await page.locator(`label:has(span:text-is("${words}")) select`).selectOption(value);
}

async function changes(page, what, act) {
  const before = await picture(page);
  await act();
  assert.notStrictEqual(await picture(page), before, `${what} does not change the picture`);
}

async function controls(page) {
  await changes(page, "the femur's choice", () => choose(page, "Femur", "0"));
  await changes(page, "the slider of updates", () => move(page, "After update", 2));
  await changes(page, "another field", () => choose(page, "Colours show", "sliding_distance_mm"));
  await changes(page, "wear made larger", () => move(page, "Wear made larger", 20));
  await changes(page, "the section across", () => move(page, "Section at z", 0));
  await changes(page, "the section along", () => move(page, "Section at x", 0));
  await changes(page, "a view", () => page.getByRole("button", { name: "From above" }).click());
  await keep(page, "section");
  await move(page, "Section at z", 45);
  await move(page, "Section at x", 45);
  await changes(page, "a drag", () => drag(page));
  for (const key of ["Home", "ArrowLeft", "ArrowUp", "+"]) {
    await changes(page, `the key ${key}`, () => page.locator(".stage canvas").press(key));
  }
  for (const slider of await page.locator(".viewer input[type=range]").all()) {
    assert.match((await slider.getAttribute("aria-valuetext")) ?? "", /\d|none/, "a slider has no value in words");
  }
  const names = await page.locator(".stage .direction").allInnerTexts();
  assert.deepStrictEqual(names.sort(), ["Anterior", "Lateral", "Medial", "Posterior"]);
  const marks = (await page.locator(".legend .ends span").allInnerTexts()).map(Number);
  const steps = marks.slice(1).map((mark, at) => Number((mark - marks[at]).toPrecision(6)));
  assert(new Set(steps).size === 1 && /^[125]0*$/.test(steps[0].toExponential()[0]), `marks of the bar: ${marks}`);
}

// Unworn places are light in 3-D, as on the flat maps.
async function light(page) {
  await choose(page, "Colours show", "wear_depth_mm");
  await move(page, "After update", 0);
  const bar = await page.$eval(".legend .bar", (bar) => getComputedStyle(bar).backgroundImage.match(/rgb\((\d+), (\d+), (\d+)\)/g));
  const lightness = (colour) => colour.match(/\d+/g).reduce((sum, part) => sum + Number(part), 0);
  assert(lightness(bar[0]) > 600 && lightness(bar.at(-1)) < 150, `the bar goes from ${bar[0]} to ${bar.at(-1)}`);
}

// The saved picture is a slide with title and legend.
async function slide(page) {
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save picture" }).click();
  const bytes = fs.readFileSync(await (await saved).path());
  assert.deepStrictEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [1920, 1080]);
  if (pictures) fs.writeFileSync(path.join(pictures, "slide.png"), bytes);
}

// The saved bodies are glTF of the run's size, and the saved video shows a cycle.
async function exports(page) {
  const file = async (name) => {
    const saved = page.waitForEvent("download");
    await page.getByRole("button", { name }).click();
    const download = await saved;
    return { name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path()) };
  };
  await move(page, "Wear made larger", 1);
  const { name, bytes } = await file("Save bodies");
  assert.strictEqual(name, "bodies.glb");
  assert.strictEqual(bytes.toString("latin1", 0, 4), "glTF");
  assert.strictEqual(bytes.readUInt32LE(8), bytes.length);
  const head = JSON.parse(bytes.toString("utf8", 20, 20 + bytes.readUInt32LE(12)));
  assert.deepStrictEqual(head.meshes.map(({ name }) => name), ["articulating surface", "insert", "femur"]);
  const { min, max } = head.accessors[head.meshes[0].primitives[0].attributes.POSITION];
  // The generic insert: x from -24 to 22, z from -36 to 36 mm.
  [min[0] + 24, max[0] - 22, min[2] + 36, max[2] - 36].forEach((off) => assert(Math.abs(off) < 0.1, `${min} to ${max}`));
  const film = await file("Save video");
  assert.match(film.name, /^cycle\.(webm|mp4)$/);
  // In a page of its own: the policy of a report loads no video.
  const blank = await page.context().browser().newPage();
  const size = await blank.evaluate(async (address) => {
    const clip = Object.assign(document.createElement("video"), { muted: true, src: address });
    await new Promise((done, failed) => Object.assign(clip, { onloadeddata: done, onerror: failed }));
    return [clip.videoWidth, clip.videoHeight];
  }, `data:video/${path.extname(film.name).slice(1)};base64,${film.bytes.toString("base64")}`);
  await blank.close();
  assert.deepStrictEqual(size, [1920, 1080]);
  assert(film.bytes.length > 20_000, `the video has ${film.bytes.length} bytes`);
  if (pictures) fs.writeFileSync(path.join(pictures, film.name), film.bytes);
}

// Without WebGL, the surface is shown from above, and follows the controls.
async function withoutWebGl(browser) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(PATIENCE_MS);
  const heard = watch(page);
  await page.addInitScript(() => {
    const context = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : context.call(this, kind, ...rest);
    };
  });
  await page.goto(url, { waitUntil: "load" });
  await page.waitForSelector("html[data-ready] .stage canvas[data-still]");
  assert.match(await page.locator(".stage").innerText(), /WebGL is off/);
  await changes(page, "without WebGL, the slider of updates", () => move(page, "After update", 1));
  await changes(page, "without WebGL, the cycle", () => move(page, "Through the cycle", 20));
  await changes(page, "without WebGL, picking", () => page.getByRole("button", { name: "Pick the highest" }).click());
  await keep(page, "flat");
  assert.deepStrictEqual(heard.filter((words) => !/WebGL/.test(words)), []);
  await page.close();
}

// The page runs no script but its own.
async function guarded(page) {
  const ran = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.intruded = true";
    document.body.append(script);
    return "intruded" in window;
  });
  assert(!ran, "a script that is not of the page runs");
}

async function drag(page) {
  await page.locator(".stage canvas").scrollIntoViewIfNeeded();
  const { x, y, width, height } = await page.locator(".stage canvas").boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 80, y + height / 2 + 30, { steps: 4 });
  await page.mouse.up();
}

// The last update's deepest node is that of summary.json to the digits shown.
async function highest(page, summary) {
  await move(page, "After update", 10);
  await choose(page, "Colours show", "wear_depth_mm");
  await changes(page, "picking the highest", () => page.getByRole("button", { name: "Pick the highest" }).click());
  const picked = await page.locator(".picked").innerText();
  const depth_mm = Number(/Wear depth\s+([\d.]+) mm/.exec(picked)[1]);
  assert(Math.abs(depth_mm - summary.max_depth_mm) < 1e-4, `${depth_mm} mm picked, ${summary.max_depth_mm} in summary.json`);
}

// A place picked on a flat map is marked on every map and on the bodies, and read.
async function linked(page) {
  const maps = page.locator("svg[data-map]");
  const map = maps.nth(1);
  await map.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await map.boundingBox();
  const before = await page.locator(".picked").innerText();
  await changes(page, "a place of a flat map", () => page.mouse.click(x + width * 0.6, y + height * 0.45));
  assert.notStrictEqual(await page.locator(".picked").innerText(), before);
  assert.strictEqual(await page.locator("svg[data-map] .picked-place").count(), await maps.count());
  const [ring, clicked] = [await map.locator(".picked-place").boundingBox(), [x + width * 0.6, y + height * 0.45]];
  const off = Math.hypot(ring.x + ring.width / 2 - clicked[0], ring.y + ring.height / 2 - clicked[1]);
  assert(off < 12, `the mark is ${off} px from where was clicked`);
}

// Curves are drawn as they come into sight, each once; a still picture is saved as it is shown.
async function curves(page) {
  const stills = page.locator("svg.fig[data-chart]");
  for (const still of await stills.all()) assert(!(await still.isVisible()), "a curve is shown twice");
  for (const box of await page.locator(".panels .curves, .answer .curves").all()) {
    await box.scrollIntoViewIfNeeded();
    await box.locator("canvas").waitFor();
  }
  const drawn = await page.locator(".curves canvas").count();
  assert(drawn >= (await stills.count()), `only ${drawn} curves are drawn`);
  for (const [kind, begins] of [["SVG", "<svg"], ["PNG", "\u0089PNG"]]) {
    const box = page.locator(".figure-box").first();
    await box.hover();
    const saved = page.waitForEvent("download");
    await box.getByRole("button", { name: kind }).click();
    const file = await (await saved).path();
    assert(fs.readFileSync(file, "latin1").startsWith(begins), `what is saved is no ${kind}`);
  }
}

async function picks(page) {
  await choose(page, "Colours show", "wear_depth_mm");
  const { x, y, width, height } = await page.locator(".stage canvas").boundingBox();
  await page.getByRole("button", { name: "From above" }).click();
  await drawn(page);
  await page.mouse.click(x + width / 2, y + height * 0.3);
  const picked = await page.locator(".picked").innerText();
  assert.match(picked, /At x .* mm:[\s\S]*Wear depth\s+[\d.]+ mm/, picked);
  assert.match(await page.locator("#moving").innerText(), /at the picked point/);
}

async function gait(page) {
  await choose(page, "Femur", "0.3");
  await page.getByRole("button", { name: "Oblique" }).click();
  await changes(page, "the slider through the cycle", () => move(page, "Through the cycle", 26));
  const status = await page.locator(".status").innerText();
  assert.match(status, /% of the last cycle: \d+ N and \d+ N on the surface/, status);
  await keep(page, "gait");
}

// Drawn by the processor, a moving picture has fewer pixels than one at rest, is smoothed only then, and is not blended.
async function cheap(page) {
  const { antialias, alpha } = await page.$eval(".stage canvas", (canvas) => canvas.getContext("webgl2").getContextAttributes());
  assert(!antialias && !alpha, "the renderer in software is not recognised");
  const width = () => page.$eval(".stage canvas", (canvas) => canvas.width / canvas.clientWidth);
  await drawn(page);
  const fine = await width();
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction((fine) => [...document.querySelectorAll(".stage canvas")].every((canvas) => canvas.width / canvas.clientWidth < fine / 2), fine);
  await page.getByRole("button", { name: "Pause" }).click();
}

// Frames a second while the gait plays, at 800 x 600.
async function played(browser) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(PATIENCE_MS);
  await page.goto(url, { waitUntil: "load" });
  await page.waitForSelector("html[data-ready] .stage canvas");
  await page.addStyleTag({ content: ".stage{width:800px;height:600px;aspect-ratio:auto!important}.viewer{width:800px}" });
  await page.getByRole("button", { name: "Play" }).click();
  return page.evaluate(
    () =>
      new Promise((done) => {
        let frames = 0;
        const began = performance.now();
        const count = () => (performance.now() - began < 2000 ? (frames++, requestAnimationFrame(count)) : done(frames / 2));
        requestAnimationFrame(count);
      }),
  );
}

async function main() {
  const browser = await chromium.launch({ executablePath, args });
  try {
    const { page, heard, ready_ms } = await open(browser);
    await keep(page, "first");
    const summary = JSON.parse(fs.readFileSync(path.join(results, "summary.json"), "utf8"));
    const mass = summary.mass_loss_mg.toPrecision(3);
    assert((await page.locator(".tiles").innerText()).includes(mass), `the page does not say ${mass} mg`);
    await controls(page);
    await light(page);
    await slide(page);
    await picks(page);
    await highest(page, summary);
    await linked(page);
    await curves(page);
    await gait(page);
    await cheap(page);
    await exports(page);
    assert.match(await page.locator("#licences").textContent(), /three[\s\S]*Permission is hereby granted[\s\S]*uplot/i);
    assert.deepStrictEqual(heard, [], "the page asks for other files or reports errors");
    await page.emulateMedia({ media: "print" });
    assert(!(await page.locator("#moving").isVisible()), "the 3-D view is printed");
    assert(!(await page.locator(".curves").first().isVisible()), "an interactive curve is printed");
    for (const still of await page.locator("svg.fig[data-chart]").all()) assert(await still.isVisible(), "a curve is not printed");
    await guarded(page);
    await page.close();
    await withoutWebGl(browser);
    const frames = await played(browser);
    console.log(`ready after ${ready_ms} ms, ${frames} frames a second, ${fs.statSync(path.join(results, "report.html")).size} bytes`);
  } finally {
    await browser.close();
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
