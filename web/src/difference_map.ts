// The difference of a field between two runs, seen from above; their meshes may differ.

import { Box3 } from "three";
import { colourBar, ColourMap, type Range } from "./colours";
import { inDigits } from "./digits";
import { element } from "./dom";
import type { Field, Scene } from "./scene";

// Squares of the picture for each millimetre.
const SQUARES_A_MM = 4;
// The colours where the first has more, where both are equal, and where the second has more.
const COLOURS = ["#2166ac", "#f2f0ea", "#b2182b"];

// Values in squares; NaN beyond the surface.
interface Grid {
  values: Float32Array;
  width: number;
  height: number;
}

interface Frame {
  zLow: number;
  xHigh: number;
  width: number;
  height: number;
}

// Why the maps of two runs of a joint cannot be subtracted; undefined if they can. Those of a right and a left joint are mirror images.
export function obstacle(first: Pick<Scene, "facts">, second: Pick<Scene, "facts">): string | undefined {
  const [left, right] = [first, second].map(({ facts }) => facts.directions.join());
  return left === right ? undefined : "one is a right joint and the other a left one: medial is on opposite sides";
}

// The map of `field` after the last update of both runs; undefined if one of them lacks it.
export function differenceMap(first: Scene, second: Scene, { name, label, unit }: Field): HTMLElement | undefined {
  const runs = [first, second];
  if (runs.some(({ facts }) => !facts.updates.length || !facts.fields.some((field) => field.name === name))) return undefined;
  const frame = frameOf(runs);
  const [before, after] = runs.map((scene) => sampled(scene, name, frame)) as [Grid, Grid];
  const differences = after.values.map((value, square) => value - before.values[square]!);
  const largest = differences.reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
  const canvas = element("canvas", { width: frame.width, height: frame.height, role: "img", "aria-label": `Difference of ${label} seen from above` });
  const map = new ColourMap(COLOURS, COLOURS[0]);
  // Runs that are equal have the colour in the middle.
  const range: Range = [-(largest || 1), largest || 1];
  const picture = new ImageData(frame.width, frame.height);
  differences.forEach((value, square) => {
    if (Number.isFinite(value)) picture.data.set([...map.bytes(value, range), 255], 4 * square);
  });
  canvas.getContext("2d")!.putImageData(picture, 0, 0);
  const [front, back, left, right] = first.facts.directions;
  const around = (words: string | undefined, side: string) => element("span", { class: `side ${side}` }, words ?? "");
  const box = element("div", { class: "flat" }, around(front, "front"), around(left, "left"), canvas, around(right, "right"), around(back, "back"));
  const legend = element("div", { class: "legend" }, ...colourBar(map, range, `Difference of ${label.toLowerCase()}, ${unit}`));
  const most = element("p", { class: "note" }, `Red: more in this run; blue: more in the kept one. At most ${inDigits(largest)} ${unit}.`);
  return element("figure", { class: "difference" }, legend, box, most);
}

// The rectangle around both surfaces.
function frameOf(scenes: Scene[]): Frame {
  const { min, max } = scenes.map((scene) => new Box3().setFromArray(scene.values("surface.nodes"))).reduce((one, other) => one.union(other));
  return { zLow: min.z, xHigh: max.x, width: Math.ceil((max.z - min.z) * SQUARES_A_MM), height: Math.ceil((max.x - min.x) * SQUARES_A_MM) };
}

function sampled(scene: Scene, name: string, frame: Frame): Grid {
  const { width, height } = frame;
  const grid = { values: new Float32Array(width * height).fill(NaN), width, height };
  const [nodes, quads] = [scene.values("surface.nodes"), scene.whole("surface.quads")];
  const field = scene.field(name, scene.facts.updates.length - 1);
  const at = (node: number): Corner => ({
    across: (nodes[3 * node + 2]! - frame.zLow) * SQUARES_A_MM,
    down: (frame.xHigh - nodes[3 * node]!) * SQUARES_A_MM,
    value: field[node]!,
  });
  for (let i = 0; i < quads.length; i += 4) {
    const [a, b, c, d] = [0, 1, 2, 3].map((corner) => at(quads[i + corner]!)) as [Corner, Corner, Corner, Corner];
    fill(grid, a, b, c);
    fill(grid, a, c, d);
  }
  return grid;
}

interface Corner {
  across: number;
  down: number;
  value: number;
}

// Interpolates linearly at the middles of the squares within a triangle.
export function fill({ values, width, height }: Grid, a: Corner, b: Corner, c: Corner): void {
  const doubled = (p: Corner, q: Corner, across: number, down: number) => (q.across - p.across) * (down - p.down) - (q.down - p.down) * (across - p.across);
  const area = doubled(a, b, c.across, c.down);
  if (area === 0) return;
  const reach = (of: (corner: Corner) => number, end: number) => {
    const places = [a, b, c].map(of);
    return [Math.max(0, Math.floor(Math.min(...places) - 0.5)), Math.min(end - 1, Math.ceil(Math.max(...places) - 0.5))] as const;
  };
  const [[left, right], [top, bottom]] = [reach(({ across }) => across, width), reach(({ down }) => down, height)];
  for (let row = top; row <= bottom; row++) {
    for (let column = left; column <= right; column++) {
      const [across, down] = [column + 0.5, row + 0.5];
      const [ofC, ofA] = [doubled(a, b, across, down) / area, doubled(b, c, across, down) / area];
      const ofB = 1 - ofA - ofC;
      if (Math.min(ofA, ofB, ofC) >= -1e-6) values[row * width + column] = ofA * a.value + ofB * b.value + ofC * c.value;
    }
  }
}
