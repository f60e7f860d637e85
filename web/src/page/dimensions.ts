// Dimensions of generic bodies that are changed by dragging points of their picture.

import { Vector3 } from "three";
import { inDigits } from "../digits";
import type { Grip } from "../grips";
import type { Scene } from "../scene";
import { matrix } from "../stage";
import { numberIn, valuesOf, type Place } from "./case_text";
import type { Found } from "./shown_run";
import { type Limits, movedAt } from "./sliders";
import { unquoted } from "./toml_places";

// Sets the keys at some places to a number.
type Change = (places: Place[], value: number) => void;

interface Dimension extends Place {
  value: number;
}

// The slider of none.
const SPACING: Limits = { label: "Spacing", least: 30, most: 60, step: 0.5 };
const [UP, OUTWARDS] = [new Vector3(0, 1, 0), new Vector3(0, 0, 1)];

// Points of the generic bodies in their picture, and what they change.
export function gripsOf({ scene, text }: Found, change: Change): Grip[] {
  const values = valuesOf(text);
  return [...ofInsert(scene, values, change), ...ofFemur(scene, values, change)];
}

function ofInsert(scene: Scene, values: Map<string, string>, change: Change): Grip[] {
  const found = dimensionsOf(values, "insert", "spacing_mm", "sagittal_radius_mm", "coronal_radius_mm", "thickness_mm");
  if (!found) return [];
  const [spacing, sagittal, coronal, thickness] = found;
  const nodes = pointsOf(scene.values("surface.nodes"));
  const skin = pointsOf(scene.values("skin.nodes"));
  const low = nodes.filter(({ z }) => z > 0).reduce((one, two) => (two.y < one.y ? two : one));
  const far = (axis: "x" | "z", across: "x" | "z") => {
    const line = nodes.filter((node) => Math.abs(node[across] - low[across]) < NEAR_MM);
    return line.reduce((one, two) => (two[axis] > one[axis] ? two : one));
  };
  const [frontEnd, sideEnd] = [far("x", "z"), far("z", "x")];
  const bottom = Math.min(...skin.map(({ y }) => y));
  const both = isGeneric(values, "femur") ? [spacing, { table: "femur", key: "spacing_mm" }] : [spacing];
  const own = (place: Place, at: Vector3, value: (mm: number) => number) => grip(movedAt(place), at, UP, value, (mm) => change([place], mm));
  return [
    grip(
      SPACING,
      low,
      OUTWARDS,
      (mm) => spacing.value + 2 * mm,
      (mm) => change(both, mm),
    ),
    own(sagittal, frontEnd, (mm) => radius(sagittal.value, frontEnd.x - low.x, mm)),
    own(coronal, sideEnd, (mm) => radius(coronal.value, sideEnd.z - low.z, mm)),
    own(thickness, new Vector3(low.x, bottom, sideEnd.z), (mm) => thickness.value - mm),
  ];
}

// Each condyle is an arc about the origin of the femoral frame and, before a line through it, a larger one tangent to the first. The
// points are those of the medial condyle, away from the points of the insert.
function ofFemur(scene: Scene, values: Map<string, string>, change: Change): Grip[] {
  const found = dimensionsOf(values, "femur", "distal_radius_mm", "posterior_radius_mm", "coronal_radius_mm", "spacing_mm", "transition_deg");
  const pose = scene.facts.neutral_pose;
  if (!found || !scene.facts.has_femur || !pose) return [];
  const [distal, posterior, coronal, spacing, transition] = found;
  const [under, behind, across] = [distal.value, posterior.value, coronal.value];
  const angle = (transition.value * Math.PI) / 180;
  const low = new Vector3((under - behind) * Math.sin(angle), (under - behind) * Math.cos(angle) - under, -spacing.value / 2);
  const toInsert = matrix(pose);
  const own = (place: Place, at: Vector3, along: Vector3, value: (mm: number) => number): Grip => ({
    ...grip(movedAt(place), at.applyMatrix4(toInsert), along.clone().transformDirection(toInsert), value, (mm) => change([place], mm)),
    isOfFemur: true,
  });
  const [ahead, aside] = [HALF_PART * under, HALF_PART * across];
  const risen = (x: number, y: number, z: number) => new Vector3(low.x + x, low.y + y, low.z - z);
  return [
    own(distal, risen(ahead, rise(under, ahead), 0), UP, (mm) => radius(under, ahead, mm)),
    own(coronal, risen(0, rise(across, aside), aside), UP, (mm) => radius(across, aside, mm)),
    own(posterior, new Vector3(-behind, 0, low.z), new Vector3(-1, 0, 0), (mm) => behind + mm),
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

function isGeneric(values: Map<string, string>, table: string): boolean {
  return unquoted(values.get(`${table}.shape`) ?? "") === "generic";
}

// The dimensions of a generic body; none of another.
function dimensionsOf<K extends string[]>(values: Map<string, string>, table: string, ...keys: K): { [I in keyof K]: Dimension } | undefined {
  const found = keys.map((key) => ({ table, key, value: numberIn(values.get(`${table}.${key}`)) }));
  const isWhole = isGeneric(values, table) && found.every(({ value }) => value !== undefined);
  return isWhole ? (found as { [I in keyof K]: Dimension }) : undefined;
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
