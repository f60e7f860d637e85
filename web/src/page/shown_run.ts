// The run that the page shows: bodies and charts as in the report, in the previous view.

import { element } from "../dom";
import { RunView } from "../run_view";
import type { Scene } from "../scene";
import type { Viewer } from "../viewer";
import type { Summary } from "./numbers";

export interface Found {
  scene: Scene;
  summary: Summary;
  // The case with every default.
  text: string;
}

export class ShownRun {
  private view: RunView | undefined;

  get viewer(): Viewer | undefined {
    return this.view?.viewer;
  }

  constructor(
    private readonly bodies: HTMLElement,
    private readonly worn: HTMLElement,
    private readonly gait: HTMLElement,
  ) {}

  showBodies({ scene }: Found): void {
    const before = this.view?.viewer;
    // The page has no flat maps.
    const view = new RunView(scene, { root: this.bodies, previous: before });
    this.bodies.replaceChildren(...(view.viewer ? [view.viewer.box] : []));
    if (before && view.viewer) view.viewer.lookAs(before);
    this.view?.dispose();
    this.view = view;
  }

  showCharts(): void {
    const { view } = this;
    // A newer run may have been shown meanwhile.
    if (!view || view.plots.length) return;
    view.draw();
    const boxes = (isWear: boolean) => view.plots.filter(({ chart }) => (chart.group === "wear") === isWear).map(({ box }) => box);
    this.worn.replaceChildren(element("div", { class: "worn" }, ...boxes(true), view.history));
    this.gait.replaceChildren(element("div", { class: "gait" }, ...boxes(false)));
  }
}
