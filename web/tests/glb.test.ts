import assert from "node:assert/strict";
import test from "node:test";
import { Box3, BufferAttribute, BufferGeometry, Matrix4, Mesh, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { glb } from "../src/glb";

test("a reader of glTF finds the bodies in metres, with colours and at their places", async () => {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.of(0, 0, 0, 10, 0, 0, 0, 20, 0, 0, 0, 30), 3));
  geometry.setAttribute("color", new BufferAttribute(Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0.5, 0.5), 3));
  geometry.setIndex(new BufferAttribute(Uint16Array.of(0, 1, 2, 0, 2, 3), 1));
  const moved = new Mesh(geometry);
  moved.matrix = new Matrix4().makeTranslation(100, 0, 0);
  const file = glb("A < B", [
    { name: "insert", mesh: new Mesh(geometry), colour: [1, 1, 1, 1] },
    { name: "femur", mesh: moved, colour: [0.5, 0.5, 0.5, 0.3] },
  ]);
  // The loader asks a browser's global for its own name.
  Object.assign(globalThis, { self: globalThis });
  const { scene } = await new GLTFLoader().parseAsync(await file.arrayBuffer(), "");
  const [insert, femur] = ["insert", "femur"].map((name) => scene.getObjectByName(name) as Mesh);
  assert(insert && femur && scene.getObjectByName("A_<_B"));
  const bounds = (mesh: Mesh) => new Box3().setFromObject(mesh, true);
  assert(bounds(insert).max.distanceTo(new Vector3(0.01, 0.02, 0.03)) < 1e-9);
  assert(bounds(femur).min.distanceTo(new Vector3(0.1, 0, 0)) < 1e-9);
  assert.deepEqual([...insert.geometry.getAttribute("color").array], [1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0.5, 0.5]);
  assert.deepEqual([...insert.geometry.index!.array], [0, 1, 2, 0, 2, 3]);
});
