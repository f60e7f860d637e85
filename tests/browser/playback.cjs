// Measures how smoothly the gait cycle plays: node playback.cjs CHROMIUM FILE.html...
//
// Each file is a report in its results folder, in a window of 1400 x 900 px; everything is drawn by the processor. Prints a table;
// the processor time is that of all processes of the browser.
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const [executablePath, ...files] = process.argv.slice(2);
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const MEASURED_MS = 4000;
// Three frames of a screen take 50.0 ms, and the clock is not exact.
const LATE_MS = 51;

async function played(browser, file) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  page.setDefaultTimeout(120_000);
  await page.goto(pathToFileURL(file).href, { waitUntil: "load" });
  await page.waitForSelector("html[data-ready] .stage canvas");
  await page.getByRole("button", { name: "Play" }).click();
  // The first cycle finds its resolution and compiles what it draws with.
  await page.waitForTimeout(MEASURED_MS);
  const session = await browser.newBrowserCDPSession();
  const busy = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
  const before = await busy();
  const gaps = await page.evaluate(
    (measured_ms) =>
      new Promise((done) => {
        const times = [];
        const note = (now) => {
          times.push(now);
          if (now - times[0] < measured_ms) requestAnimationFrame(note);
          else done(times.slice(1).map((time, at) => time - times[at]));
        };
        requestAnimationFrame(note);
      }),
    MEASURED_MS,
  );
  const busy_s = (await busy()) - before;
  await page.close();
  const total_ms = gaps.reduce((sum, gap) => sum + gap, 0);
  return { fps: (1000 * gaps.length) / total_ms, longest_ms: Math.max(...gaps), late: gaps.filter((gap) => gap > LATE_MS).length, frame_ms: (1000 * busy_s) / gaps.length };
}

async function main() {
  const browser = await chromium.launch({ executablePath, args });
  console.log("| case | frames a second | longest gap | gaps above 50 ms in 4 s | processor time for a frame |\n| --- | --- | --- | --- | --- |");
  for (const file of files) {
    const { fps, longest_ms, late, frame_ms } = await played(browser, file);
    const [name] = path.dirname(file).split(path.sep).slice(-1);
    console.log(`| ${name} | ${fps.toFixed(0)} | ${longest_ms.toFixed(0)} ms | ${late} | ${frame_ms.toFixed(0)} ms |`);
  }
  await browser.close();
}

main();
