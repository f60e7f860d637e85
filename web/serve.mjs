// Serves a folder that build_page.mjs made, to this machine only: node serve.mjs FOLDER [PORT]
import { createServer } from "node:http";
import { existsSync, readFileSync } from "node:fs";
import { basename, extname, join } from "node:path";

const [folder, port = "8080"] = process.argv.slice(2);
const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".wasm": "application/wasm", ".txt": "text/plain; charset=utf-8" };
const PACKED = [
  ["br", ".br"],
  ["gzip", ".gz"],
];

const server = createServer((request, response) => {
  // A path such as `//` is no URL, not even after a host.
  const pathname = request.url.split("?")[0];
  // All files are in one folder: paths into others are refused.
  const name = pathname === "/" ? "index.html" : basename(pathname);
  const type = TYPES[extname(name)];
  const file = join(folder, name);
  if ((pathname !== "/" && pathname !== `/${name}`) || !type || !existsSync(file)) {
    response.writeHead(404).end();
    return;
  }
  const accepted = request.headers["accept-encoding"] ?? "";
  const [encoding, ending] = PACKED.find(([word]) => accepted.includes(word)) ?? [undefined, ""];
  const headers = { "Content-Type": type, "Cache-Control": "no-cache", ...(encoding && { "Content-Encoding": encoding }) };
  response.writeHead(200, headers).end(readFileSync(file + ending));
});
server.listen(Number(port), "127.0.0.1", () => console.log(`http://localhost:${server.address().port}/`));
