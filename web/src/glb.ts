// Bodies as a file for other programs: binary glTF 2.0 (Khronos Group, ISO/IEC 12113), in metres with y upwards.

import { Box3, type Mesh } from "three";

const [MAGIC, VERSION, JSON_CHUNK, BINARY_CHUNK] = [0x46546c67, 2, 0x4e4f534a, 0x004e4942];
const [ARRAY, ELEMENTS] = [34962, 34963];
const [FLOAT, UNSIGNED_INT] = [5126, 5125];
const M_A_MM = 0.001;

export interface Body {
  name: string;
  mesh: Mesh;
  // Red, green, blue in linear light, and opacity; white where the vertices have colours.
  colour: [number, number, number, number];
}

export function glb(title: string, bodies: Body[]): Blob {
  const data = new Data();
  const meshes = bodies.map(({ name, mesh: { geometry } }, material) => {
    const attribute = (key: string) => geometry.getAttribute(key);
    const attributes: Record<string, number> = {};
    for (const [of, key] of [
      ["POSITION", "position"],
      ["NORMAL", "normal"],
      ["COLOR_0", "color"],
    ] as const) {
      if (attribute(key)) attributes[of] = data.add(attribute(key).array as Float32Array, "VEC3", key === "position");
    }
    const triangles = Uint32Array.from(geometry.index!.array);
    return { name, primitives: [{ attributes, indices: data.add(triangles, "SCALAR"), material }] };
  });
  const materials = bodies.map(({ name, colour }) => ({
    name,
    pbrMetallicRoughness: { baseColorFactor: colour, metallicFactor: 0, roughnessFactor: 0.7 },
    ...(colour[3] < 1 ? { alphaMode: "BLEND", doubleSided: true } : {}),
  }));
  const nodes = bodies.map(({ name, mesh }, index) => ({ name, mesh: index, matrix: mesh.matrix.toArray() }));
  // One node around all bodies has the unit.
  const all = { name: title || "condyle", children: nodes.map((_, index) => index), scale: [M_A_MM, M_A_MM, M_A_MM] };
  const { accessors, bufferViews, bytes } = data;
  return packed(
    {
      asset: { version: "2.0", generator: "condyle" },
      scene: 0,
      scenes: [{ nodes: [nodes.length] }],
      nodes: [...nodes, all],
      meshes,
      materials,
      accessors,
      bufferViews,
      buffers: [{ byteLength: bytes }],
    },
    data.parts,
    bytes,
  );
}

class Data {
  readonly accessors: object[] = [];
  readonly bufferViews: object[] = [];
  readonly parts: (Float32Array | Uint32Array)[] = [];
  bytes = 0;

  // All numbers have four bytes, so that all begin at multiples of four.
  add(values: Float32Array | Uint32Array, type: "VEC3" | "SCALAR", hasBounds = false): number {
    const isFloat = values instanceof Float32Array;
    this.bufferViews.push({ buffer: 0, byteOffset: this.bytes, byteLength: values.byteLength, target: isFloat ? ARRAY : ELEMENTS });
    const box = hasBounds ? new Box3().setFromArray(values) : undefined;
    const bounds = box && { min: box.min.toArray(), max: box.max.toArray() };
    const count = type === "VEC3" ? values.length / 3 : values.length;
    this.parts.push(values);
    this.bytes += values.byteLength;
    return this.accessors.push({ bufferView: this.bufferViews.length - 1, componentType: isFloat ? FLOAT : UNSIGNED_INT, count, type, ...bounds }) - 1;
  }
}

function packed(head: object, parts: ArrayBufferView[], bytes: number): Blob {
  const text = new TextEncoder().encode(JSON.stringify(head));
  const padding = (4 - (text.length % 4)) % 4;
  const words = (...all: number[]) => Uint32Array.from(all);
  const total = 12 + 8 + text.length + padding + 8 + bytes;
  const chunk = [words(text.length + padding, JSON_CHUNK), text, new Uint8Array(padding).fill(0x20), words(bytes, BINARY_CHUNK)];
  return new Blob([words(MAGIC, VERSION, total), ...chunk, ...parts] as BlobPart[], { type: "model/gltf-binary" });
}
