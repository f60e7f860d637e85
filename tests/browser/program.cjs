// Runs a case by the program of the web page, in Node: node program.cjs PROGRAM.cjs WASM CASE RESULTS FOLDER
//
// What it finds must be what the command found in RESULTS, to 1e-9. What it wrote is put into FOLDER.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");

const [program, wasm, caseFile, results, folder] = process.argv.slice(2);
const { call } = require(path.resolve(program));

const REACH = 1e-9;
// Errors are small differences of numbers: 1e-9 of the number whose error it is.
const OF_ERRORS = "error";
// The neutral pose has places and turns that are about nothing: 1e-9 mm, and of one.
const NEAR_NOTHING = "summary.neutral_pose";
const OF_A_CLOCK = new Set(["wall_s"]);

function ran(module) {
  const files = { "case.toml": new Uint8Array(fs.readFileSync(caseFile)) };
  const began = performance.now();
  const answer = call(module, { words: ["run", "case.toml", "results", "scene"], files, outputs: ["results", "scene"] }, () => {});
  assert.strictEqual(answer.failure, null);
  return { files: answer.files, took_s: (performance.now() - began) / 1000 };
}

// Holds two values against each other, and gives the largest difference, of the reach.
function compare(found, wanted, place, size) {
  if (typeof wanted === "number") {
    const allowed = REACH * Math.max(Math.abs(wanted), place.startsWith(NEAR_NOTHING) ? 1 : size);
    const off = found === wanted ? 0 : Math.abs(found - wanted) / allowed;
    assert(off <= 1, `${place}: ${found} here, ${wanted} by the command`);
    return off;
  }
  if (wanted === null || typeof wanted !== "object") {
    assert.strictEqual(found, wanted, place);
    return 0;
  }
  assert.deepStrictEqual(Object.keys(found), Object.keys(wanted), place);
  const names = Object.keys(wanted).filter((name) => !OF_A_CLOCK.has(name));
  return Math.max(0, ...names.map((name) => compare(found[name], wanted[name], `${place}.${name}`, sizeOf(name, place, size))));
}

let summary;
function sizeOf(name, place, size) {
  if (place !== OF_ERRORS) return size;
  // Parts of an error in % are parts of a hundred.
  return name.endsWith("_percent") ? 100 : (summary[name] ?? size);
}

function main() {
  const compiling = performance.now();
  const module = new WebAssembly.Module(fs.readFileSync(wasm));
  const compiled_s = (performance.now() - compiling) / 1000;
  const runs = [ran(module), ran(module), ran(module)];
  const text = (bytes) => new TextDecoder().decode(bytes);
  summary = JSON.parse(fs.readFileSync(path.join(results, "summary.json"), "utf8"));
  const found = JSON.parse(text(runs[2].files["results/summary.json"]));
  const { error: foundError, ...foundRest } = found;
  const { error, ...rest } = summary;
  const off = Math.max(compare(foundRest, rest, "summary", 0), compare(foundError, error, OF_ERRORS, 0));
  assert(Buffer.from(runs[0].files.scene).equals(Buffer.from(runs[2].files.scene)), "two runs differ");
  fs.mkdirSync(folder, { recursive: true });
  for (const name of ["scene", "results/summary.json"]) fs.writeFileSync(path.join(folder, path.basename(name)), runs[2].files[name]);
  const solver = (of) => of.wall_s + of.error.wall_s;
  const ratio = solver(found) / solver(summary);
  console.log(
    `largest difference ${(off * REACH).toExponential(1)}; compiled in ${compiled_s.toFixed(2)} s, first call ${runs[0].took_s.toFixed(2)} s, third ${runs[2].took_s.toFixed(2)} s;` +
      ` solver and estimate ${solver(found).toFixed(3)} s, ${ratio.toFixed(1)} times the command's`,
  );
}

main();
