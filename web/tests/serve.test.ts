import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";

test("the server refuses odd paths and goes on", async () => {
  const folder = mkdtempSync(join(tmpdir(), "condyle-serve-"));
  writeFileSync(join(folder, "index.html"), "page");
  const server = spawn(process.execPath, ["serve.mjs", folder, "0"], { stdio: ["ignore", "pipe", "inherit"] });
  const [url] = await once(server.stdout, "data");
  const status = async (path: string) => {
    const asked = request(String(url).trim(), { path }).end();
    const [answer] = await once(asked, "response");
    answer.resume();
    return answer.statusCode;
  };
  for (const path of ["/book", "//", "///", "//x:y", "/../index.html", "/%"]) {
    assert.equal(await status(path), 404, path);
  }
  assert.equal(await status("/"), 200);
  assert.equal(await status("/index.html?again"), 200);
  server.kill();
  rmSync(folder, { recursive: true });
});
