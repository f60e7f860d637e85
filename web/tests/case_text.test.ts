import assert from "node:assert/strict";
import test from "node:test";
import { numberIn, tableAtEnd, valuesOf, withValue, type Place } from "../src/page/case_text";
import { unquoted } from "../src/page/toml_places";

const CASE = `side = "left" # of the patient

[insert]
shape = "generic"
thickness_mm = 9.0           # where it is thinnest

[machine.axial_force]
knots_n = [
  [0, 167],
  [50, 2600]
]

[march]
cycles = 5_000_000

[[activity]]
name = "gait"
cycles = 3
`;
const thickness = { table: "insert", key: "thickness_mm" };
const cycles = { table: "march", key: "cycles" };
const scale = { table: "machine.axial_force", key: "scale" };

const numberOf = (text: string, { table, key }: Place) => numberIn(valuesOf(text).get(`${table}.${key}`));

test("values are found by table and key", () => {
  assert.equal(numberOf(CASE, thickness), 9);
  assert.equal(numberOf(CASE, cycles), 5e6);
  assert.equal(numberOf(CASE, { table: "activity", key: "cycles" }), 3);
  assert.equal(numberOf(CASE, scale), undefined);
  assert.equal(unquoted(valuesOf(CASE).get("side")!), "left");
  assert.equal(unquoted(valuesOf(CASE).get("insert.shape")!), "generic");
});

test("a line has the table of the heading above it", () => {
  assert.equal(tableAtEnd("unit = 1\n[mach"), "");
  assert.equal(tableAtEnd(CASE.slice(0, CASE.indexOf("  [50"))), "machine.axial_force");
  for (const heading of ["[ joints . load ] # of all", "[[joints]]\n[[joints]]\n[joints.load]", '[joints.load]\na = 1\n[wear]\n["joints".load]']) {
    assert.equal(tableAtEnd(`${heading}\nscale = `), "joints.load", heading);
  }
});

test("only the number changes, and a remark stays in its column", () => {
  assert.equal(withValue(CASE, thickness, "10.5"), CASE.replace("9.0           #", "10.5          #"));
  assert.equal(withValue(CASE, cycles, "1000000"), CASE.replace("5_000_000", "1000000"));
});

test("a missing key is added to its table, after values of several lines, or with a new table", () => {
  assert.equal(withValue(CASE, scale, "1.2"), CASE.replace("2600]\n]\n", "2600]\n]\nscale = 1.2\n"));
  const friction = withValue(CASE, { table: "contact", key: "friction" }, "0.1");
  assert.equal(friction, `${CASE.trimEnd()}\n\n[contact]\nfriction = 0.1\n`);
});

test("values are found and changed in every form of TOML", () => {
  const radius = { table: "femur", key: "distal_radius_mm" };
  for (const form of [
    "femur.distal_radius_mm = 45.0",
    'femur = { shape = "generic", distal_radius_mm = 45.0 }',
    '["femur"]\ndistal_radius_mm = 45.0',
    '[ femur ]\n"distal_radius_mm"=45.0# of both',
  ]) {
    assert.equal(numberOf(form, radius), 45, form);
    assert.equal(withValue(form, radius, "50.0"), form.replace("45.0", "50.0"), form);
  }
  assert.equal(numberOf('[machine]\npreset = "a" # [x]\naxial_force.scale = 0.8\n', scale), 0.8);
});

test("a missing key is added in the form of its table", () => {
  for (const [form, wanted] of [
    ["[machine]\naxial_force.offset = 2 # N\n[wear]\nk = 1\n", "[machine]\naxial_force.offset = 2 # N\naxial_force.scale = 1.2\n[wear]\nk = 1\n"],
    ['machine = { preset = "a" }\n', 'machine = { preset = "a", axial_force.scale = 1.2 }\n'],
    ["[machine]\naxial_force = {}", "[machine]\naxial_force = { scale = 1.2 }"],
    ["[ machine . axial_force ] # load\n", "[ machine . axial_force ] # load\nscale = 1.2\n"],
    ["machine.axial_force.offset = 2", "machine.axial_force.offset = 2\nmachine.axial_force.scale = 1.2"],
    ['[machine]\npreset = "a"\n', '[machine]\npreset = "a"\n\n[machine.axial_force]\nscale = 1.2\n'],
  ] as const) {
    assert.equal(withValue(form, scale, "1.2"), wanted, form);
  }
});

test("a value that is not closed ends above the next heading", () => {
  for (const open of ["a = { x = 1", "a = [[0, 1],\n  [1, 2]", "a = [ # [b]"]) assert.equal(tableAtEnd(`${open}\n[march]\n`), "march", open);
});

test("text that is no TOML is read to its end", () => {
  for (const text of ["[", "a = [1, 2", "= 3\nb = 4", '"', "x = {", "]]\n}}"]) valuesOf(text);
  assert.equal(numberOf("= 3\n[insert]\nthickness_mm = 4", thickness), 4);
});
