// The surface from above, for browsers without WebGL.

import { Box3 } from "three";
import type { ColourMap, Range } from "./colours";
import { element } from "./dom";
import type { Scene } from "./scene";
import type { Force, Shot, Stage } from "./stage";

// Space around the surface for the names of the directions, px.
const MARGIN_PX = 26;
// Radius of the dot of a force for each square root of newton, px.
const PX_A_ROOT_NEWTON = 0.16;

export class FlatStage {
  readonly isFlat = true;
  readonly canvas = element("canvas", { role: "img", "aria-label": "The surface from above" });
  onTurn: () => void = () => {};
  private readonly quads: ArrayLike<number>;
  private readonly unworn: Float32Array;
  private values: ArrayLike<number> = [];
  private range: Range = [0, 1];
  private map: ColourMap | undefined;
  private forces: Force[] = [];
  private marked: number | undefined;
  private readonly resized = new ResizeObserver(() => this.draw());

  constructor(
    private readonly host: HTMLElement,
    private readonly scene: Scene,
  ) {
    this.quads = scene.whole("surface.quads");
    this.unworn = scene.values("surface.nodes");
    const why = "This browser cannot draw in three dimensions, since WebGL is off: the surface is shown from above.";
    host.append(this.canvas, element("p", { class: "without" }, why));
    this.resized.observe(host);
  }

  colour(values: Float32Array, range: Range, map: ColourMap): void {
    Object.assign(this, { values, range, map });
    this.draw();
  }

  press(forces: Force[]): void {
    this.forces = forces;
    this.draw();
  }

  mark(node: number): void {
    this.marked = node;
    this.draw();
  }

  // The node nearest to a point on the screen, within the width of a mark.
  pick(event: PointerEvent): number | undefined {
    const { left, top } = this.canvas.getBoundingClientRect();
    const place = this.placing();
    let [best, away] = [-1, 12];
    for (let node = 0; 3 * node < this.unworn.length; node++) {
      const [x, y] = place(this.unworn[3 * node]!, this.unworn[3 * node + 2]!);
      const distance = Math.hypot(x - event.clientX + left, y - event.clientY + top);
      if (distance < away) [best, away] = [node, distance];
    }
    if (best < 0) return undefined;
    this.mark(best);
    return best;
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width && height) this.drawWith(devicePixelRatio, width, height);
    this.canvas.dataset["still"] = "yes";
  }

  shot(height: number): Shot {
    const { clientWidth, clientHeight } = this.host;
    this.drawWith(height / clientHeight, clientWidth, clientHeight);
    const copy = element("canvas", { width: this.canvas.width, height: this.canvas.height });
    copy.getContext("2d")!.drawImage(this.canvas, 0, 0);
    this.draw();
    return { canvas: copy, names: [] };
  }

  dispose(): void {
    this.resized.disconnect();
    this.canvas.remove();
  }

  // A flat picture has one view, and shows no other body.
  place(): void {}
  moveFemur(): void {}
  showFemur(): void {}
  cut(): void {}
  look(): void {}
  lookAs(_: Stage | FlatStage): void {}

  // Maps x and z, mm, to the picture, px: +x is up, +z to the right.
  private placing(): (x: number, z: number) => [number, number] {
    const { min, max } = new Box3().setFromArray(this.unworn);
    const { clientWidth: width, clientHeight: height } = this.host;
    const scale = Math.min((width - 2 * MARGIN_PX) / (max.z - min.z), (height - 2 * MARGIN_PX) / (max.x - min.x));
    return (x, z) => [width / 2 + (z - (min.z + max.z) / 2) * scale, height / 2 - (x - (min.x + max.x) / 2) * scale];
  }

  private drawWith(dots: number, width: number, height: number): void {
    this.canvas.width = Math.round(dots * width);
    this.canvas.height = Math.round(dots * height);
    const pen = this.canvas.getContext("2d")!;
    pen.scale(dots, dots);
    const place = this.placing();
    const at = (node: number) => place(this.unworn[3 * node]!, this.unworn[3 * node + 2]!);
    for (let i = 0; i < this.quads.length; i += 4) {
      const corners = [0, 1, 2, 3].map((corner) => this.quads[i + corner]!);
      const mean = corners.reduce((sum, node) => sum + (this.values[node] ?? 0), 0) / 4;
      polygon(pen, corners.map(at), this.map?.css(mean, this.range) ?? "");
    }
    for (const force of this.forces) dot(pen, place(force.at.x, force.at.z), PX_A_ROOT_NEWTON * Math.sqrt(force.newtons));
    if (this.marked !== undefined) dot(pen, at(this.marked), 4);
    this.nameDirections(pen, width, height);
  }

  private nameDirections(pen: CanvasRenderingContext2D, width: number, height: number): void {
    pen.fillStyle = getComputedStyle(this.host).color;
    pen.font = "12px sans-serif";
    pen.textAlign = "center";
    const [front, back, left, right] = this.scene.facts.directions;
    const sideways: [string | undefined, number, number, number][] = [
      [front, width / 2, 16, 0],
      [back, width / 2, height - 8, 0],
      [left, 16, height / 2, -Math.PI / 2],
      [right, width - 8, height / 2, -Math.PI / 2],
    ];
    for (const [words, x, y, turn] of sideways) {
      pen.save();
      pen.translate(x, y);
      pen.rotate(turn);
      pen.fillText(words ?? "", 0, 0);
      pen.restore();
    }
  }
}

function polygon(pen: CanvasRenderingContext2D, corners: [number, number][], colour: string): void {
  pen.beginPath();
  for (const [x, y] of corners) pen.lineTo(x, y);
  pen.closePath();
  pen.fillStyle = pen.strokeStyle = colour;
  pen.fill();
  // Without it, the paper shows through between neighbours.
  pen.lineWidth = 0.6;
  pen.stroke();
}

function dot(pen: CanvasRenderingContext2D, [x, y]: [number, number], radius: number): void {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.strokeStyle = "#d8382c";
  pen.lineWidth = 2;
  pen.stroke();
}
