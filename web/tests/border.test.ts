import assert from "node:assert/strict";
import test from "node:test";
import { sharedNodes } from "../src/border";

// Two by two faces; the node in the middle is no border.
const SURFACE = Float32Array.from([0, 1, 2].flatMap((x) => [0, 1, 2].map((z) => [x, 0, z])).flat());
const QUADS = [0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7];

test("vertices of the walls follow the nodes of the border at their place", () => {
  const walls = Float32Array.from([0, -5, 0, 2, 0.001, 1, 0, 0, 0, 1, 0, 1, 2, 0, 1].flat());
  assert.deepEqual(sharedNodes(walls, SURFACE, QUADS), [
    [1, 7],
    [2, 0],
    [4, 7],
  ]);
});
