// Bundles the report's program: node build.mjs [FOLDER]
//
// What the crate of the report embeds is committed, since whoever installs it by cargo has no Node.
import { build } from "esbuild";
import { writeFileSync } from "node:fs";
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
writeFileSync(`${folder}/moving.licences.txt`, licences());
console.log(`moving.js: ${outputFiles[0].contents.length} bytes`);
