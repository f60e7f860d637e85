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
  const sides = [new Side(), new Side()];
  nodes.forEach((node, index) => {
    const side = sides[hasSides && places[3 * node + 2]! < 0 ? 0 : 1]!;
    side.add(pressures[index]! * share[node]!, new Vector3().fromArray(places, 3 * node));
  });
  return sides.filter((side) => side.newtons > 0).map((side) => side.force());
}

class Side {
  newtons = 0;
  private readonly moment = new Vector3();

  add(newtons: number, at: Vector3): void {
    this.newtons += newtons;
    this.moment.addScaledVector(at, newtons);
  }

  force(): Force {
    return { newtons: this.newtons, at: this.moment.clone().divideScalar(this.newtons) };
  }
}
