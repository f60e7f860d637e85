// The bodies in three dimensions.

import {
  ArrowHelper,
  BackSide,
  Box3,
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  FrontSide,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Raycaster,
  Scene as World,
  Sphere,
  Spherical,
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { sharedNodes } from "./border";
import type { ColourMap, Range } from "./colours";
import { element } from "./dom";
import { FlatStage } from "./flat_stage";
import type { Body } from "./glb";
import { Grips, type Grip } from "./grips";
import { Matter } from "./matter";
import type { Pose, Scene } from "./scene";

export type Axis = "x" | "z";
// From where the bodies are seen, by the names of the views.
export const VIEWS = {
  Oblique: [0.75, 0.85, 0.6],
  "From above": [-0.001, 1, 0],
  "From the front": [1, 0.12, 0],
  "From the side": [0, 0.12, 1],
} as const;

export type View = keyof typeof VIEWS;

// Drawn by the processor: pixels for each point of the screen, for a picture that moves and for one at rest.
const COARSE_IN_MOTION = 0.75;
const FINE_AT_REST = 2;
// A picture is at rest after this time without a change, ms.
const REST_MS = 250;
// Length of an arrow for each newton, mm.
const MM_A_NEWTON = 0.02;
const SKIN = 0xd9d7cf;
const FEMUR = 0x9fb0bf;
const CUT_FACE = 0xb9ad8c;
// Distance of the eye from the middle of the bodies, in radii of the sphere around them.
const RADII_AWAY = 3.8;
// Turn and zoom by a key.
const KEY_RAD = (8 * Math.PI) / 180;
const KEY_ZOOM = 1.1;
// Distance of the names of directions from the surface, mm.
const NEXT_TO_MM = 5;
// The smallest length of the scale bar on the screen, px, and its possible lengths, mm.
const SCALE_PX = 50;
const SCALES_MM = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

export interface Force {
  at: Vector3;
  newtons: number;
}

// A picture to be saved: the bodies, the names of the directions at parts of its width and height, and the scale bar.
export interface Shot {
  canvas: HTMLCanvasElement;
  names: { words: string; x: number; y: number }[];
  // The length of the bar as a part of the height, and in words; none where the picture has its own.
  scale?: { part: number; words: string };
}

export class Stage {
  readonly isFlat = false;
  readonly canvas: HTMLCanvasElement;
  // Called when the view has changed.
  onTurn: () => void = () => {};
  // Bodies that grips can be of, and the end of everything that listens.
  readonly world = new World();
  readonly femur?: Mesh<BufferGeometry, Matter>;
  readonly end = new AbortController();
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(28, 4 / 3, 1, 2000);
  private readonly controls: OrbitControls;
  private readonly surface: Mesh<BufferGeometry, Matter>;
  private readonly skin: Mesh<BufferGeometry, Matter>;
  private readonly colours: Float32Array;
  private readonly marker: Mesh;
  private readonly sections: Partial<Record<Axis, number>> = {};
  // The inside of the insert has one colour: seen through a section, it is the cut face.
  private readonly cutFace = new Matter({ colour: CUT_FACE, isFlat: true, side: BackSide });
  private readonly inside: Mesh[];
  private readonly solids: Matter[];
  private readonly scale = element("div", { class: "scale" });
  private readonly names: { box: HTMLElement; at: Vector3 }[];
  private readonly bounds = new Box3();
  // One for the force of each side.
  private readonly arrows = [0, 1].map(() => new ArrowHelper(new Vector3(0, -1, 0), new Vector3(), 1, 0xd8382c));
  private grips: Grips | undefined;
  private readonly unworn: Float32Array;
  // Vertices of the skin, and the nodes of the surface that they follow.
  private readonly shared: [vertex: number, node: number][];
  private readonly neutral = new Matrix4();
  private readonly isSlow: boolean;
  private isAsked = false;
  private isNew = true;
  private resting = 0;

  constructor(
    readonly host: HTMLElement,
    scene: Scene,
    // A stage that ends: its renderer goes on, since a new one takes a tenth of a second.
    previous?: Stage,
  ) {
    previous?.release();
    this.isSlow = previous?.isSlow ?? isDrawnByProcessor();
    this.renderer = previous?.renderer ?? newRenderer(this.isSlow);
    this.canvas = this.renderer.domElement;
    this.unworn = scene.values("surface.nodes");
    this.colours = new Float32Array(this.unworn.length);
    this.surface = new Mesh(surfaceGeometry(scene, this.colours), new Matter({ side: FrontSide }));
    const skin = (this.skin = new Mesh(bodyGeometry(scene, "skin"), new Matter({ colour: SKIN, side: FrontSide })));
    this.shared = sharedNodes(scene.values("skin.nodes"), this.unworn, scene.whole("surface.quads"));
    this.inside = [this.surface, skin].map((mesh) => new Mesh(mesh.geometry, this.cutFace));
    for (const mesh of this.inside) mesh.visible = false;
    this.world.add(this.surface, skin, ...this.inside);
    for (const mesh of [this.surface, skin]) this.bounds.expandByObject(mesh);
    this.names = namesOf(scene, this.bounds);
    host.append(this.canvas, this.scale, ...this.names.map(({ box }) => box));
    this.solids = [this.surface.material, skin.material, this.cutFace];
    if (scene.facts.has_femur) {
      this.femur = new Mesh(bodyGeometry(scene, "femur"), new Matter({ colour: FEMUR, isGlass: true, side: DoubleSide }));
      this.femur.renderOrder = 1;
      this.world.add(this.femur);
      this.bounds.expandByObject(this.femur);
      this.solids.push(this.femur.material);
    }
    if (scene.facts.neutral_pose) this.neutral.copy(matrix(scene.facts.neutral_pose)).invert();
    this.marker = new Mesh(new SphereGeometry(0.5, 16, 12), new MeshBasicMaterial({ color: 0xd8382c }));
    this.marker.visible = false;
    this.world.add(this.marker, this.camera, ...this.arrows);

    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => {
      this.ask();
      this.onTurn();
    });
    this.canvas.addEventListener("keydown", (event) => this.key(event), { signal: this.end.signal });
    this.showFemur(0.3);
    this.look("Oblique");
    new ResizeObserver(() => this.fit()).observe(host);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.choosePaper(), { signal: this.end.signal });
    this.choosePaper();
    this.fit();
  }

  // Positions of the surface's nodes, mm, with their displacement since the unworn state exaggerated.
  place(nodes: Float32Array, exaggeration: number): void {
    const places = this.surface.geometry.getAttribute("position") as BufferAttribute;
    const shown = places.array as Float32Array;
    for (let i = 0; i < nodes.length; i++) {
      const from = this.unworn[i]!;
      shown[i] = from + exaggeration * (nodes[i]! - from);
    }
    places.needsUpdate = true;
    this.surface.geometry.computeVertexNormals();
    const walls = this.skin.geometry.getAttribute("position") as BufferAttribute;
    for (const [vertex, node] of this.shared) walls.copyAt(vertex, places, node);
    walls.needsUpdate = true;
    this.skin.geometry.computeVertexNormals();
    this.ask();
  }

  colour(values: Float32Array, range: Range, map: ColourMap): void {
    map.paint(values, range, this.colours);
    this.surface.geometry.getAttribute("color").needsUpdate = true;
    this.ask();
  }

  // Moves the femur to a pose of the insert frame; without one, to neutral.
  moveFemur(pose?: Matrix4): void {
    if (!this.femur) return;
    this.femur.matrixAutoUpdate = false;
    if (pose) this.femur.matrix.multiplyMatrices(pose, this.neutral);
    else this.femur.matrix.identity();
    this.femur.matrixWorldNeedsUpdate = true;
    this.ask();
  }

  showFemur(opacity: number): void {
    if (!this.femur) return;
    this.femur.visible = opacity > 0;
    this.femur.material.seeThrough(opacity);
    this.ask();
  }

  // Removes everything beyond a position on an axis, mm; nothing if there is none.
  cut(axis: Axis, at?: number): void {
    this.sections[axis] = at;
    const { x, z } = this.sections;
    for (const matter of this.solids) matter.cutAt(x, z);
    for (const mesh of this.inside) mesh.visible = x !== undefined || z !== undefined;
    this.ask();
  }

  // Arrows down onto the surface, with lengths in proportion to the forces.
  press(forces: Force[]): void {
    this.arrows.forEach((arrow, index) => {
      const force = forces[index];
      arrow.visible = force !== undefined;
      if (!force) return;
      const { at, newtons } = force;
      const length = Math.max(newtons * MM_A_NEWTON, 1);
      arrow.position.set(at.x, at.y + length, at.z);
      arrow.setLength(length, Math.min(4, length), 2.4);
    });
    this.ask();
  }

  look(view: View): void {
    const { center, radius } = this.bounds.getBoundingSphere(new Sphere());
    const direction = new Vector3(...VIEWS[view]).normalize();
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(direction, RADII_AWAY * radius);
    this.controls.update();
    this.ask();
  }

  // Turns and zooms by keys, about the middle of the view.
  private key(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const zooms: Record<string, number> = { "+": 1 / KEY_ZOOM, "=": 1 / KEY_ZOOM, "-": KEY_ZOOM };
    const [turn, zoom] = [turns[event.key], zooms[event.key]];
    if (event.key === "Home") this.look("Oblique");
    else if (!turn && !zoom) return;
    event.preventDefault();
    const { target } = this.controls;
    const away = new Spherical().setFromVector3(this.camera.position.clone().sub(target));
    away.theta += KEY_RAD * (turn?.[0] ?? 0);
    away.phi += KEY_RAD * (turn?.[1] ?? 0);
    away.radius *= zoom ?? 1;
    this.camera.position.setFromSpherical(away.makeSafe()).add(target);
    this.controls.update();
  }

  // Shows points that can be dragged.
  grip(grips: Grip[]): void {
    this.grips = new Grips(grips, this);
  }

  rayTo(event: PointerEvent): Raycaster {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
    const ray = new Raycaster();
    ray.setFromCamera(place, this.camera);
    return ray;
  }

  // Marks and returns the node of the surface nearest to a point on the screen; none outside of the surface.
  pick(event: PointerEvent): number | undefined {
    const ray = this.rayTo(event);
    this.surface.geometry.computeBoundingSphere();
    const { x = Infinity, z = Infinity } = this.sections;
    const hit = ray.intersectObject(this.surface).find(({ point }) => point.x <= x && point.z <= z);
    if (!hit?.face) return undefined;
    const places = this.surface.geometry.getAttribute("position");
    const corners = [hit.face.a, hit.face.b, hit.face.c];
    const away = (node: number) => new Vector3().fromBufferAttribute(places, node).distanceTo(hit.point);
    const node = corners.reduce((best, next) => (away(next) < away(best) ? next : best));
    this.mark(node);
    return node;
  }

  mark(node: number): void {
    this.marker.position.fromBufferAttribute(this.surface.geometry.getAttribute("position"), node);
    this.marker.visible = true;
    this.ask();
  }

  // Takes the view of another stage.
  lookAs(other: Stage | FlatStage): void {
    if (other.isFlat) return;
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
    this.ask();
  }

  // The present view with at least `height` pixels from top to bottom; the next drawing is as before.
  shot(height: number): Shot {
    this.grips?.show(false);
    this.drawWith(Math.max(1, height / this.host.clientHeight));
    this.grips?.show(true);
    const { clientWidth, clientHeight } = this.host;
    const names = this.names.map(({ box, at }) => ({ words: box.textContent ?? "", ...this.placeOf(at) }));
    const { width } = this.scale.getBoundingClientRect();
    this.ask();
    return {
      canvas: this.canvas,
      names: names.map(({ words, x, y }) => ({ words, x: x / clientWidth, y: y / clientHeight })),
      scale: { part: width / clientHeight, words: this.scale.textContent ?? "" },
    };
  }

  // The bodies as they are shown, for other programs.
  bodies(): Body[] {
    const { surface, skin, femur } = this;
    const shown: Body[] = [
      { name: "articulating surface", mesh: surface, colour: [1, 1, 1, 1] },
      { name: "insert", mesh: skin, colour: [...skin.material.rgb, 1] },
    ];
    if (femur?.visible) shown.push({ name: "femur", mesh: femur, colour: [...femur.material.rgb, femur.material.opacityShown] });
    return shown;
  }

  // Draws now, as finely as a picture at rest. Changes call `ask` instead, so that many are drawn once.
  draw(): void {
    clearTimeout(this.resting);
    this.isNew = false;
    this.drawWith(this.isSlow ? FINE_AT_REST : Math.min(devicePixelRatio, 2));
    this.canvas.dataset["still"] = "yes";
  }

  // A stage whose renderer went on to another has nothing left.
  dispose(): void {
    if (this.end.signal.aborted) return;
    this.release();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }

  private release(): void {
    clearTimeout(this.resting);
    // The default reason, an error, would keep the objects of the calls it was made in.
    this.end.abort("closed");
    this.controls.dispose();
    this.world.traverse((body) => body instanceof Mesh && (body.geometry as BufferGeometry).dispose());
  }

  private choosePaper(): void {
    const paper = getComputedStyle(this.host).getPropertyValue("--panel").trim();
    this.renderer.setClearColor(paper || "#f4f3ef");
    this.ask();
  }

  private drawWith(dots: number): void {
    if (this.renderer.getPixelRatio() !== dots) this.renderer.setPixelRatio(dots);
    this.renderer.render(this.world, this.camera);
    this.drawScale();
    for (const { box, at } of this.names) {
      const { x, y } = this.placeOf(at);
      box.style.transform = `translate(-50%,-50%) translate(${x.toFixed(1)}px,${y.toFixed(1)}px)`;
    }
  }

  // The place of a point on the stage, px.
  placeOf(point: Vector3): { x: number; y: number } {
    const seen = point.clone().project(this.camera);
    return { x: ((1 + seen.x) / 2) * this.host.clientWidth, y: ((1 - seen.y) / 2) * this.host.clientHeight };
  }

  // The scale bar is right at the centre of the view.
  private drawScale(): void {
    const away = this.camera.position.distanceTo(this.controls.target);
    const pixelsAMm = this.host.clientHeight / (2 * Math.tan((this.camera.fov * Math.PI) / 360) * away);
    const mm = SCALES_MM.find((length) => length * pixelsAMm >= SCALE_PX) ?? SCALES_MM.at(-1)!;
    const [width, words] = [`${(mm * pixelsAMm).toFixed(1)}px`, `${mm} mm`];
    if (this.scale.style.width !== width) this.scale.style.width = width;
    if (this.scale.textContent !== words) this.scale.textContent = words;
  }

  ask(): void {
    delete this.canvas.dataset["still"];
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      if (this.end.signal.aborted) return;
      if (this.isNew) this.fit();
      this.isAsked = false;
      this.frame();
    });
  }

  private frame(): void {
    // The first picture of a body is at rest; each change of the resolution holds up the page.
    if (!this.isSlow || this.isNew) return this.draw();
    this.drawWith(COARSE_IN_MOTION);
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.draw(), REST_MS);
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    const size = this.renderer.getSize(new Vector2());
    const isSame = size.x === width && size.y === height;
    if (!isSame) this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    // The colour of the page is known only once the stage is in the document.
    if (this.isNew) this.choosePaper();
    // A new size clears the canvas.
    else if (!isSame) this.frame();
  }
}

// The names of the directions next to the sides of the insert.
function namesOf(scene: Scene, bounds: Box3): { box: HTMLElement; at: Vector3 }[] {
  const { min, max } = bounds;
  const middle = bounds.getCenter(new Vector3());
  const places: [number, number][] = [
    [max.x + NEXT_TO_MM, middle.z],
    [min.x - NEXT_TO_MM, middle.z],
    [middle.x, min.z - NEXT_TO_MM],
    [middle.x, max.z + NEXT_TO_MM],
  ];
  return scene.facts.directions.map((words, index) => {
    const [x, z] = places[index]!;
    return { box: element("span", { class: "direction" }, words), at: new Vector3(x, middle.y, z) };
  });
}

function surfaceGeometry(scene: Scene, colours: Float32Array): BufferGeometry {
  const quads = scene.whole("surface.quads");
  const triangles = new Uint32Array(1.5 * quads.length);
  const corners = [0, 1, 2, 0, 2, 3];
  for (let i = 0; i < triangles.length; i++) triangles[i] = quads[4 * Math.floor(i / 6) + corners[i % 6]!]!;
  const geometry = geometryOf(scene.values("surface.nodes"), triangles);
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
  return geometry;
}

function bodyGeometry(scene: Scene, name: string): BufferGeometry {
  const geometry = geometryOf(scene.values(`${name}.nodes`), new Uint32Array(scene.whole(`${name}.triangles`)));
  // Sharp edges have separate vertices on both sides.
  geometry.computeVertexNormals();
  return geometry;
}

function geometryOf(places: Float32Array, triangles: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(places, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  geometry.computeBoundingSphere();
  return geometry;
}

export function matrix({ femoral_origin_mm: [x, y, z], rotation }: Pose): Matrix4 {
  return matrixOf([x!, y!, z!, ...rotation.flat()]);
}

// Origin, then the rotation row by row.
export function matrixOf(numbers: ArrayLike<number>): Matrix4 {
  const n = (index: number) => numbers[index]!;
  return new Matrix4().set(n(3), n(4), n(5), n(0), n(6), n(7), n(8), n(1), n(9), n(10), n(11), n(2), 0, 0, 0, 1);
}

// Software that draws instead of a graphics card.
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function newRenderer(isSlow: boolean): WebGLRenderer {
  const canvas = element("canvas", { role: "application", tabindex: 0 });
  canvas.setAttribute("aria-label", "The bodies in 3-D: arrow keys turn them, plus and minus zoom, Home resets the view");
  // Without a graphics card, edges are smoothed only at rest, by more pixels. Saved pictures are the last one drawn. The
  // renderer of three.js would ask for a canvas that is blended with the page.
  const context = canvas.getContext("webgl2", { alpha: false, antialias: !isSlow, preserveDrawingBuffer: true });
  if (!context) throw new Error("WebGL is off");
  return new WebGLRenderer({ canvas, context });
}

// Whether the browser draws without a graphics card; if WebGL is off, the renderer throws.
function isDrawnByProcessor(): boolean {
  const found = element("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  if (!found) return true;
  // Browsers may call a processor fast, but name it.
  const name = found.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? found.RENDERER;
  const isSlow = SOFTWARE.test(String(found.getParameter(name)));
  found.getExtension("WEBGL_lose_context")?.loseContext();
  return isSlow;
}

// The bodies in three dimensions, or the surface from above where the browser has no WebGL.
export function stageOf(host: HTMLElement, scene: Scene, previous?: Stage | FlatStage): Stage | FlatStage {
  try {
    return new Stage(host, scene, previous?.isFlat ? undefined : previous);
  } catch {
    return new FlatStage(host, scene);
  }
}
