import assert from "node:assert/strict";
import test from "node:test";
import { fill, obstacle } from "../src/difference_map";
import { changed, inWords } from "../src/page/case_text";
import { headlinesOf } from "../src/page/numbers";

test("the settings that differ are listed by table and key", () => {
  const before = 'title = "A"\n[femur]\nradius_mm = 24.0 # of a condyle\n[[laws]]\nk = 1\n[[laws]]\nk = 2\n';
  const after = 'title = "A"\n[femur]\nradius_mm = 26.0\nspacing_mm = 46\n[[laws]]\nk = 1\n[[laws]]\nk = 3\n';
  assert.deepEqual(changed(before, after), [
    ["femur.radius_mm", "24.0", "26.0"],
    ["laws 2.k", "2", "3"],
    ["femur.spacing_mm", undefined, "46"],
  ]);
  assert.deepEqual(changed(before, before), []);
});

test("settings of several lines differ by all of their numbers", () => {
  const load = (peak: number) => `[machine.axial_force]\nknots_n = [\n    [0.0, 167.6], [3.0, 1887.3], [7.0, 1174.6],\n    [13.0, ${peak}],\n]\n`;
  const [key, before, after] = changed(load(2600.3), load(4160.48))[0]!;
  assert.equal(key, "machine.axial_force.knots_n");
  assert.equal(inWords(before, after), "other points");
  assert.deepEqual(changed(load(2600.3), load(2600.3)), []);
  const [, , only] = changed("", load(1))[0]!;
  assert.equal(inWords(undefined, only), "not given → points");
  assert.equal(inWords("[0, 1]", "[0, 2]"), "[0, 1] → [0, 2]");
});

test("tables below a list have its number", () => {
  const joints = (peak: number) => `[[joints]]\nname = "a"\n[joints.load]\nscale = 1\n[[joints]]\nname = "b"\n[joints.load]\nscale = ${peak}\n`;
  assert.deepEqual(changed(joints(1), joints(2)), [["joints 2.load.scale", "1", "2"]]);
});

test("maps of a right and a left joint are not subtracted", () => {
  const scene = (directions: string[]) => ({ facts: { directions } }) as Parameters<typeof obstacle>[0];
  const right = scene(["Anterior", "Posterior", "Medial", "Lateral"]);
  const left = scene(["Anterior", "Posterior", "Lateral", "Medial"]);
  assert.equal(obstacle(right, right), undefined);
  assert.match(obstacle(right, left)!, /a right joint and the other a left one/);
});

test("numbers that neither run has are left out", () => {
  const hip = { mass_loss_mg: 101.8, ap_range_mm: null as unknown as number };
  assert.deepEqual(
    headlinesOf(hip).map(({ key }) => key),
    ["mass_loss_mg"],
  );
  assert.deepEqual(
    headlinesOf(hip, { ap_range_mm: 5 }).map(({ key }) => key),
    ["mass_loss_mg", "ap_range_mm"],
  );
});

test("a triangle has the linear field of its corners, whichever way it turns", () => {
  const corner = (across: number, down: number) => ({ across, down, value: 2 * across - down + 1 });
  const corners = [corner(0.2, 0.1), corner(7.9, 1), corner(2, 7.7)] as const;
  for (const [a, b, c] of [corners, [...corners].reverse()] as const) {
    const grid = { values: new Float32Array(64).fill(NaN), width: 8, height: 8 };
    fill(grid, a!, b!, c!);
    const found = [...grid.values].map((value, at) => [value, 2 * ((at % 8) + 0.5) - (Math.floor(at / 8) + 0.5) + 1] as const);
    const inside = found.filter(([value]) => Number.isFinite(value));
    assert(inside.length > 20 && inside.length < 40, `${inside.length} squares`);
    for (const [value, wanted] of inside) assert(Math.abs(value - wanted) < 1e-5, `${value}, not ${wanted}`);
  }
});
