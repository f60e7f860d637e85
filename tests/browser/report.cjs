// Opens a report in a headless browser: node report.cjs CHROMIUM REPORT.html
//
// The page must ask for nothing but itself, report no error, and show its maps.
const assert = require("node:assert");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const [executablePath, report] = process.argv.slice(2);
const url = pathToFileURL(report).href;

async function open() {
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  const requests = [];
  const errors = [];
  page.on("request", (request) => requests.push(request.url()));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(url, { waitUntil: "load" });
  return { browser, page, requests, errors };
}

// Pictures with their title and whether they have a size on the screen.
function pictures(page) {
  return page.$$eval("svg", (all) =>
    all.map((svg) => {
      const { width, height } = svg.getBoundingClientRect();
      const title = svg.querySelector("title")?.textContent ?? svg.getAttribute("aria-label") ?? "";
      return { title, isSeen: width > 50 && height > 50 };
    }),
  );
}

// How far the page is wider than a screen of the given width.
async function overhang(page, width) {
  await page.setViewportSize({ width, height: 800 });
  return page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
}

async function main() {
  const { browser, page, requests, errors } = await open();
  try {
    const outside = requests.filter((request) => request !== url && !request.startsWith("data:"));
    assert.deepStrictEqual(outside, [], "the page asks for other files");
    assert.deepStrictEqual(errors, [], "the page reports errors");
    const shown = (await pictures(page)).filter((picture) => picture.isSeen);
    const titles = shown.map((picture) => picture.title.toLowerCase());
    for (const word of ["wear", "pressure", "sliding"]) {
      assert(titles.some((title) => title.includes(word)), `no picture of ${word} among: ${titles}`);
    }
    assert((await page.title()) !== "", "the page has no title");
    assert((await overhang(page, 390)) <= 0, "the page is wider than a telephone");
    console.log(`${shown.length} pictures, no request, no error`);
  } finally {
    await browser.close();
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
