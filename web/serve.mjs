// Serves a folder that scripts/page made, to this machine only: node serve.mjs FOLDER [PORT]
import { createServer } from "node:http";
import { existsSync, readFileSync } from "node:fs";
import { extname, join, posix } from "node:path";

const [folder, port = "8080"] = process.argv.slice(2);
const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".txt": "text/plain; charset=utf-8",
  ".svg": "image/svg+xml",
  ".png": "image/png",
  ".woff2": "font/woff2",
  ".zz": "application/octet-stream",
};
const PACKED = [
  ["br", ".br"],
  ["gzip", ".gz"],
];

const server = createServer((request, response) => {
  // A path such as `//` is no URL, not even after a host.
  const pathname = request.url.split("?")[0];
  const file = join(folder, pathname.endsWith("/") ? `${pathname}index.html` : pathname);
  const type = TYPES[extname(file)];
  // Only a path that leads down is its own normal form.
  if (posix.normalize(pathname) !== pathname || pathname.includes("\\") || !type || !existsSync(file)) {
    response.writeHead(404).end();
    return;
  }
  const accepted = request.headers["accept-encoding"] ?? "";
  const [encoding, ending] = PACKED.find(([word, ending]) => accepted.includes(word) && existsSync(file + ending)) ?? [undefined, ""];
  const headers = { "Content-Type": type, "Cache-Control": "no-cache", ...(encoding && { "Content-Encoding": encoding }) };
  response.writeHead(200, headers).end(readFileSync(file + ending));
});
server.listen(Number(port), "127.0.0.1", () => console.log(`http://localhost:${server.address().port}/`));
