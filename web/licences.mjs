// The licence texts of bundled packages, which must accompany their code.
import { existsSync, readFileSync } from "node:fs";

export function licences(packages) {
  const texts = packages.map((name) => {
    const folder = `node_modules/${name}`;
    const { version, homepage, repository } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = ["LICENSE", "LICENSE.md", "LICENSE.txt", "LICENSE-MIT"].find((known) => existsSync(`${folder}/${known}`));
    if (!file) throw new Error(`${folder} has no licence text: add its file name to web/licences.mjs`);
    return `${name} ${version}, ${homepage ?? repository.url}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
  });
  return texts.join(`\n${"-".repeat(80)}\n\n`);
}
