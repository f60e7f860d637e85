import assert from "node:assert/strict";
import test from "node:test";
import { femurByName } from "../src/page/dropped";
import { packed, unpacked } from "../src/page/memory";
import { CaseSchema } from "../src/page/schema";
import { zip } from "../src/page/zip";

test("the femur is the file whose name fits, if only one way fits", () => {
  const named = (name: string) => ({ name });
  const [femur, insert] = [named("Femur_left.stl"), named("tibial_insert.stl")];
  assert.equal(femurByName(femur, insert), femur);
  assert.equal(femurByName(insert, femur), femur);
  assert.equal(femurByName(named("a.stl"), named("b.stl")), undefined);
});

test("the schema offers tables, keys and words", () => {
  const law = { enum: ["linear", "log"], description: "The pressure law." };
  const schema = new CaseSchema({ properties: { contact: { properties: { law, friction: { type: "number" } } } } });
  assert.deepEqual(
    schema.tables().map(({ word }) => word),
    ["contact"],
  );
  assert.deepEqual(
    schema.keys("contact").map(({ word }) => word),
    ["law", "friction"],
  );
  assert.deepEqual(
    schema.values("contact", "law").map(({ word }) => word),
    ['"linear"', '"log"'],
  );
  assert.equal(schema.about("contact", "law"), "The pressure law.");
});

test("a case comes back from its address", async () => {
  const text = 'title = "Gelenk − 膝"\n[contact]\nfriction = 0.1\n'.repeat(40);
  const letters = await packed(text);
  assert.match(letters, /^[\w-]+$/);
  assert.ok(letters.length < text.length / 4);
  assert.equal(await unpacked(letters), text);
  assert.equal(await unpacked(letters.slice(5)), undefined);
  assert.equal(await unpacked("%"), undefined);
});

test("the same files give the same zip", async () => {
  const files = { "results/wear.csv": new TextEncoder().encode("cycles\n1\n") };
  const [one, two] = await Promise.all([zip(files), zip(files)]);
  const bytes = new Uint8Array(await one.arrayBuffer());
  assert.deepEqual(bytes, new Uint8Array(await two.arrayBuffer()));
  assert.deepEqual([...bytes.subarray(0, 4)], [0x50, 0x4b, 3, 4]);
});
