// Points of the bodies that can be dragged along lines.

import { Mesh, MeshBasicMaterial, SphereGeometry, type Object3D, type Vector3 } from "three";
import { element } from "./dom";
import type { Stage } from "./stage";

// Radius of a grip, and of the place around it where it is taken, mm.
const GRIP_MM = 1.3;
const GRASP_MM = 3;

export interface Grip {
  at: Vector3;
  // Unit vector.
  along: Vector3;
  // True for a point that moves with the femur; both vectors are then those at neutral.
  isOfFemur?: boolean;
  // Says what a motion by some mm does.
  words: (mm: number) => string;
  dropped: (mm: number) => void;
}

// A motion has words next to it, and takes effect when the grip is dropped.
export class Grips {
  private readonly balls: Mesh[] = [];
  private readonly words = element("span", { class: "direction", "aria-live": "polite" });

  constructor(
    private readonly grips: Grip[],
    private readonly stage: Stage,
  ) {
    for (const grip of grips) {
      const ball = new Mesh(new SphereGeometry(GRIP_MM, 16, 12), new MeshBasicMaterial({ color: 0x2f6db5, depthTest: false }));
      ball.renderOrder = 2;
      ball.position.copy(grip.at);
      this.bodyOf(grip).add(ball);
      this.balls.push(ball);
    }
    const { host } = stage;
    const { signal } = stage.end;
    host.append(this.words);
    // Before the canvas has the event, which would turn the view.
    host.addEventListener("pointerdown", (event) => this.take(event), { capture: true, signal });
    host.addEventListener("pointermove", (event) => this.hover(event), { signal });
    signal.addEventListener("abort", () => this.words.remove());
    stage.ask();
  }

  show(isShown: boolean): void {
    for (const ball of this.balls) ball.visible = isShown;
  }

  private bodyOf({ isOfFemur }: Grip): Object3D {
    return (isOfFemur && this.stage.femur) || this.stage.world;
  }

  // The point and its line where the body is now.
  private now(grip: Grip): { at: Vector3; along: Vector3 } {
    const { matrixWorld } = this.bodyOf(grip);
    return { at: grip.at.clone().applyMatrix4(matrixWorld), along: grip.along.clone().transformDirection(matrixWorld) };
  }

  private hover(event: PointerEvent): void {
    if (event.buttons) return;
    const grip = this.near(event);
    this.stage.canvas.style.cursor = grip ? "grab" : "";
    this.say(grip, 0);
  }

  private take(event: PointerEvent): void {
    const grip = this.near(event);
    if (!grip || event.button !== 0) return;
    event.stopPropagation();
    const { canvas } = this.stage;
    canvas.setPointerCapture(event.pointerId);
    const ball = this.balls[this.grips.indexOf(grip)]!;
    const [start, drag] = [this.along(event, grip), new AbortController()];
    let mm = 0;
    const move = (next: PointerEvent) => {
      mm = this.along(next, grip) - start;
      ball.position.copy(grip.at).addScaledVector(grip.along, mm);
      this.say(grip, mm);
      this.stage.ask();
    };
    const drop = () => {
      drag.abort();
      this.say(undefined, 0);
      if (mm !== 0) grip.dropped(mm);
    };
    const { signal } = drag;
    canvas.addEventListener("pointermove", move, { signal });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, drop, { signal });
  }

  private near(event: PointerEvent): Grip | undefined {
    const { ray } = this.stage.rayTo(event);
    const away = (grip: Grip) => ray.distanceToPoint(this.now(grip).at);
    const near = this.grips.filter((grip) => this.bodyOf(grip).visible && away(grip) < GRASP_MM);
    return near.sort((one, two) => away(one) - away(two))[0];
  }

  // The place on the line of a grip that is nearest to a point on the screen, mm from the grip.
  private along(event: PointerEvent, grip: Grip): number {
    const { at, along } = this.now(grip);
    const { origin, direction } = this.stage.rayTo(event).ray;
    const [apart, across] = [at.sub(origin), along.dot(direction)];
    // Where the eye looks along the line, both are parallel.
    return (across * apart.dot(direction) - apart.dot(along)) / Math.max(1 - across * across, 1e-3);
  }

  private say(grip: Grip | undefined, mm: number): void {
    this.words.textContent = grip?.words(mm) ?? "";
    if (!grip) return;
    const { at, along } = this.now(grip);
    const { x, y } = this.stage.placeOf(at.addScaledVector(along, mm));
    this.words.style.transform = `translate(-50%,-220%) translate(${x.toFixed(1)}px,${y.toFixed(1)}px)`;
  }
}
