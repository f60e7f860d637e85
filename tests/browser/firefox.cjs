// Opens the web page and a report in Firefox, on a screen: xvfb-run node firefox.cjs FIREFOX PAGE REPORT.html NODE PICTURES
//
// PAGE is the folder of the page; NODE has the summary.json that its program found in Node, whose numbers must be the same.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const puppeteer = require("puppeteer-core");
const served = require("./served.cjs");

const [executablePath, folder, report, node, pictures] = process.argv.slice(2);
const PATIENCE_MS = 180_000;

async function opened(browser, url) {
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  await page.setViewport({ width: 1280, height: 900 });
  const heard = [];
  page.on("pageerror", (error) => heard.push(String(error)));
  await page.goto(url);
  await page.waitForSelector("html[data-ready] .stage canvas[data-still]");
  return { page, heard };
}

const picture = (page) => page.$eval(".stage canvas", (canvas) => canvas.toDataURL());
const mass = (page) => page.$eval("[data-number=mass_loss_mg]", (value) => value.textContent);

async function usePage(browser, url) {
  const { page, heard } = await opened(browser, url);
  const summary = JSON.parse(fs.readFileSync(path.join(node, "summary.json"), "utf8"));
  const before = await mass(page);
  assert(before.startsWith(String(Number(summary.mass_loss_mg.toPrecision(4)))), `${before}, in Node ${summary.mass_loss_mg} mg`);
  await page.evaluate(() => {
    const slider = [...document.querySelectorAll(".slider")].find(({ textContent }) => textContent.startsWith("Friction"));
    slider.querySelector("input").value = "0.12";
    slider.querySelector("input").dispatchEvent(new Event("input"));
  });
  await page.waitForFunction(() => document.documentElement.dataset.runs === "2");
  assert.notStrictEqual(await mass(page), before, "a slider does not change the mass");
  await page.screenshot({ path: path.join(pictures, "firefox-page.png") });
  assert.deepStrictEqual(heard, []);
  // Without a screen, Firefox has no WebGL.
  assert(await page.$eval(".stage", (stage) => !/WebGL is off/.test(stage.textContent)), "the bodies are not in 3-D");
}

async function useReport(browser) {
  const { page, heard } = await opened(browser, pathToFileURL(report).href);
  const before = await picture(page);
  await page.evaluate(() => {
    const slider = [...document.querySelectorAll(".slider")].find(({ textContent }) => textContent.startsWith("Through the cycle"));
    slider.querySelector("input").value = "30";
    slider.querySelector("input").dispatchEvent(new Event("input"));
  });
  await page.waitForFunction((before) => document.querySelector(".stage canvas").toDataURL() !== before, {}, before);
  await page.screenshot({ path: path.join(pictures, "firefox-report.png") });
  assert.deepStrictEqual(heard, []);
}

async function main() {
  const { server, url } = await served(folder);
  const browser = await puppeteer.launch({ browser: "firefox", executablePath, headless: false });
  try {
    await usePage(browser, url);
    await useReport(browser);
    console.log(`${await browser.version()}: the numbers of Node, and bodies in 3-D`);
  } finally {
    await browser.close();
    server.kill();
  }
}

main();
