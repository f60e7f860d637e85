// The run that the page shows: bodies and charts as in the report, in the previous view.

import { element } from "../dom";
import { activityOf } from "../plots";
import { RunView } from "../run_view";
import type { Chart, Scene } from "../scene";
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
    const boxes = (isShown: (chart: Chart) => boolean) => view.plots.filter(({ chart }) => isShown(chart)).map(({ box }) => box);
    const isWear = ({ group }: Chart) => group === "wear";
    this.worn.replaceChildren(element("div", { class: "worn" }, ...boxes(isWear), view.history));
    const activities = new Set(view.plots.filter(({ chart }) => !isWear(chart)).map(({ chart }) => activityOf(chart)));
    const ofActivity = (name: string) => [
      ...(name ? [element("h3", {}, `Cycle of ${name}`)] : []),
      element("div", { class: "gait" }, ...boxes((chart) => !isWear(chart) && activityOf(chart) === name)),
    ];
    this.gait.replaceChildren(...[...activities].flatMap(ofActivity));
  }
}
