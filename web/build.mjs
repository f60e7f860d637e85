// Bundles the report's program: node build.mjs [FOLDER]
//
// The bundle, which the crate of the report embeds, is committed: an installation by cargo needs no Node.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { createHash } from "node:crypto";
import { deflateSync } from "node:zlib";
import { licences } from "./licences.mjs";

const [folder = "../crates/condyle-report/src/page"] = process.argv.slice(2);

const { outputFiles } = await build({
  entryPoints: ["src/report.ts"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "ascii",
  legalComments: "none",
  loader: { ".css": "text" },
  write: false,
});
writeFileSync(`${folder}/moving.js.zz`, deflateSync(outputFiles[0].contents, { level: 9 }));
// The scripts that a report may run.
const scripts = [readFileSync("../crates/condyle-report/src/page/loader.js"), outputFiles[0].contents];
const hashes = scripts.map((script) => `'sha256-${createHash("sha256").update(script).digest("base64")}'`);
writeFileSync(`${folder}/moving.hashes.txt`, `${hashes.join(" ")}\n`);
writeFileSync(`${folder}/moving.licences.txt`, licences(["three", "uplot"]));
console.log(`moving.js: ${outputFiles[0].contents.length} bytes`);
