// Bundles the report's program: node build.mjs [FOLDER]
//
// The bundle, which the crate of the report embeds, is committed: an installation by cargo needs no Node.
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
writeFileSync(`${folder}/moving.licences.txt`, licences(["three", "uplot"]));
console.log(`moving.js: ${outputFiles[0].contents.length} bytes`);
