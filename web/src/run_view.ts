// A run on the screen: the bodies, and charts that are linked with them.

import { element } from "./dom";
import { FlatMaps } from "./flat_maps";
import { Plot, type PlotOptions } from "./plots";
import type { Chart, Scene } from "./scene";
import { updateAfter, Viewer } from "./viewer";

const MILLION = 1e6;

export interface RunViewOptions {
  // Flat maps inside of it are linked with the bodies.
  root?: ParentNode;
  // The viewer of the run before, whose renderer goes on.
  previous?: Viewer;
}

export class RunView {
  readonly viewer: Viewer | undefined;
  plots: Plot[] = [];
  // The history of the picked point.
  readonly history = element("div");
  private picked: Plot | undefined;
  private readonly maps: FlatMaps;

  constructor(
    private readonly scene: Scene,
    { root = document, previous }: RunViewOptions = {},
  ) {
    this.maps = new FlatMaps(root, (x, z) => this.viewer?.pickAt(x, z));
    if (scene.facts.updates.length) this.viewer = new Viewer(scene, previous);
    const { viewer } = this;
    if (viewer) viewer.onPick = (node) => this.pick(viewer, node);
  }

  // Draws the charts, after the bodies so that the page responds in between; `svg` is the picture of a chart that is saved.
  draw(svg?: (chart: Chart) => string): void {
    const { scene, viewer } = this;
    // Other activities have motions of their own, which the bodies do not show.
    const chosen: Record<string, PlotOptions["chosen"]> = {
      wear: (x, { cycles_per_x }) => viewer?.showUpdate(updateAfter(scene, cycles_per_x * x)),
      cycle: (percent) => viewer?.showPercent(percent),
    };
    this.plots = scene.charts().map((chart) => new Plot(chart, { height: 160, chosen: chosen[chart.group], svg }));
    const moved = this.plots.filter(({ chart }) => chart.group === "cycle");
    if (viewer) viewer.onPercent = (percent) => moved.forEach((plot) => plot.point(percent));
  }

  // Releases the run; its elements stay until they are removed.
  dispose(): void {
    this.viewer?.dispose();
    this.plots.forEach((plot) => plot.dispose());
    this.picked?.dispose();
  }

  private pick(viewer: Viewer, node: number): void {
    const [x, , z] = viewer.placeOf(node);
    this.maps.mark(x, z);
    const { fields, updates } = this.scene.facts;
    const field = fields.find(({ name }) => name === viewer.shownField) ?? fields[0];
    if (!field) return;
    const { name, label, unit } = field;
    const curve = {
      name: label,
      style: "last",
      has_dots: true,
      x: updates.map((cycles) => (cycles ?? 0) / MILLION),
      y: updates.map((_, update) => this.scene.field(name, update)[node] ?? NaN),
    };
    this.picked?.dispose();
    this.picked = new Plot({
      id: `p-${name}`,
      group: "wear",
      title: `${label} at the picked point`,
      unit,
      positive: "",
      from_zero: false,
      min_span: 0,
      x_title: "million cycles",
      cycles_per_x: MILLION,
      curves: [curve],
    });
    this.history.replaceChildren(this.picked.box);
  }
}
