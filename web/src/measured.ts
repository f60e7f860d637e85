// What a laboratory measured, laid over the curves of a run.

import type { Curve, Curves } from "./plots";
import type { Scene } from "./scene";

const GREY = "#7a828a";

// Curves over cycles, with what specimens lost.
export function withWeighings(curves: Curves, scene: Scene): Curves {
  const specimens = scene.columns("measured_wear").filter((name) => name !== "cycles");
  if (curves.up.name !== "mass_loss_mg" || !specimens.length) return curves;
  const weighed = [...scene.column("measured_wear", "cycles")].map((cycles) => cycles / 1e6);
  const at = [...new Set([...curves.at, ...weighed])].sort((a, b) => a - b);
  const run = curves.curves.map((curve) => ({ ...curve, values: spread(curve.values, curves.at, at) }));
  const measured = specimens.map((name, index): Curve => {
    const values = spread([...scene.column("measured_wear", name)], weighed, at);
    return { name: `weighed ${index + 1}`, colour: GREY, values, isDotted: true };
  });
  return { ...curves, at, curves: [...run, ...measured] };
}

// Curves over the cycle, with what was measured at their instants.
export function withMeasured(curves: Curves, scene: Scene): Curves {
  if (!scene.columns("measured_kinematics").includes(curves.up.name)) return curves;
  const percents = [...scene.column("measured_kinematics", "percent")];
  const measured = [...scene.column("measured_kinematics", curves.up.name)];
  const values = spread(measured, percents, curves.at);
  return { ...curves, curves: [...curves.curves, { name: "measured", colour: GREY, values }] };
}

// Values at other places: none where there was none.
function spread(values: (number | null)[], from: number[], to: number[]): (number | null)[] {
  const at = new Map(from.map((place, index) => [place, values[index] ?? null]));
  return to.map((place) => {
    const value = at.get(place) ?? null;
    return value !== null && Number.isFinite(value) ? value : null;
  });
}
