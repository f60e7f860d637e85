// Two designs live: the run that was kept beside the present one, in one view, with their differences.

import { differenceMap, obstacle } from "../difference_map";
import { button, element } from "../dom";
import { linked } from "../linked";
import { Plot } from "../plots";
import type { Scene } from "../scene";
import { Viewer } from "../viewer";
import { changed, inWords } from "./case_text";
import { comparison, verdict } from "./numbers";
import type { Found } from "./shown_run";

// Charts that are drawn for both runs together.
const CHARTS = ["w-mass_loss_mg", "w-max_depth_mm"];

export class Compared {
  private kept: { found: Found; viewer: Viewer | undefined } | undefined;
  private plots: Plot[] = [];

  constructor(
    private readonly section: HTMLElement,
    // Receives the viewer of the kept run.
    private readonly beside: HTMLElement,
  ) {}

  keep(found: Found, present: Viewer | undefined): void {
    this.end();
    const viewer = found.scene.facts.updates.length ? new Viewer(found.scene) : undefined;
    this.kept = { found, viewer };
    this.beside.replaceChildren(...(viewer ? [viewer.box] : []));
    this.beside.hidden = !viewer;
    if (viewer && present) viewer.lookAs(present);
    this.show(found, present);
  }

  // Compares with the run that the page shows now.
  show(now: Found, present: Viewer | undefined): void {
    const { kept } = this;
    if (!kept) return;
    this.section.hidden = false;
    linked([kept.viewer, present].filter((viewer) => viewer !== undefined));
    this.plots.forEach((plot) => plot.dispose());
    this.plots = CHARTS.flatMap((id) => sideBySide(kept.found.scene, now.scene, id));
    const map = mapOf(kept.found, now);
    const key = element("p", { class: "note" }, "Thick and yellow: the kept run; thin and blue: this run.");
    const curves = element("div", {}, ...this.plots.map((plot) => plot.box), key);
    const box = element("div", { class: "compared" }, ...(map ? [map] : []), curves);
    this.section.replaceChildren(
      element("h2", {}, "Compared with the kept run"),
      element("p", { class: "verdict" }, verdict(kept.found.summary, now.summary)),
      settings(kept.found.text, now.text),
      element("div", { class: "wide" }, comparison(kept.found.summary, now.summary)),
      box,
      button("Stop comparing", () => {
        this.end();
        linked(present ? [present] : []);
      }),
    );
  }

  private end(): void {
    this.kept?.viewer?.dispose();
    this.plots.forEach((plot) => plot.dispose());
    this.plots = [];
    this.kept = undefined;
    this.section.hidden = this.beside.hidden = true;
    this.section.replaceChildren();
    this.beside.replaceChildren();
  }
}

function settings(kept: string, now: string): HTMLElement {
  const all = changed(kept, now);
  if (!all.length) return element("p", { class: "note" }, "Both runs have the same settings.");
  const rows = all.map(([key, before, after]) => element("li", {}, element("code", {}, key), `: ${inWords(before, after)}`));
  return element("ul", { class: "settings", "aria-label": "Changed settings" }, ...rows);
}

// The map of the difference in wear depth, or a sentence why there is none; neither without wear depths.
function mapOf(kept: Found, now: Found): HTMLElement | undefined {
  const field = now.scene.facts.fields.find(({ name }) => name === "wear_depth_mm");
  if (!field || !kept.scene.facts.updates.length) return undefined;
  const [before, after] = [kept, now].map(({ summary }) => summary.joint);
  const why = before === after ? obstacle(kept.scene, now.scene) : `they are of different joints (${before} and ${after})`;
  return why ? element("p", { class: "note" }, `Wear depths cannot be subtracted: ${why}.`) : differenceMap(kept.scene, now.scene, field);
}

// A chart of two runs; none where one of them lacks it.
function sideBySide(kept: Scene, now: Scene, id: string): Plot[] {
  const [before, after] = [kept, now].map((scene) => scene.charts().find((chart) => chart.id === id));
  const [first, last] = [before?.curves.at(-1), after?.curves.at(-1)];
  if (!before || !after || !first || !last) return [];
  // Both in the unit of the present run.
  const scale = before.cycles_per_x / after.cycles_per_x;
  const x = Array.from(first.x, (at) => at * scale);
  const curves = [
    { ...first, x, name: "kept", style: "first" },
    { ...last, name: "present", style: "last" },
  ];
  return [new Plot({ ...after, curves })];
}
