import assert from "node:assert/strict";
import test from "node:test";
import { chartSvg } from "../src/chart_svg";
import { ColourMap, roundMarks } from "../src/colours";
import { activityOf, aligned, csv } from "../src/plots";
import { cyclesInWords, inDigits } from "../src/digits";
import { Scene, type Chart } from "../src/scene";

const CHART: Chart = {
  id: "w-mass_loss_mg",
  group: "wear",
  title: "Mass <loss>",
  unit: "mg",
  positive: "",
  from_zero: true,
  min_span: 0,
  x_title: "million cycles",
  cycles_per_x: 1e6,
  curves: [
    { name: "Mass loss", style: "last", has_dots: true, x: [0, 0.5, 1], y: [0, 4, 8] },
    { name: "specimen 1, weighed", style: "specimen", has_dots: true, x: [0.5, 0.75], y: [Number.NaN, 6] },
  ],
};

test("curves of different instants share one horizontal axis", () => {
  const [at, run, specimen] = aligned(CHART);
  assert.deepEqual(at, [0, 0.5, 0.75, 1]);
  assert.deepEqual(run, [0, 4, undefined, 8]);
  assert.deepEqual(specimen, [undefined, null, 6, undefined]);
});

test("the CSV names the unit of its horizontal axis", () => {
  const [head, , half, later] = csv(CHART).split("\n");
  assert.equal(head, "million_cycles,mass_loss_mg_mass_loss,mass_loss_mg_specimen_1_weighed");
  assert.equal(half, "0.5,4,");
  assert.equal(later, "0.75,,6");
});

test("a chart of an activity has the column of that activity's table", () => {
  const chart = { ...CHART, id: "k-flexion_degstairs", group: "cyclestairs", curves: CHART.curves.slice(0, 1) };
  assert.equal(activityOf(chart), "stairs");
  assert.equal(csv(chart).split("\n")[0], "million_cycles,flexion_deg");
  assert.equal(activityOf({ group: "cycle" }), "");
});

test("a chart becomes an SVG file with escaped text", () => {
  const svg = chartSvg(CHART);
  assert.ok(svg.includes("Mass &lt;loss>") && !svg.includes("NaN"));
  assert.equal(svg.match(/<polyline/g)?.length, 2);
});

test("a colour bar has round marks inside of its range", () => {
  assert.deepEqual(roundMarks([0, 0.2437]), [0, 0.05, 0.1, 0.15, 0.2]);
  assert.deepEqual(roundMarks([-3, 7.2]), [-2, 0, 2, 4, 6]);
  assert.deepEqual(roundMarks([2, 2]), [2]);
});

test("nothing has the colour of polyethylene, and much is the last colour", () => {
  const map = new ColourMap(["#fcfdbf", "#721f81", "#0c0927"]);
  assert.equal(map.css(0, [0, 4]), "rgb(242,240,234)");
  assert.equal(map.css(4, [0, 4]), "rgb(12,9,39)");
  const light = new Float32Array(6);
  map.paint([0, 4], [0, 4], light);
  assert.ok(light[0]! > 0.8 && light[3]! < 0.01);
});

test("numbers read as in the report", () => {
  assert.equal(inDigits(-0.123456), "−0.1235");
  assert.equal(cyclesInWords(2.5e6), "2.5 million cycles");
});

// A scene of one chart, encoded as condyle does.
function encoded(values: number[]): ArrayBuffer {
  const arrays = ["x", "y"].map((axis, index) => ({ name: `chart.c.0.${axis}`, kind: "f64", offset: 8 * values.length * index, length: values.length }));
  const curves = [{ name: "a", style: "last", has_dots: false }];
  const facts = { charts: [{ ...CHART, id: "c", curves }] };
  const text = JSON.stringify({ facts, arrays });
  const head = new TextEncoder().encode(text.padEnd(Math.ceil(text.length / 8) * 8));
  const bytes = new Uint8Array(8 + head.length + 16 * values.length);
  new DataView(bytes.buffer).setBigUint64(0, BigInt(head.length), true);
  bytes.set(head, 8);
  bytes.set(new Uint8Array(new Float64Array([...values, ...values]).buffer), 8 + head.length);
  return bytes.buffer;
}

test("a scene has the charts that were encoded", () => {
  const [chart] = new Scene(encoded([1, 2.5])).charts();
  assert.equal(chart?.title, "Mass <loss>");
  assert.deepEqual(Array.from(chart?.curves[0]?.y ?? []), [1, 2.5]);
});
