import assert from "node:assert/strict";
import test from "node:test";
import { femurByName } from "../src/page/dropped";
import { valuesOf } from "../src/page/case_text";
import { Memory, packed, unpacked } from "../src/page/memory";
import { CaseSchema } from "../src/page/schema";
import { shownAt } from "../src/page/sliders";
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

// The browser's address and its history, and what it stores.
function browser(hash: string) {
  const location = { hash, pathname: "/page/", search: "" };
  const pushed: { state: { text: string } | null; address: string }[] = [];
  const stored = new Map<string, string>();
  const listeners: ((event: { state: unknown }) => void)[] = [];
  const history = { pushState: (state: { text: string } | null, _: string, address: string) => pushed.push({ state, address }) };
  const localStorage = { getItem: (key: string) => stored.get(key) ?? null, setItem: (key: string, text: string) => stored.set(key, text) };
  const addEventListener = (_: string, listener: (event: { state: unknown }) => void) => listeners.push(listener);
  Object.assign(globalThis, { location, history, localStorage, addEventListener });
  return { location, pushed, stored, goTo: (state: unknown) => listeners.forEach((listener) => listener({ state })) };
}

test("the address has no case while meshes are shown, and that of the next case after them", async () => {
  const { location, pushed, stored, goTo } = browser("");
  const memory = new Memory("generic");
  assert.equal(await memory.recalled(), "generic");
  await memory.remember("knee", true);
  await memory.remember("of meshes", false);
  await memory.remember("hip", true);
  assert.deepEqual(
    pushed.map(({ address }) => address),
    [`#case=${await packed("knee")}`, "/page/", `#case=${await packed("hip")}`],
  );
  assert.deepEqual([...stored.values()], ["hip"]);
  // Back to the meshes, which this visit still has.
  location.hash = "";
  const returned = new Promise((done) => memory.onReturn(done));
  goTo(pushed[1]!.state);
  assert.equal(await returned, "of meshes");
});

test("a damaged address has no case, not even that of the last visit", async () => {
  const whole = `#case=${await packed("[contact]\nfriction = 0.1\n".repeat(9))}`;
  for (const hash of [whole.slice(0, -4), "#case=%%%"]) {
    browser(hash).stored.set("condyle.case", "of the last visit");
    assert.equal(await new Memory("generic").recalled(), undefined, hash);
  }
});

test("a slider has the number of the case, its default, or why it has none", () => {
  const varus = { table: "femur", key: "varus_deg", shapes: ["generic", "mesh"] };
  const load = { table: "machine", key: "load_scale" };
  const friction = { table: "contact", key: "friction" };
  const knee = {
    joint: "knee",
    values: valuesOf('[femur]\nshape = "generic"\nvarus_deg = 0.0\n[contact]\nfriction = 0.07\n[machine]\nload_scale = 1.0\n'),
  };
  const hip = { joint: "hip", values: valuesOf('[femur]\nshape = "sphere"\nvarus_deg = 0.0\n[contact]\nfriction = 0.05\n') };
  const shown = (moved: typeof friction, text: string, of?: typeof knee) => shownAt(moved, valuesOf(text), of);
  assert.equal(shown(varus, "femur.varus_deg = 2", knee), 2);
  assert.equal(shown(varus, "", knee), 0);
  assert.equal(shown(varus, "", hip), "not of this joint");
  assert.equal(shown({ ...varus, key: "distal_radius_mm", shapes: ["generic"] } as typeof varus, '[femur]\nshape = "mesh"', knee), "not of this shape");
  assert.equal(shown(load, "machine.load_scale = 0.8", knee), 0.8);
  assert.equal(shown(load, "", knee), 1);
  assert.equal(shown(friction, "", hip), 0.05);
  assert.equal(shown(friction, ""), "–");
});

test("the same files give the same zip", async () => {
  const files = { "results/wear.csv": new TextEncoder().encode("cycles\n1\n") };
  const [one, two] = await Promise.all([zip(files), zip(files)]);
  const bytes = new Uint8Array(await one.arrayBuffer());
  assert.deepEqual(bytes, new Uint8Array(await two.arrayBuffer()));
  assert.deepEqual([...bytes.subarray(0, 4)], [0x50, 0x4b, 3, 4]);
});
