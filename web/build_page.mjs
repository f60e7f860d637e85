// Bundles the page: node build_page.mjs WASM FOLDER [BOOK]
//
// BOOK is the address of the book from the page; without it, the page has no link to one.
// The folder is then a static site, with each file also compressed by brotli and gzip.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { brotliCompressSync, gzipSync } from "node:zlib";
import { licences } from "./licences.mjs";

const [wasm, folder, book] = process.argv.slice(2);

// Of the schema, completion needs tables, keys and words with the first sentence of their meanings, as a line of a list has room for:
// without the rest, the first load is smaller.
function forCompletion({ properties, items, anyOf, enum: words, description, type }) {
  const named = properties && Object.fromEntries(Object.entries(properties).map(([name, key]) => [name, forCompletion(key)]));
  const isTable = type === "object" ? type : undefined;
  const meaning = description?.split(/(?<=\.) /)[0];
  return { properties: named, items: items && forCompletion(items), anyOf: anyOf?.map(forCompletion), enum: words, description: meaning, type: isTable };
}

const schemas = {
  name: "schemas",
  setup: (made) =>
    made.onLoad({ filter: /\.schema\.json$/ }, ({ path }) => ({
      contents: JSON.stringify(forCompletion(JSON.parse(readFileSync(path, "utf8")))),
      loader: "json",
    })),
};

async function bundled(entry, define = {}) {
  const { outputFiles } = await build({
    entryPoints: [`src/page/${entry}.ts`],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    legalComments: "none",
    loader: { ".css": "text", ".toml": "text" },
    define,
    plugins: [schemas],
    write: false,
  });
  return outputFiles[0].contents;
}

const files = {
  "index.html": Buffer.from(readFileSync("index.html", "utf8").replace("<!-- book -->", book ? `<a href="${book}/">Documentation</a>` : "")),
  "page.js": await bundled("page"),
  "worker.js": await bundled("worker"),
  "condyle-web.wasm": readFileSync(wasm),
  "licences.txt": Buffer.from(licences(["three", "uplot", "@bjorn3/browser_wasi_shim"])),
};
// Loaded only when a report is saved.
const LATER = "moving.js.zz";
files[LATER] = readFileSync(`../crates/condyle-report/src/page/${LATER}`);
const hash = createHash("sha256");
for (const bytes of Object.values(files)) hash.update(bytes);
files["service_worker.js"] = await bundled("service_worker", {
  FILES: JSON.stringify(["./", ...Object.keys(files).filter((name) => name !== "index.html")]),
  VERSION: JSON.stringify(hash.digest("hex").slice(0, 16)),
});

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
console.log("compressing the page");
const sizes = [0, 0];
for (const [name, bytes] of Object.entries(files)) {
  const [brotli, gzip] = [brotliCompressSync(bytes), gzipSync(bytes, { level: 9 })];
  writeFileSync(`${folder}/${name}`, bytes);
  writeFileSync(`${folder}/${name}.br`, brotli);
  writeFileSync(`${folder}/${name}.gz`, gzip);
  if (name === LATER) continue;
  sizes[0] += brotli.length;
  sizes[1] += gzip.length;
}
console.log(`the page: ${(sizes[0] / 1e6).toFixed(2)} MB as brotli, ${(sizes[1] / 1e6).toFixed(2)} MB as gzip`);
