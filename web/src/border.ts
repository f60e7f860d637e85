// The border of the articulating surface, whose nodes the walls of the insert share.

// A place closer than this to a node is the node, mm: above the resolution of the scene, below the length of any edge.
const SAME_PLACE_MM = 0.02;

// Pairs of a vertex of the walls and the node of the surface at the same place.
export function sharedNodes(walls: Float32Array, surface: Float32Array, quads: ArrayLike<number>): [vertex: number, node: number][] {
  const border = borderOf(quads);
  // Most pairs differ in x: no array is made for each of a million.
  const isNear = (vertex: number, node: number, axis: number) => Math.abs(walls[3 * vertex + axis]! - surface[3 * node + axis]!) < SAME_PLACE_MM;
  const isAt = (vertex: number) => (node: number) => isNear(vertex, node, 0) && isNear(vertex, node, 1) && isNear(vertex, node, 2);
  return Array.from({ length: walls.length / 3 }, (_, vertex) => [vertex, border.find(isAt(vertex))] as const).filter(
    (pair): pair is [number, number] => pair[1] !== undefined,
  );
}

// Nodes at edges of one face only.
function borderOf(quads: ArrayLike<number>): number[] {
  const open = new Map<string, [number, number]>();
  for (let i = 0; i < quads.length; i++) {
    const [from, to] = [quads[i]!, quads[i % 4 === 3 ? i - 3 : i + 1]!];
    // The face on the other side has the edge in the other direction.
    if (!open.delete(`${to} ${from}`)) open.set(`${from} ${to}`, [from, to]);
  }
  return [...new Set([...open.values()].flat())];
}
