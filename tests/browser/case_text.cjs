// How the page finds and changes numbers in the text of a case: node case_text.cjs CASE_TEXT.cjs
const assert = require("node:assert");
const path = require("node:path");
const { numberOf, tableAt, valueOf, withValue } = require(path.resolve(process.argv[2]));

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

assert.strictEqual(numberOf(CASE, thickness), 9);
assert.strictEqual(numberOf(CASE, cycles), 5e6);
assert.strictEqual(numberOf(CASE, { table: "activity", key: "cycles" }), 3);
assert.strictEqual(numberOf(CASE, scale), undefined);
assert.strictEqual(valueOf(CASE, { table: "", key: "side" }), "left");
assert.strictEqual(valueOf(CASE, { table: "insert", key: "shape" }), "generic");
assert.strictEqual(tableAt(CASE.split("\n"), 9), "machine.axial_force");

// Nothing but the number changes, and a remark stays in its column.
assert.strictEqual(withValue(CASE, thickness, "10.5"), CASE.replace("9.0           #", "10.5          #"));
assert.strictEqual(withValue(CASE, cycles, "1000000"), CASE.replace("5_000_000", "1000000"));
// What is not there is added to its table, behind values of several lines, or with a table of its own.
assert.strictEqual(withValue(CASE, scale, "1.2"), CASE.replace("2600]\n]\n", "2600]\n]\nscale = 1.2\n"));
assert.strictEqual(withValue(CASE, { table: "contact", key: "friction" }, "0.1"), `${CASE.trimEnd()}\n\n[contact]\nfriction = 0.1\n`);
