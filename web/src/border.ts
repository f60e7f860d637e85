// The border of the articulating surface, whose nodes the walls of the insert share.

// A place closer than this to a node is the node, mm: above the resolution of the scene, below the length of any edge.
const SAME_PLACE_MM = 0.02;

// Pairs of a vertex of the walls and the node of the surface at the same place.
export function sharedNodes(walls: Float32Array, surface: Float32Array, quads: ArrayLike<number>): [vertex: number, node: number][] {
  const border = borderOf(quads, surface.length / 3);
  const pairs: [number, number][] = [];
  for (let at = 0; at < walls.length; at += 3) {
    const isNear = (node: number, axis: number) => Math.abs(walls[at + axis]! - surface[3 * node + axis]!) < SAME_PLACE_MM;
    const node = border.find((one) => isNear(one, 0) && isNear(one, 1) && isNear(one, 2));
    if (node !== undefined) pairs.push([at / 3, node]);
  }
  return pairs;
}

// Nodes at edges of one face only.
function borderOf(quads: ArrayLike<number>, nodes: number): number[] {
  const open = new Map<number, [number, number]>();
  for (let i = 0; i < quads.length; i++) {
    const [from, to] = [quads[i]!, quads[i % 4 === 3 ? i - 3 : i + 1]!];
    // The face on the other side has the edge in the other direction.
    if (!open.delete(to * nodes + from)) open.set(from * nodes + to, [from, to]);
  }
  return [...new Set([...open.values()].flat())];
}
