// Uses the web page in a headless browser: node page.cjs CHROMIUM PAGE MADE BODIES
//
// PAGE is the folder of the page, MADE has in `node` what its program found in Node, and gets what the page saves; BODIES has
// a femoral component and an insert, femur.stl and insert.stl.
const assert = require("node:assert");
const { createHash } = require("node:crypto");
const fs = require("node:fs");
const path = require("node:path");
const { chromium } = require("playwright-core");
const served = require("./served.cjs");

const [executablePath, folder, made, bodies] = process.argv.slice(2);
// A machine at other work is slow.
const PATIENCE_MS = 180_000;
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--js-flags=--expose-gc"];
// A case of a moment.
const QUICK = "[insert]\nedge_mm = 3.0\nlayers = 1\n[march]\nupdates = 3\n[time]\nincrements = 40\n";
const LARGEST_MB = 1.2;

function watch(page, url, heard) {
  page.on("request", (request) => /^(data|blob):/.test(request.url()) || request.url().startsWith(url) || heard.push(request.url()));
  page.on("console", (message) => message.type() === "error" && heard.push(message.text()));
  page.on("pageerror", (error) => heard.push(String(error)));
}

// The durations of tasks longer than 50 ms, during which the page does not respond.
function listenForLongTasks() {
  window.longTasks = [];
  new PerformanceObserver((found) => window.longTasks.push(...found.getEntries().map(({ duration }) => duration))).observe({ type: "longtask" });
}

async function open(context, url, heard) {
  const page = await context.newPage();
  await page.addInitScript(listenForLongTasks);
  page.setDefaultTimeout(PATIENCE_MS);
  watch(page, url, heard);
  const began = Date.now();
  await page.goto(url);
  await page.waitForSelector("html[data-ready] .stage canvas");
  return { page, ready_ms: Date.now() - began };
}

const runs = (page) => page.evaluate(() => Number(document.documentElement.dataset.runs ?? 0));
const state = (page) => page.locator("#state").innerText();
const number = (page, name) => page.locator(`[data-number=${name}]`).innerText();
const write = (page, text) => page.locator("#case-text").fill(text);

// Does something that starts a run, and waits until that is shown.
async function ran(page, act) {
  const before = await runs(page);
  await act();
  await page.waitForFunction((count) => Number(document.documentElement.dataset.runs ?? 0) > count, before);
  return page;
}

async function picture(page) {
  await page.waitForSelector(".stage canvas[data-still]");
  return page.$eval(".stage canvas", (canvas) => canvas.toDataURL());
}

async function keep(page, name) {
  await page.screenshot({ path: path.join(made, `${name}.png`) });
}

// Size of what is loaded first, as a server that knows brotli sends it.
function loaded() {
  const files = fs.readdirSync(folder).filter((name) => name.endsWith(".br") && name !== "moving.js.zz.br");
  return files.reduce((sum, name) => sum + fs.statSync(path.join(folder, name)).size, 0) / 1e6;
}

// The same program and case give the same bytes here and in Node.
async function sameAsInNode(page) {
  const wanted = fs.readFileSync(path.join(made, "node/scene"));
  const text = fs.readFileSync(path.join(__dirname, "../../cases/stanmore-force.toml"), "utf8");
  const found = await page.evaluate(async (text) => {
    const module = await WebAssembly.compile(await (await fetch("condyle-web.wasm")).arrayBuffer());
    const worker = new Worker("worker.js");
    const files = { "case.toml": new TextEncoder().encode(text) };
    const answer = await new Promise((done) => {
      worker.onmessage = ({ data }) => data.answer && done(data.answer);
      worker.postMessage({ module, order: { words: ["run", "case.toml", "results", "scene"], files, outputs: ["results", "scene"] } });
    });
    worker.terminate();
    const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", answer.files.scene));
    return { hash: [...hash].map((byte) => byte.toString(16).padStart(2, "0")).join(""), summary: new TextDecoder().decode(answer.files["results/summary.json"]) };
  }, text);
  assert.strictEqual(found.hash, createHash("sha256").update(wanted).digest("hex"), "the browser finds other bytes than Node");
  const timeless = (text) => text.replaceAll(/"wall_s": [^,\n]*/g, "");
  assert.strictEqual(timeless(found.summary), timeless(fs.readFileSync(path.join(made, "node/summary.json"), "utf8")));
  return JSON.parse(found.summary);
}

async function numbers(page, summary) {
  for (const name of ["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa", "ap_range_mm"]) {
    const shown = await number(page, name);
    assert(shown.startsWith(String(Number(summary[name].toPrecision(4)))), `${name}: the page says ${shown}, the summary ${summary[name]}`);
  }
}

async function sliders(page) {
  const before = [await picture(page), await number(page, "mass_loss_mg")];
  const began = Date.now();
  await ran(page, () => page.getByLabel("Sagittal radius of the dish").fill("90"));
  const solved_ms = Date.now() - began;
  assert.notStrictEqual(await picture(page), before[0], "the slider does not move the picture");
  assert.notStrictEqual(await number(page, "mass_loss_mg"), before[1], "the slider does not change the mass");
  assert.match(await page.locator("#case-text").inputValue(), /sagittal_radius_mm = 90/);
  // The keyboard moves it too.
  await page.getByLabel("Sagittal radius of the dish").focus();
  await ran(page, () => page.keyboard.press("ArrowLeft"));
  assert.match(await page.locator("#case-text").inputValue(), /sagittal_radius_mm = 89/);
  return solved_ms;
}

// The first place of the picture, in parts of it, that has a point with these words.
async function pointOf(page, label, move) {
  for (const y of range(0.1, 0.98, 0.02)) {
    for (const x of range(0.05, 0.95, 0.01)) if ((await move(x, y)).startsWith(label)) return [x, y];
  }
  throw new Error(`no point for ${label}`);
}

const range = (from, to, step) => Array.from({ length: Math.round((to - from) / step) + 1 }, (_, i) => from + i * step);

// Points of insert and femur are dragged, with the new value next to them; the test is solved when they are dropped, and undone.
async function dragged(page) {
  const text = () => page.locator("#case-text").inputValue();
  for (const [label, key, [right, down], isLarger] of [
    ["Thickness", "thickness_mm", [0, 0.02], true],
    ["Distal radius", "distal_radius_mm", [0, 0.02], true],
    ["Coronal radius of the femur", "coronal_radius_mm", [0, -0.02], false],
  ]) {
    await picture(page);
    const box = await page.locator(".stage canvas").boundingBox();
    const move = async (x, y) => {
      await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
      return page.locator(".stage [aria-live]").innerText();
    };
    const [x, y] = await pointOf(page, label, move);
    const [before, kept] = [await text(), await move(x, y)];
    await page.mouse.down();
    const said = await move(x + right, y + down);
    assert.strictEqual(await text(), before, "the case changes before the point is dropped");
    await ran(page, () => page.mouse.up());
    const [old, now] = [kept, said].map((words) => Number(words.match(/([\d.]+) mm$/)[1]));
    assert(now > old === isLarger && now !== old, `${label}: ${kept}, then ${said}`);
    assert.match(await text(), new RegExp(`\\b${key} = ${now}\\b`));
    await ran(page, () => page.goBack());
    // On a slow machine, the run that ends may still be that of the drag.
    const undone = (before) => document.querySelector("#case-text").value === before;
    await page.waitForFunction(undone, before).catch(() => {});
    assert.strictEqual(await text(), before, "the browser's back does not undo a drag");
  }
}

// Coarse numbers come first, and the report is of the run that is shown: nothing is solved again.
async function previewed(page) {
  await page.evaluate(() => {
    window.tiles = [];
    const note = () => window.tiles.push({ coarse: document.documentElement.hasAttribute("data-preview"), mass: Number.parseFloat(document.querySelector("[data-number=mass_loss_mg]").textContent) });
    new MutationObserver(note).observe(document.getElementById("tiles"), { childList: true });
  });
  await ran(page, () => page.getByLabel("Friction").fill("0.1"));
  const [first, last, ...more] = await page.evaluate(() => window.tiles);
  assert(first.coarse && !last.coarse && more.length === 0, JSON.stringify([first, last, ...more]));
  assert(first.mass !== last.mass && Math.abs(first.mass / last.mass - 1) < 0.1, `${first.mass} mg at first, then ${last.mass}`);
}

// A new run shows nothing of the run before from the moment it starts.
async function freshStart(page) {
  await page.evaluate(() => {
    window.atStart = [];
    const note = () => {
      if (!document.documentElement.hasAttribute("data-busy")) return;
      window.atStart.push({ words: document.getElementById("state").textContent, part: document.getElementById("progress").value });
    };
    new MutationObserver(note).observe(document.documentElement, { attributeFilter: ["data-busy"] });
  });
  await ran(page, () => page.getByLabel("Friction").fill("0.09"));
  const [first] = await page.evaluate(() => window.atStart);
  assert(first && first.part < 1 && !/solved/.test(first.words), JSON.stringify(first));
}

// The address has the case: it survives a reload, and the browser's back and forward undo and redo.
async function remembered(page) {
  const text = () => page.locator("#case-text").inputValue();
  await ran(page, () => page.getByLabel("Friction").fill("0.11"));
  const later = await text();
  assert.match(new URL(page.url()).hash, /^#case=[\w-]+$/);
  await ran(page, () => page.goBack());
  assert.match(await text(), /friction = 0\.09/);
  await ran(page, () => page.goForward());
  assert.strictEqual(await text(), later);
  await page.reload();
  await page.waitForSelector("html[data-ready] .stage canvas");
  assert.strictEqual(await text(), later, "a reload loses the case");
}

// An example replaces the case, and the sliders that it lacks are disabled.
async function examples(page) {
  await ran(page, () => page.getByLabel("Example").selectOption("Pin on disc"));
  assert.match(await page.locator("#case-text").inputValue(), /preset = "pin-on-disc"/);
  for (const name of ["Distal radius", "Varus of the femur"]) {
    assert(await page.getByLabel(name).isDisabled(), `a pin has a slider for ${name}`);
    assert.strictEqual(await page.getByLabel(name).getAttribute("aria-valuetext"), "not of this joint");
  }
  assert.strictEqual(await page.locator("[data-number=ap_range_mm]").count(), 0, "a pin has an AP range");
  await ran(page, () => page.getByLabel("Friction").fill("0.05"));
  assert.strictEqual(await page.getByLabel("Example").inputValue(), "");
  await ran(page, () => page.getByLabel("Example").selectOption("Knee, Stanmore simulator"));
}

// Two designs: both views turn together, and the differences are a sentence, a list of settings, a table and a map.
async function comparing(page) {
  await page.getByRole("button", { name: "Keep this run" }).click();
  await ran(page, () => page.getByLabel("Friction").fill("0.14"));
  const told = await page.locator("#comparison").innerText();
  assert.match(told, /This run wears [\d.]+ mg (more|less) than the kept one \([+−][\d.]+ %\), [\d.]+ times the discretisation errors of both/, told);
  assert.match(told, /contact\.friction: 0\.\d+ → 0\.14/, told);
  assert.match(told, /Mass loss, mg\s+[\d.]+ ± [\d.]+\s+[\d.]+ ± [\d.]+\s+[+−][\d.]+ %\s+[\d.]+ times/, told);
  const widths = await page.$$eval(".stage", (all) => all.map(({ clientWidth }) => clientWidth));
  assert(widths.length === 2 && Math.abs(widths[0] - widths[1]) < 2, `the views are ${widths} px wide`);
  const pictures = () => page.$$eval(".stage canvas", (all) => all.map((canvas) => canvas.toDataURL()));
  await page.waitForFunction(() => document.querySelectorAll(".stage canvas[data-still]").length === 2);
  const before = await pictures();
  await page.locator("#kept .stage canvas").press("ArrowLeft");
  await page.waitForFunction(() => document.querySelectorAll(".stage canvas[data-still]").length === 2);
  (await pictures()).forEach((picture, index) => assert.notStrictEqual(picture, before[index], `picture ${index + 1} does not turn`));
  // Colours of both signs: more friction moves the scar.
  const [red, blue] = await page.$eval(".difference canvas", (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const count = (isOf) => data.filter((_, at) => at % 4 === 0 && data[at + 3] === 255 && isOf(data[at], data[at + 2])).length;
    return [count((red, blue) => red > blue + 40), count((red, blue) => blue > red + 40)];
  });
  assert(red > 20 && blue > 20, `${red} red and ${blue} blue squares`);
  await keep(page, "compared");
  await page.locator("#comparison").scrollIntoViewIfNeeded();
  await keep(page, "comparison");
  await page.getByRole("button", { name: "Stop comparing" }).click();
  assert.strictEqual(await page.locator(".stage canvas").count(), 1);
}

// Other loads are a changed setting, other sides have no map, and both views show one instant and the nearest update.
async function comparingOthers(page) {
  const told = () => page.locator("#comparison").innerText();
  const knee = (more) => `[insert]\nedge_mm = 3.0\nlayers = 1\n${more}`;
  await ran(page, () => write(page, knee("[march]\nupdates = 4\n[time]\nincrements = 80\n")));
  await page.getByRole("button", { name: "Keep this run" }).click();
  await ran(page, () => page.getByLabel("Loads, relative to the waveforms").fill("1.2"));
  assert.match(await told(), /machine\.load_scale: 1(\.0)? .* 1\.2/);
  assert.strictEqual(await page.locator(".difference canvas").count(), 1);
  await ran(page, () => write(page, `side = "left"\n${knee("")}`));
  assert.match(await told(), /cannot be subtracted: one is a right joint and the other a left one/);
  assert.strictEqual(await page.locator(".difference canvas").count(), 0);
  await ran(page, () => write(page, knee("[march]\nupdates = 4\ncycles = 10000000\n[time]\nincrements = 40\n")));
  const status = (of) => page.locator(`${of} .status`).innerText();
  await page.locator("#present").getByRole("slider", { name: "After update" }).fill("2");
  assert.deepStrictEqual([await status("#present"), await status("#kept")], Array(2).fill("After 5 million cycles"));
  await page.locator("#present").getByRole("slider", { name: "Through the cycle" }).fill("19");
  for (const of of ["#present", "#kept"]) assert.match(await status(of), /^50 % of the last cycle/);
  await page.getByRole("button", { name: "Stop comparing" }).click();
}

// A key that the case has in braces is moved there.
async function otherForms(page) {
  const text = 'contact = { friction = 0.05 }\n[insert]\nedge_mm = 3.0\nlayers = 1\n[machine]\npreset = "stanmore-force"\nload_scale = 0.8\n';
  await ran(page, () => write(page, text));
  assert.strictEqual(await page.getByLabel("Loads, relative to the waveforms").inputValue(), "0.8");
  await ran(page, () => page.getByLabel("Loads, relative to the waveforms").fill("0.9"));
  await ran(page, () => page.getByLabel("Friction").fill("0.06"));
  assert.strictEqual(await page.locator("#case-text").inputValue(), text.replace("0.8", "0.9").replace("0.05", "0.06"));
}

// A link that was cut shows a message and no other case.
async function cutLink(browser, url, address) {
  const page = await (await browser.newContext()).newPage();
  await page.goto(url + new URL(address).hash.slice(0, -20));
  await page.waitForSelector("#failure:not([hidden])", { timeout: PATIENCE_MS });
  assert.match(await page.locator("#failure").innerText(), /the address is damaged/);
  assert.strictEqual(await page.locator("#case-text").inputValue(), "");
  await page.setViewportSize({ width: 1280, height: 900 });
  await keep(page, "damaged");
  await ran(page, () => page.getByLabel("Example").selectOption("Pin on disc"));
  assert(await page.locator("#failure").isHidden(), "the message stays");
  await page.context().close();
}

async function textWithFaults(page) {
  await write(page, "[contact]\nfrictoin = 0.04\n");
  await page.waitForSelector("#failure:not([hidden])");
  const told = await page.locator("#failure").innerText();
  assert.match(told, /no key `frictoin`[\s\S]*case\.toml:2:1[\s\S]*did you mean `friction`/, told);
  assert.match(await page.locator(".gutter .wrong").innerText(), /2/);
  await keep(page, "fault");
  await write(page, "[contact]\nfri");
  const offered = await page.locator(".offers").innerText();
  assert.match(offered, /friction/, offered);
  await page.keyboard.press("Enter");
  assert.strictEqual(await page.locator("#case-text").inputValue(), "[contact]\nfriction");
  await write(page, " \n");
  await page.waitForFunction(() => /the case is empty/.test(document.getElementById("failure").textContent));
  await ran(page, () => write(page, QUICK));
  assert(await page.locator("#failure").isHidden(), "the message stays");
}

async function cancelled(page) {
  const before = await runs(page);
  await write(page, QUICK.replace("3.0", "0.6").replace("updates = 3", "updates = 200"));
  await page.waitForSelector("html[data-busy]");
  await page.waitForFunction(() => /of 5 million/.test(document.getElementById("state").textContent));
  // The button moves as the line next to it grows, and a click that waits for it to rest may outlast the run.
  await page.getByRole("button", { name: "Stop" }).dispatchEvent("click");
  assert.match(await state(page), /stopped/);
  assert.strictEqual(await runs(page), before, "a run that was stopped is shown");
  await ran(page, () => write(page, QUICK));
}

async function dropped(page) {
  const files = ["femur.stl", "insert.stl"].map((name) => path.join(bodies, name));
  await drop(page, [{ name: "femur.stl", text: "solid x\nnonsense" }, { name: "insert.stl", text: "solid x\nnonsense" }]);
  await page.waitForSelector("#failure:not([hidden])");
  assert.match(await page.locator("#failure").innerText(), /femur\.stl:2: "nonsense" is not a keyword of STL/);
  await page.getByLabel("Choose two meshes").setInputFiles(files);
  await page.waitForFunction(() => /shape = "mesh"/.test(document.getElementById("case-text").value));
  const drafted = await page.locator("#case-text").inputValue();
  assert.match(drafted, /length_unit = "mm"/);
  assert.match(await page.locator("#remarks").innerText(), /length_unit "mm", which makes it 61\.8 mm/);
  const coarse = drafted.replace(/edge_mm = [\d.]+/, "edge_mm = 2.0").replace(/updates = 10 /, "updates = 2 ").replace(/increments = 200/, "increments = 60");
  await ran(page, () => write(page, coarse));
  assert(await page.getByLabel("Distal radius").isDisabled(), "a mesh has a radius");
  assert.strictEqual(new URL(page.url()).hash, "", "the address has another case than that of the meshes");
  await picture(page);
  await keep(page, "dropped");
  const waveform = { name: "gait.csv", text: "Gait cycle (%), force [N]\n0,300\n25,1500\n50,800\n" };
  const driven = `${QUICK}\n[machine.axial_force]\nfile = "gait.csv"\ninterpolation = "half-cosine"\n`;
  await ran(page, () => drop(page, [{ name: "walk.toml", text: driven }, waveform]));
  assert.strictEqual(await page.locator("#case-text").inputValue(), driven);
  assert.strictEqual(new URL(page.url()).hash, "", "the address has a case whose waveform it lacks");
  await drop(page, [waveform]);
  await page.waitForFunction(() => /gait\.csv is read/.test(document.getElementById("remarks").textContent));
}

// Files dropped on the page.
async function drop(page, files) {
  const transfer = await page.evaluateHandle((files) => {
    const transfer = new DataTransfer();
    for (const { name, text } of files) transfer.items.add(new File([text], name));
    return transfer;
  }, files);
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
}

async function saved(page) {
  await ran(page, () => write(page, QUICK));
  // After meshes, a case is in the address again.
  await page.waitForURL(/#case=/);
  // The time of the run that is shown must be that in the saved folder: the run is not solved again.
  fs.writeFileSync(path.join(made, "state.txt"), await state(page));
  for (const [name, file] of [["Save the results folder", "results.zip"], ["Save the report", "report.html"], ["Save the case", "case.toml"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
    assert.strictEqual(download.suggestedFilename(), file);
    await download.saveAs(path.join(made, file));
    if (file !== "case.toml") await page.waitForFunction((file) => document.getElementById("state").textContent.startsWith(`${file} is saved`), file);
  }
  assert.strictEqual(fs.readFileSync(path.join(made, "case.toml"), "utf8"), QUICK);
}

// What JavaScript holds, with the memory behind its arrays, MB, and nodes of the document.
async function memory(session) {
  await session.send("HeapProfiler.collectGarbage");
  const { usedSize, backingStorageSize = 0 } = await session.send("Runtime.getHeapUsage");
  const { nodes } = await session.send("Memory.getDOMCounters");
  return { mb: (usedSize + backingStorageSize) / 1e6, nodes };
}

async function twentyRuns(page) {
  const session = await page.context().newCDPSession(page);
  let early;
  await page.evaluate(() => (window.longTasks = []));
  for (let run = 0; run < 20; run++) {
    await ran(page, () => page.getByLabel("Friction").fill(run % 2 ? "0.12" : "0.16"));
    if (run === 4) early = await memory(session);
  }
  const late = await memory(session);
  assert(late.mb < early.mb + 8, `after 5 runs ${early.mb.toFixed(1)} MB, after 20 ${late.mb.toFixed(1)} MB`);
  assert(late.nodes < early.nodes + 100, `after 5 runs ${early.nodes} nodes, after 20 ${late.nodes}`);
  return { early, late, longTasks: await page.evaluate(() => window.longTasks) };
}

// Loaded once, the page needs no network.
async function offline(context, server, url) {
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  await page.goto(url);
  await page.evaluate(() => navigator.serviceWorker.ready);
  server.kill();
  await context.setOffline(true);
  await page.reload();
  await page.waitForSelector("html[data-ready] .stage canvas");
  await page.setViewportSize({ width: 390, height: 800 });
  await page.emulateMedia({ colorScheme: "dark" });
  await picture(page);
  const overhang = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert(overhang <= 0, `the page is ${overhang} px wider than a telephone`);
  // The picture stays in sight above the slider that changes it.
  await page.getByLabel("Friction").scrollIntoViewIfNeeded();
  const [stage, slider] = await Promise.all([page.locator(".stage").boundingBox(), page.getByLabel("Friction").boundingBox()]);
  assert(stage.y > -1 && stage.y + stage.height <= slider.y, `the picture is at ${stage.y} px, the slider at ${slider.y} px`);
  await keep(page, "telephone-slider");
  await page.evaluate(() => scrollTo(0, 0));
  await keep(page, "telephone");
}

async function main() {
  const { server, url } = await served(folder);
  const browser = await chromium.launch({ executablePath, args });
  try {
    const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true });
    const heard = [];
    const { page, ready_ms } = await open(context, url, heard);
    await picture(page);
    await keep(page, "first");
    const summary = await sameAsInNode(page);
    await numbers(page, summary);
    const solved_ms = await sliders(page);
    await dragged(page);
    await previewed(page);
    await freshStart(page);
    await remembered(page);
    await examples(page);
    await comparing(page);
    await comparingOthers(page);
    await otherForms(page);
    await cutLink(browser, url, page.url());
    await textWithFaults(page);
    await cancelled(page);
    await dropped(page);
    await saved(page);
    const { early, late, longTasks } = await twentyRuns(page);
    assert.deepStrictEqual(heard, [], "the page asks for other files or reports errors");
    await offline(context, server, url);
    assert(loaded() <= LARGEST_MB, `the first load is ${loaded().toFixed(2)} MB`);
    console.log(
      `first result after ${ready_ms} ms, a moved slider shown after ${solved_ms} ms, first load ${loaded().toFixed(2)} MB;` +
        ` after 5 runs ${early.mb.toFixed(1)} MB and ${early.nodes} nodes, after 20 ${late.mb.toFixed(1)} MB and ${late.nodes};` +
        ` ${longTasks.length} tasks above 50 ms in 20 runs, the longest ${Math.max(0, ...longTasks).toFixed(0)} ms`,
    );
  } finally {
    await browser.close();
    server.kill();
  }
}

main();
