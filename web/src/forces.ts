// The vertical forces on the surface, from the pressures of an instant.

import { Vector3 } from "three";
import type { Pressed } from "./scene";
import type { Force } from "./stage";

// The share of each node of the surface as it is seen from above, mm²: the integral of its shape function over the faces around it,
// by which a slope presses downwards.
export function shares(places: Float32Array, quads: ArrayLike<number>): Float32Array {
  const share = new Float32Array(places.length / 3);
  const at = (node: number) => new Vector3().fromArray(places, 3 * node);
  for (let i = 0; i < quads.length; i += 1) {
    const corner = (step: number) => quads[i - (i % 4) + ((i + step) % 4)]!;
    const own = at(corner(0));
    const [next, across, before] = [1, 2, 3].map((step) => at(corner(step)).sub(own)) as [Vector3, Vector3, Vector3];
    // The Jacobian of a face is linear: its value at the centroid of the shape function counts.
    const one = across.clone().sub(before).addScaledVector(next, 2);
    const other = across.clone().sub(next).addScaledVector(before, 2);
    share[corner(0)]! += one.cross(other).y / 36;
  }
  return share;
}

// The force of each side at its centre of pressure, left (z below 0) and right, or that of the whole surface; MPa times mm² is N.
export function forces({ nodes, pressures }: Pressed, places: Float32Array, share: Float32Array, hasSides: boolean): Force[] {
  const sides = [0, 1].map((): Force => ({ newtons: 0, at: new Vector3() }));
  nodes.forEach((node, index) => {
    const side = sides[hasSides && places[3 * node + 2]! < 0 ? 0 : 1]!;
    const newtons = pressures[index]! * share[node]!;
    side.newtons += newtons;
    side.at.addScaledVector(new Vector3().fromArray(places, 3 * node), newtons);
  });
  const pressed = sides.filter(({ newtons }) => newtons > 0);
  for (const { at, newtons } of pressed) at.divideScalar(newtons);
  return pressed;
}
