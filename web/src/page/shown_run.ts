// The run that the page shows: bodies and curves as in the report, from where they were looked at before.

import { RunView } from "../run_view";
import { Scene } from "../scene";
import type { Summary } from "./numbers";

export interface Found {
  scene: Scene;
  summary: Summary;
}

export class ShownRun {
  private view: RunView | undefined;

  constructor(
    private readonly bodies: HTMLElement,
    private readonly worn: HTMLElement,
    private readonly gait: HTMLElement,
  ) {}

  show({ scene }: Found): void {
    const before = this.view?.viewer;
    // The page has no flat maps to be linked with.
    const view = new RunView(scene, this.bodies);
    this.bodies.replaceChildren(...(view.viewer ? [view.viewer.box] : []));
    this.worn.replaceChildren(view.worn);
    this.gait.replaceChildren(view.gait);
    if (before && view.viewer) view.viewer.lookAs(before);
    this.view?.dispose();
    this.view = view;
  }
}
