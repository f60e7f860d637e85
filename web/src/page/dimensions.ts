// Dimensions of generic bodies that are changed by dragging points of their picture.

import { Vector3 } from "three";
import { inDigits } from "../digits";
import type { Grip } from "../grips";
import type { Scene } from "../scene";
import { matrix } from "../stage";
import { numberOf, valueAt, type Place } from "./case_text";
import type { Found } from "./shown_run";
import { type Limits, movedAt } from "./sliders";

// Sets the keys at some places to a number.
type Change = (places: Place[], value: number) => void;

// The slider of none.
const SPACING: Limits = { label: "Spacing", least: 30, most: 60, step: 0.5 };
const [UP, OUTWARDS] = [new Vector3(0, 1, 0), new Vector3(0, 0, 1)];

// Points of the generic bodies in their picture, and what they change.
export function gripsOf({ scene, text }: Found, change: Change): Grip[] {
  return [...ofInsert(scene, text, change), ...ofFemur(scene, text, change)];
}

function ofInsert(scene: Scene, text: string, change: Change): Grip[] {
  const [spacing, sagittal, coronal, thickness] = ["spacing_mm", "sagittal_radius_mm", "coronal_radius_mm", "thickness_mm"].map((key) => ({
    table: "insert",
    key,
  }));
  const [apart, side, front, thick] = [spacing!, sagittal!, coronal!, thickness!].map((place) => numberOf(text, place));
  if (!isGeneric(text, "insert") || !apart || !side || !front || !thick) return [];
  const nodes = pointsOf(scene.values("surface.nodes"));
  const skin = pointsOf(scene.values("skin.nodes"));
  const low = nodes.filter(({ z }) => z > 0).reduce((one, two) => (two.y < one.y ? two : one));
  const far = (axis: "x" | "z", across: "x" | "z") => {
    const line = nodes.filter((node) => Math.abs(node[across] - low[across]) < NEAR_MM);
    return line.reduce((one, two) => (two[axis] > one[axis] ? two : one));
  };
  const [frontEnd, sideEnd] = [far("x", "z"), far("z", "x")];
  const bottom = Math.min(...skin.map(({ y }) => y));
  const both = isGeneric(text, "femur") ? [spacing!, { table: "femur", key: "spacing_mm" }] : [spacing!];
  const own = (place: Place, at: Vector3, value: (mm: number) => number) => grip(movedAt(place), at, UP, value, (mm) => change([place], mm));
  return [
    grip(
      SPACING,
      low,
      OUTWARDS,
      (mm) => apart + 2 * mm,
      (mm) => change(both, mm),
    ),
    own(sagittal!, frontEnd, (mm) => radius(side, frontEnd.x - low.x, mm)),
    own(coronal!, sideEnd, (mm) => radius(front, sideEnd.z - low.z, mm)),
    own(thickness!, new Vector3(low.x, bottom, sideEnd.z), (mm) => thick - mm),
  ];
}

// Each condyle is an arc about the origin of the femoral frame and, before a line through it, a larger one tangent to the first. The
// points are those of the medial condyle, away from the points of the insert.
function ofFemur(scene: Scene, text: string, change: Change): Grip[] {
  const [distal, posterior, coronal, spacing, transition] = [
    "distal_radius_mm",
    "posterior_radius_mm",
    "coronal_radius_mm",
    "spacing_mm",
    "transition_deg",
  ].map((key) => ({ table: "femur", key }));
  const [under, behind, across, apart, turn] = [distal!, posterior!, coronal!, spacing!, transition!].map((place) => numberOf(text, place));
  const pose = scene.facts.neutral_pose;
  if (!isGeneric(text, "femur") || !scene.facts.has_femur || !pose || !under || !behind || !across || !apart || turn === undefined) return [];
  const angle = (turn * Math.PI) / 180;
  const low = new Vector3((under - behind) * Math.sin(angle), (under - behind) * Math.cos(angle) - under, -apart / 2);
  const toInsert = matrix(pose);
  const own = (place: Place, at: Vector3, along: Vector3, value: (mm: number) => number): Grip => ({
    ...grip(movedAt(place), at.applyMatrix4(toInsert), along.clone().transformDirection(toInsert), value, (mm) => change([place], mm)),
    isOfFemur: true,
  });
  const [ahead, aside] = [HALF_PART * under, HALF_PART * across];
  const risen = (x: number, y: number, z: number) => new Vector3(low.x + x, low.y + y, low.z - z);
  return [
    own(distal!, risen(ahead, rise(under, ahead), 0), UP, (mm) => radius(under, ahead, mm)),
    own(coronal!, risen(0, rise(across, aside), aside), UP, (mm) => radius(across, aside, mm)),
    own(posterior!, new Vector3(-behind, 0, low.z), new Vector3(-1, 0, 0), (mm) => behind + mm),
  ];
}

// Distance of a point of the femur from the lowest one, as a part of the radius: where the arcs still exist.
const HALF_PART = 0.6;
// Half the width of the row of nodes through the lowest point, mm: more than half an edge.
const NEAR_MM = 1.5;

function grip({ label, least, most, step }: Limits, at: Vector3, along: Vector3, value: (mm: number) => number, dropped: (mm: number) => void): Grip {
  const within = (mm: number) => Math.min(most, Math.max(least, Math.round(value(mm) / step) * step));
  return { at, along, words: (mm) => `${label} ${inDigits(within(mm))} mm`, dropped: (mm) => dropped(within(mm)) };
}

function isGeneric(text: string, table: string): boolean {
  return valueAt(text, { table, key: "shape" }) === "generic";
}

// The height above its lowest point of an arc, `half` mm beside it.
function rise(radius: number, half: number): number {
  return radius - Math.sqrt(radius * radius - half * half);
}

// The radius of an arc that rises by some mm more than with `before`.
function radius(before: number, half: number, more: number): number {
  const height = Math.max(rise(before, half) + more, 0.1);
  return (half * half + height * height) / (2 * height);
}

function pointsOf(places: Float32Array): Vector3[] {
  return Array.from({ length: places.length / 3 }, (_, node) => new Vector3().fromArray(places, 3 * node));
}
