// Curves with hover, zoom and a linked cursor; their data as CSV, their pictures as PNG and SVG.

import uPlot from "uplot";
import { button, element } from "./dom";
import { inDigits, withUnit, type Quantity } from "./quantities";
import { savePicture, saveText } from "./save";
import { curvesSvg } from "./curves_svg";

export interface Curve {
  name: string;
  values: (number | null)[];
  colour: string;
  // Dots without a line between them.
  isDotted?: boolean;
}

export interface Curves {
  title: string;
  across: Quantity;
  up: Quantity;
  at: number[];
  curves: Curve[];
}

// Height of a line of values below a plot.
const LEGEND_PX = 26;

export interface PlotOptions {
  // Plots of the same key share their cursor.
  linked?: string;
  // What a click on an instant does.
  chosen?: (index: number) => void;
  height?: number;
}

export class Plot {
  readonly box: HTMLElement;
  private plot: uPlot | undefined;
  private readonly shown = element("div", { class: "plot" });
  private readonly observers: (IntersectionObserver | ResizeObserver)[];
  private readonly height: number;
  private isSeen = false;
  private pointed: number | undefined;

  constructor(
    private readonly curves: Curves,
    private readonly options: PlotOptions = {},
  ) {
    this.height = options.height ?? 190;
    this.box = element("figure", { class: "curves" }, element("figcaption", {}, curves.title), this.shown, saves(curves, () => this.drawn()));
    // The height that it will have, so that nothing moves when it is drawn.
    const lines = curves.curves.length > 1 ? curves.curves.length + 1 : 1;
    this.shown.style.minHeight = `${this.height + LEGEND_PX * lines}px`;
    const seen = ([entry]: IntersectionObserverEntry[]) => this.see(entry!.isIntersecting);
    this.observers = [new IntersectionObserver(seen, { rootMargin: "200px" }), new ResizeObserver(([entry]) => this.fit(entry!.contentRect.width))];
    for (const observer of this.observers) observer.observe(this.shown);
  }

  // Lets go of what plots of the same key share.
  dispose(): void {
    for (const observer of this.observers) observer.disconnect();
    this.plot?.destroy();
  }

  // Puts the cursor on an instant.
  point(index: number): void {
    this.pointed = index;
    const across = this.curves.at[index];
    if (!this.plot || !this.isSeen || across === undefined) return;
    this.plot.setCursor({ left: this.plot.valToPos(across, "x"), top: -1 }, false);
  }

  // A curve is drawn once it comes into sight.
  private see(isSeen: boolean): void {
    this.isSeen = isSeen;
    if (!isSeen) return;
    this.drawn();
    if (this.pointed !== undefined) this.point(this.pointed);
  }

  private drawn(): uPlot {
    if (this.plot) return this.plot;
    const size = { width: this.shown.clientWidth || 320, height: this.height };
    const plot = new uPlot({ ...size, ...settings(this.curves, this.options) }, data(this.curves), this.shown);
    const { chosen } = this.options;
    if (chosen) plot.over.addEventListener("click", () => plot.cursor.idx != null && chosen(plot.cursor.idx));
    return (this.plot = plot);
  }

  private fit(width: number): void {
    if (this.plot && width > 0 && Math.abs(width - this.plot.width) > 1) this.plot.setSize({ width, height: this.height });
  }
}

function data({ at, curves }: Curves): uPlot.AlignedData {
  return [at, ...curves.map((curve) => curve.values)];
}

function settings({ across, up, curves }: Curves, { linked }: PlotOptions): Omit<uPlot.Options, "width" | "height"> {
  const ink = "currentColor";
  const axis = { stroke: () => getComputedStyle(document.body).color, font: "11px sans-serif", labelFont: "11px sans-serif", labelSize: 16, grid: { stroke: "#8884", width: 1 }, ticks: { stroke: "#8884", width: 1 } };
  const values = (_: uPlot, all: number[]) => all.map(inDigits);
  return {
    scales: { x: { time: false } },
    axes: [
      { ...axis, label: withUnit(across), size: 26, values },
      { ...axis, label: withUnit(up), size: 48, values },
    ],
    cursor: { drag: { x: true, y: false }, ...(linked ? { sync: { key: linked, scales: ["x", null] as [string, null] } } : {}) },
    series: [
      { label: across.label, value: (_, value) => (value === null ? "–" : inDigits(value)) },
      ...curves.map(({ name, colour, isDotted }) => ({
        label: name,
        stroke: colour || ink,
        width: 1.6,
        // Curves of two runs have their points at other cycles.
        spanGaps: true,
        ...(isDotted ? { paths: () => null } : {}),
        points: { show: isDotted || curves.filter((curve) => !curve.isDotted).length === 1 },
        value: (_: uPlot, value: number | null) => (value === null ? "–" : `${inDigits(value)} ${up.unit}`),
      })),
    ],
  };
}

function saves(curves: Curves, plot: () => uPlot): HTMLElement {
  const name = curves.title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "_");
  return element(
    "div",
    { class: "saves" },
    button("CSV", () => saveText(`${name}.csv`, csv(curves), "text/csv")),
    button("PNG", () => savePicture(`${name}.png`, plot().ctx.canvas)),
    button("SVG", () => saveText(`${name}.svg`, curvesSvg(curves), "image/svg+xml")),
  );
}

export function csv({ across, up, at, curves }: Curves): string {
  const head = [across.name, ...curves.map((curve) => (curves.length > 1 ? `${up.name} ${curve.name}` : up.name))];
  const rows = at.map((x, index) => [x, ...curves.map((curve) => curve.values[index] ?? "")]);
  return [head, ...rows].map((row) => row.join(",")).join("\n") + "\n";
}
