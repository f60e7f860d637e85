import assert from "node:assert/strict";
import test from "node:test";
import { forces, shares } from "../src/forces";

// A face of 2 by 1 mm that rises by 1 mm over its width, and a level one of 1 mm² at the other side.
const PLACES = Float32Array.from(
  [
    [1, 0, 1],
    [0, 0, 1],
    [1, 1, 3],
    [0, 1, 3],
    [1, 0, -2],
    [0, 0, -2],
    [1, 0, -1],
    [0, 0, -1],
  ].flat(),
);
const QUADS = [0, 1, 3, 2, 4, 5, 7, 6];
const PRESSED = { nodes: Uint16Array.from([0, 1, 2, 3, 4, 5, 6, 7]), pressures: new Float32Array(8).fill(3) };

test("pressure on a slope presses downwards as on its area seen from above", () => {
  const [left, right, ...more] = forces(PRESSED, PLACES, shares(PLACES, QUADS), true);
  assert.equal(more.length, 0);
  assert.ok(Math.abs(left!.newtons - 3) < 1e-6 && Math.abs(right!.newtons - 6) < 1e-6, `${left!.newtons} and ${right!.newtons} N`);
  assert.deepEqual([left!.at.z, right!.at.z], [-1.5, 2]);
});

test("a surface without sides has one force", () => {
  const [all, ...more] = forces(PRESSED, PLACES, shares(PLACES, QUADS), false);
  assert.equal(more.length, 0);
  assert.ok(Math.abs(all!.newtons - 9) < 1e-6);
});
