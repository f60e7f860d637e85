// Opens the static site of scripts/page --out: node site.cjs CHROMIUM SITE PICTURES
//
// Every link within the site must lead to a file, and the page must run in a frame of a page from elsewhere.
const assert = require("node:assert");
const fs = require("node:fs");
const http = require("node:http");
const path = require("node:path");
const { chromium } = require("playwright-core");
const served = require("./served.cjs");

const [executablePath, site, pictures] = process.argv.slice(2);
const PATIENCE_MS = 180_000;
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

// Links to nowhere, of all pages; those of print.html are the same, those of 404.html lead from wherever it is shown.
function broken() {
  const pages = fs.readdirSync(site, { recursive: true }).filter((name) => /\.html$/.test(name) && !/(print|404)\.html$/.test(name));
  assert(pages.length > 40, `only ${pages.length} pages`);
  return pages.flatMap((name) => {
    const links = [...fs.readFileSync(path.join(site, name), "utf8").matchAll(/(?:href|src)="([^"#?]+)/g)].map(([, link]) => link);
    const inside = links.filter((link) => !/^[a-z]+:/.test(link));
    return inside.filter((link) => !fs.existsSync(path.join(site, path.dirname(name), link))).map((link) => `${name}: ${link}`);
  });
}

// A page of another server that shows the site in a frame.
async function framed(browser, url) {
  const host = http.createServer((_, response) => response.end(`<!DOCTYPE html><title>elsewhere</title><iframe src="${url}" width="1000" height="700"></iframe>`));
  await new Promise((done) => host.listen(0, "127.0.0.1", done));
  const page = await browser.newPage({ viewport: { width: 1040, height: 740 } });
  page.setDefaultTimeout(PATIENCE_MS);
  await page.goto(`http://127.0.0.1:${host.address().port}/`);
  const frame = page.frameLocator("iframe");
  await frame.locator("html[data-ready] .stage canvas[data-still]").waitFor();
  assert.match(await frame.locator("[data-number=mass_loss_mg]").innerText(), /^\d/);
  await page.waitForTimeout(500);
  assert(await frame.locator("#failure").isHidden(), await frame.locator("#failure").innerText());
  assert(!(await frame.locator("h1").isVisible()), "the frame repeats the heading");
  await page.screenshot({ path: path.join(pictures, "framed.png") });
  await page.close();
  host.close();
}

async function main() {
  assert.deepStrictEqual(broken(), [], "links lead to nothing");
  const { server, url } = await served(site);
  const browser = await chromium.launch({ executablePath, args });
  try {
    await framed(browser, url);
    const page = await browser.newPage();
    await page.goto(url);
    await page.getByRole("link", { name: "Documentation" }).click();
    await page.waitForURL(/\/book\/$/);
    assert.match(await page.title(), /condyle/);
    assert((await page.locator("nav a").count()) > 30, "the book has no contents");
    console.log("the site is whole, and its page runs in a frame");
  } finally {
    await browser.close();
    server.kill();
  }
}

main();
