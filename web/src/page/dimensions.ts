// Dimensions of a generic insert that are changed by dragging points of its picture.

import { Vector3 } from "three";
import { inDigits } from "../digits";
import type { Grip } from "../grips";
import { numberOf, valueAt, type Place } from "./case_text";
import type { Found } from "./shown_run";

// Smallest and largest value, and the step, mm: those of the sliders.
type Limits = [least: number, most: number, step: number];

// Points of a generic insert, in its picture, and what they change.
export function gripsOf({ scene, text }: Found, change: (places: Place[], value: number) => void): Grip[] {
  const of = (key: string): Place => ({ table: "insert", key });
  const [spacing, sagittal, coronal, thickness] = ["spacing_mm", "sagittal_radius_mm", "coronal_radius_mm", "thickness_mm"].map(of);
  const [apart, side, front, thick] = [spacing!, sagittal!, coronal!, thickness!].map((place) => numberOf(text, place));
  if (valueAt(text, of("shape")) !== "generic" || !apart || !side || !front || !thick) return [];
  const grip = (name: string, at: Vector3, along: Vector3, limits: Limits, places: Place[], value: (mm: number) => number): Grip => {
    const within = (mm: number) => inSteps(value(mm), limits);
    return { at, along, words: (mm) => `${name} ${inDigits(within(mm))} mm`, dropped: (mm) => change(places, within(mm)) };
  };
  const nodes = pointsOf(scene.values("surface.nodes"));
  const skin = pointsOf(scene.values("skin.nodes"));
  const low = nodes.filter(({ z }) => z > 0).reduce((one, two) => (two.y < one.y ? two : one));
  const far = (axis: "x" | "z", across: "x" | "z") => {
    const line = nodes.filter((node) => Math.abs(node[across] - low[across]) < NEAR_MM);
    return line.reduce((one, two) => (two[axis] > one[axis] ? two : one));
  };
  const [frontEnd, sideEnd] = [far("x", "z"), far("z", "x")];
  const bottom = Math.min(...skin.map(({ y }) => y));
  const [up, outwards] = [new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
  const femur = { table: "femur", key: "spacing_mm" };
  const both = valueAt(text, { table: "femur", key: "shape" }) === "generic" ? [spacing!, femur] : [spacing!];
  return [
    grip("Spacing", low, outwards, [30, 60, 0.5], both, (mm) => apart + 2 * mm),
    grip("Radius from the side", frontEnd, up, [42, 120, 1], [sagittal!], (mm) => radius(side, frontEnd.x - low.x, mm)),
    grip("Radius from the front", sideEnd, up, [25, 100, 1], [coronal!], (mm) => radius(front, sideEnd.z - low.z, mm)),
    grip("Thickness", new Vector3(low.x, bottom, sideEnd.z), up, [4, 15, 0.5], [thickness!], (mm) => thick - mm),
  ];
}

// Half the width of the row of nodes through the lowest point, mm: more than half an edge.
const NEAR_MM = 1.5;

// The radius of an arc whose end, `half` mm from its lowest point, rises by some mm more than with `before`.
function radius(before: number, half: number, more: number): number {
  const rise = Math.max(before - Math.sqrt(before * before - half * half) + more, 0.1);
  return (half * half + rise * rise) / (2 * rise);
}

function inSteps(value: number, [least, most, step]: Limits): number {
  return Math.min(most, Math.max(least, Math.round(value / step) * step));
}

function pointsOf(places: Float32Array): Vector3[] {
  return Array.from({ length: places.length / 3 }, (_, node) => new Vector3().fromArray(places, 3 * node));
}
