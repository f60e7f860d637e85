// The licence texts of the packages whose code is bundled: their licences ask for them wherever the code goes.
import { existsSync, readFileSync } from "node:fs";

const BUNDLED = ["three", "uplot"];

export function licences() {
  const texts = BUNDLED.map((name) => {
    const folder = `node_modules/${name}`;
    const { version, homepage } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = ["LICENSE", "LICENSE.md", "LICENSE.txt"].find((known) => existsSync(`${folder}/${known}`));
    if (!file) throw new Error(`${folder} has no licence text: say in web/licences.mjs where it is`);
    return `${name} ${version}, ${homepage}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
  });
  return texts.join(`\n${"-".repeat(80)}\n\n`);
}
