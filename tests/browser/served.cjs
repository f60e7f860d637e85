// Serves a folder by web/serve.mjs on a free port.
const { spawn } = require("node:child_process");
const path = require("node:path");

module.exports = function served(folder) {
  const server = spawn(process.execPath, [path.join(__dirname, "../../web/serve.mjs"), folder, "0"], { stdio: ["ignore", "pipe", "inherit"] });
  return new Promise((done) => server.stdout.once("data", (url) => done({ server, url: String(url).trim() })));
};
