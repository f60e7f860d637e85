// A run as it is looked at: the bodies, and curves that are linked with them.

import { element } from "./dom";
import { FlatMaps } from "./flat_maps";
import { withMeasured, withWeighings } from "./measured";
import { Plot, type Curves, type PlotOptions } from "./plots";
import { cyclesInWords, quantity } from "./quantities";
import type { Scene } from "./scene";
import { updateAfter, Viewer } from "./viewer";

const BLUE = "#2f6db5";
const RED = "#c2492f";
const MILLION_CYCLES = { name: "cycles", label: "Million cycles", unit: "" };
const PERCENT = { name: "percent", label: "Gait cycle", unit: "%" };

export class RunView {
  readonly viewer: Viewer | undefined;
  readonly worn = element("div", { class: "worn" });
  readonly gait = element("div", { class: "gait" });
  private readonly history = element("div");
  private readonly maps: FlatMaps;
  private readonly plots: Plot[] = [];

  // Flat maps of the run that `root` holds are linked with the bodies.
  constructor(
    private readonly scene: Scene,
    root: ParentNode = document,
  ) {
    this.maps = new FlatMaps(root, (x, z) => this.viewer?.pickAt(x, z));
    if (scene.facts.updates.length) this.viewer = new Viewer(scene);
    this.drawWear();
    this.drawGait();
    if (this.viewer) this.viewer.onPick = (node) => this.picked(this.viewer!, node);
  }

  // Lets go of the run; what it drew stays until it is taken away.
  dispose(): void {
    this.viewer?.dispose();
    this.plots.forEach((plot) => plot.dispose());
  }

  private plotted(curves: Curves, options: PlotOptions): Plot {
    const plot = new Plot(curves, options);
    this.plots.push(plot);
    return plot;
  }

  private drawWear(): void {
    if (!this.scene.columns("wear").includes("mass_loss_mg")) return;
    const after = [0, ...this.scene.column("wear", "cycles")];
    const ofRun = (name: string): Curves => ({
      title: quantity(name).label,
      across: MILLION_CYCLES,
      up: quantity(name),
      at: after.map((cycles) => cycles / 1e6),
      curves: [{ name: quantity(name).label, colour: BLUE, values: [0, ...this.scene.column("wear", name)] }],
    });
    const names = ["mass_loss_mg", "max_depth_mm"].filter((name) => this.scene.columns("wear").includes(name));
    for (const name of names) {
      const curves = withWeighings(ofRun(name), this.scene);
      const chosen = (index: number) => this.viewer?.showUpdate(updateAfter(this.scene, 1e6 * curves.at[index]!));
      this.worn.append(this.plotted(curves, { linked: "wear", chosen }).box);
    }
    this.worn.append(this.history);
  }

  private drawGait(): void {
    const columns = this.scene.columns("kinematics");
    const cycles = columns.includes("cycles") ? parts(this.scene.column("kinematics", "cycles")) : [];
    if (!cycles.length || !columns.includes("percent")) return;
    const chosen = (index: number) => this.viewer?.showInstant(index);
    const plots = columns.slice(2).map((name) => this.plotted(withMeasured(this.channel(name, cycles), this.scene), { linked: "gait", chosen, height: 160 }));
    this.gait.append(...plots.map((plot) => plot.box));
    if (this.viewer) this.viewer.onInstant = (index) => plots.forEach((plot) => plot.point(index));
  }

  private channel(name: string, cycles: Part[]): Curves {
    const column = this.scene.column("kinematics", name);
    const [first] = cycles;
    return {
      title: quantity(name).label,
      across: PERCENT,
      up: quantity(name),
      at: [...this.scene.column("kinematics", "percent").subarray(first!.from, first!.to)],
      curves: cycles.map(({ from, to, cycles }, index) => ({
        name: `${index === 0 ? "first" : "last"} cycle, after ${cyclesInWords(cycles)}`,
        colour: index === 0 ? BLUE : RED,
        values: [...column.subarray(from, to)],
      })),
    };
  }

  private picked(viewer: Viewer, node: number): void {
    const [x, , z] = viewer.placeOf(node);
    this.maps.mark(x, z);
    this.drawHistory(node);
  }

  private drawHistory(node: number): void {
    const name = this.scene.facts.fields.includes(this.viewer!.shownField) ? this.viewer!.shownField : this.scene.facts.fields[0]!;
    const { updates } = this.scene.facts;
    const { label } = quantity(name);
    const curves: Curves = {
      title: `${label} at the picked point`,
      across: MILLION_CYCLES,
      up: quantity(name),
      at: updates.map((cycles) => (cycles ?? 0) / 1e6),
      curves: [{ name: label, colour: BLUE, values: updates.map((_, update) => this.scene.field(name, update)[node]!) }],
    };
    this.history.replaceChildren(this.plotted(curves, { linked: "wear" }).box);
  }
}

interface Part {
  cycles: number;
  from: number;
  to: number;
}

// The rows of each cycle of kinematics.csv.
function parts(cycles: Float64Array): Part[] {
  const found: Part[] = [];
  cycles.forEach((value, row) => {
    const last = found.at(-1);
    if (last?.cycles === value) last.to = row + 1;
    else found.push({ cycles: value, from: row, to: row + 1 });
  });
  return found;
}
