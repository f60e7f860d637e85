// Colour maps, whose colours come with the scene, and their bars with round marks.

import { Color, LinearSRGBColorSpace } from "three";
import { inDigits } from "./digits";
import { element } from "./dom";

const LEVELS = 256;
// As on the flat maps, nothing has the colour of polyethylene.
const BARE = "#f2f0ea";

export type Range = [low: number, high: number];

export class ColourMap {
  // In linear red, green and blue.
  private readonly levels: Color[];

  // `colours`: at even distances from little to much, as #rrggbb; `least`: that of the least value.
  constructor(
    private readonly colours: string[],
    least = BARE,
  ) {
    // Without conversion: the parts of sRGB are interpolated.
    const stops = colours.map((colour) => new Color().setStyle(colour, LinearSRGBColorSpace));
    this.levels = Array.from({ length: LEVELS }, (_, level) => between(stops, level / (LEVELS - 1)).convertSRGBToLinear());
    this.levels[0] = new Color(least);
  }

  // Colours values between two ends, in linear red, green and blue.
  paint(values: ArrayLike<number>, range: Range, into: Float32Array): void {
    for (let i = 0; i < values.length; i++) this.level(values[i]!, range).toArray(into, 3 * i);
  }

  // The colour of a value as CSS.
  css(value: number, range: Range): string {
    return this.level(value, range).getStyle();
  }

  // Red, green and blue of a value in sRGB, from 0 to 255.
  bytes(value: number, range: Range): number[] {
    return this.level(value, range).clone().convertLinearToSRGB().multiplyScalar(255).toArray();
  }

  // The map as a CSS gradient from left to right.
  get gradient(): string {
    return `linear-gradient(to right, ${this.colours.join(", ")})`;
  }

  fill(pen: CanvasRenderingContext2D, from: [number, number], to: [number, number]): CanvasGradient {
    const filled = pen.createLinearGradient(...from, ...to);
    this.colours.forEach((colour, at) => filled.addColorStop(at / (this.colours.length - 1), colour));
    return filled;
  }

  private level(value: number, range: Range): Color {
    return this.levels[Math.max(0, Math.min(LEVELS - 1, Math.round(partOf(value, range) * (LEVELS - 1))))]!;
  }
}

function between(stops: Color[], part: number): Color {
  const place = part * (stops.length - 1);
  const below = Math.min(Math.floor(place), stops.length - 2);
  return new Color().lerpColors(stops[below]!, stops[below + 1]!, place - below);
}

// The place of a value between two ends, from 0 to 1.
export function partOf(value: number, [low, high]: Range): number {
  return (value - low) / (high > low ? high - low : 1);
}

// Round numbers between two ends, up to a third more than `count`.
export function roundMarks([low, high]: Range, count = 5): number[] {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((times) => times * power).find((step) => step >= 0.75 * rough)!;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  // Twelve digits remove the rounding noise of the product.
  return Array.from({ length: last - first + 1 }, (_, at) => Number(((first + at) * step).toPrecision(12)));
}

// The title of a bar, the bar, and round marks at their places along it.
export function colourBar(map: ColourMap, range: Range, title: string): HTMLElement[] {
  const bar = element("div", { class: "bar" });
  bar.style.background = map.gradient;
  const marks = roundMarks(range).map((mark) => {
    const made = element("span", {}, inDigits(mark));
    made.style.left = `${100 * partOf(mark, range)}%`;
    return made;
  });
  return [element("span", { class: "bar-title" }, title), bar, element("div", { class: "ends" }, ...marks)];
}
