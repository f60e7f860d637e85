// Charts with hover, zoom and a linked cursor; their data as CSV, their pictures as PNG and SVG.

import uPlot from "uplot";
import { chartSvg } from "./chart_svg";
import { button, element } from "./dom";
import { inDigits } from "./digits";
import { savePicture, saveText } from "./save";
import type { Chart } from "./scene";

// Height of a line of values below a plot.
const LEGEND_PX = 26;
// Widths of lines as in the still pictures; other styles have 1.
const WIDTHS: Record<string, number> = { first: 4.5, last: 1.7 };
// Measured values have the colour of soft text; the other styles have colours of their own names.
const COLOURS: Record<string, string> = { specimen: "--soft" };

export interface PlotOptions {
  // Called with the horizontal value of a click.
  chosen?: (x: number, chart: Chart) => void;
  height?: number;
  // The picture that is saved as SVG.
  svg?: (chart: Chart) => string;
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
    readonly chart: Chart,
    private readonly options: PlotOptions = {},
  ) {
    this.height = options.height ?? 190;
    const positive = chart.positive && element("span", { class: "positive" }, `+ ${chart.positive}`);
    const heading = element("figcaption", {}, withUnit(chart), positive);
    this.box = element("figure", { class: "curves" }, heading, this.shown, this.saves());
    // The final height, so that nothing moves when the plot is drawn.
    this.shown.style.minHeight = `${this.height + LEGEND_PX}px`;
    const seen = (entries: IntersectionObserverEntry[]) => this.see(entries.some((entry) => entry.isIntersecting));
    const resized = (entries: ResizeObserverEntry[]) => entries.forEach((entry) => this.fit(entry.contentRect.width));
    this.observers = [new IntersectionObserver(seen, { rootMargin: "200px" }), new ResizeObserver(resized)];
    for (const observer of this.observers) observer.observe(this.shown);
  }

  // Releases the resources that plots of the same group share.
  dispose(): void {
    this.isSeen = false;
    for (const observer of this.observers) observer.disconnect();
    this.plot?.destroy();
  }

  // Puts the cursor on a horizontal value.
  point(x: number): void {
    this.pointed = x;
    if (this.plot && this.isSeen) this.plot.setCursor({ left: this.plot.valToPos(x, "x"), top: -1 }, false);
  }

  // A plot is drawn when it first comes into sight, in a task of its own so that the page responds between plots.
  private see(isSeen: boolean): void {
    this.isSeen = isSeen;
    setTimeout(() => {
      if (!this.isSeen) return;
      this.drawn();
      if (this.pointed !== undefined) this.point(this.pointed);
    });
  }

  private drawn(): uPlot {
    if (this.plot) return this.plot;
    const size = { width: this.shown.clientWidth || 320, height: this.height };
    const plot = new uPlot({ ...size, ...settings(this.chart) }, aligned(this.chart), this.shown);
    const { chosen } = this.options;
    const choose = () => {
      const x = plot.cursor.idx == null ? undefined : plot.data[0][plot.cursor.idx];
      if (x !== undefined) chosen?.(x, this.chart);
    };
    if (chosen) plot.over.addEventListener("click", choose);
    return (this.plot = plot);
  }

  private fit(width: number): void {
    if (this.plot && width > 0 && Math.abs(width - this.plot.width) > 1) this.plot.setSize({ width, height: this.height });
  }

  private saves(): HTMLElement {
    const { chart } = this;
    const name = slug(`${chart.title} ${activityOf(chart)}`.trim());
    const { svg = chartSvg } = this.options;
    return element(
      "div",
      { class: "saves" },
      button("CSV", () => saveText(`${name}.csv`, csv(chart), "text/csv")),
      button("PNG", () => savePicture(`${name}.png`, this.drawn().ctx.canvas)),
      button("SVG", () => saveText(`${name}.svg`, svg(chart), "image/svg+xml")),
    );
  }
}

export function withUnit({ title, unit }: Pick<Chart, "title" | "unit">): string {
  return unit ? `${title}, ${unit}` : title;
}

export function acrossTitle({ x_title }: Chart): string {
  return x_title || "percent of the cycle";
}

export function slug(words: string): string {
  return words.toLowerCase().replaceAll(/[^a-z0-9]+/g, "_");
}

// All curves at the union of their horizontal values; a missing value is null where the curve breaks.
export function aligned({ curves }: Chart): uPlot.AlignedData {
  const column = ({ x, y }: Chart["curves"][number]): uPlot.AlignedData => [Array.from(x), Array.from(y, (value) => (Number.isFinite(value) ? value : null))];
  return uPlot.join(curves.map(column));
}

function yRange({ from_zero, min_span }: Chart, low: number, high: number): uPlot.Range.MinMax {
  const from = from_zero ? Math.min(0, low) : low;
  return uPlot.rangeNum(from, Math.max(high, from + min_span), 0.1, true);
}

function settings(chart: Chart): Omit<uPlot.Options, "width" | "height"> {
  const style = (name: string) => () => getComputedStyle(document.body).getPropertyValue(name).trim();
  const font = "11px sans-serif";
  const lines = { stroke: "#8884", width: 1 };
  const axis = { stroke: () => getComputedStyle(document.body).color, font, labelFont: font, labelSize: 16, grid: lines, ticks: lines };
  const values = (_: uPlot, all: number[]) => all.map(inDigits);
  const known = (unit: string) => (_: uPlot, value: number | null) => (value === null ? "–" : `${inDigits(value)} ${unit}`.trim());
  return {
    scales: { x: { time: false }, y: { range: (_, low, high) => yRange(chart, low, high) } },
    axes: [
      { ...axis, label: acrossTitle(chart), size: 26, values },
      { ...axis, size: 48, values },
    ],
    hooks: { setLegend: [(plot: uPlot) => plot.root.toggleAttribute("data-pointed", plot.cursor.idx != null)] },
    cursor: { drag: { x: true, y: false }, sync: { key: chart.group, scales: ["x", null] as [string, null] } },
    series: [
      { label: "at", value: known(chart.x_title || "%") },
      ...chart.curves.map((curve) => ({
        label: curve.name,
        stroke: style(COLOURS[curve.style] ?? `--${curve.style}`),
        width: WIDTHS[curve.style] ?? 1,
        points: { show: curve.has_dots },
        value: known(chart.unit),
      })),
    ],
  };
}

// The activity of a chart over its cycle; empty for the only one.
export function activityOf({ group }: Pick<Chart, "group">): string {
  return /^cycle(.+)/.exec(group)?.[1] ?? "";
}

export function csv(chart: Chart): string {
  // The id of a chart is that of its column with a letter in front, and its activity behind.
  const column = slug(chart.id.slice(0, chart.id.length - activityOf(chart).length).replace(/^[a-z]-/, ""));
  const names = chart.curves.map(({ name }) => (chart.curves.length > 1 ? `${column}_${slug(name)}` : column));
  const [at, ...all] = aligned(chart);
  const rows = Array.from(at, (x, index) => [x, ...all.map((values) => values[index] ?? "")]);
  const lines = [[slug(acrossTitle(chart)), ...names], ...rows].map((row) => `${row.join(",")}\n`);
  return lines.join("");
}
