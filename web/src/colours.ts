// Colour maps, whose colours come with the scene, and round marks of their bars.

import { inDigits } from "./digits";
import { element } from "./dom";

const LEVELS = 256;
// As on the flat maps, nothing has the colour of polyethylene.
const BARE = "#f2f0ea";

export type Range = [low: number, high: number];

type Rgb = [number, number, number];

function parts(colour: string): Rgb {
  const all = Number.parseInt(colour.slice(1), 16);
  return [(all >> 16) & 255, (all >> 8) & 255, all & 255];
}

// Converts a part of an sRGB colour to linear light (IEC 61966-2-1).
function linear(part: number): number {
  const share = part / 255;
  return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}

export class ColourMap {
  private readonly levels: Rgb[];
  // For each level its red, green and blue in linear light.
  private readonly light: Float32Array;

  // `colours`: at even distances from little to much, as #rrggbb.
  constructor(private readonly colours: string[]) {
    const stops = colours.map(parts);
    this.levels = Array.from({ length: LEVELS }, (_, level) => between(stops, level / (LEVELS - 1)));
    this.levels[0] = parts(BARE);
    this.light = Float32Array.from(this.levels.flat(), linear);
  }

  // Colours values between two ends, in linear red, green and blue.
  paint(values: ArrayLike<number>, range: Range, into: Float32Array): void {
    for (let i = 0; i < values.length; i++) {
      const from = 3 * level(values[i]!, range);
      into[3 * i] = this.light[from]!;
      into[3 * i + 1] = this.light[from + 1]!;
      into[3 * i + 2] = this.light[from + 2]!;
    }
  }

  // The colour of a value as CSS.
  css(value: number, range: Range): string {
    return `rgb(${this.levels[level(value, range)]!.map(Math.round).join(" ")})`;
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
}

function between(stops: Rgb[], share: number): Rgb {
  const place = share * (stops.length - 1);
  const below = Math.min(Math.floor(place), stops.length - 2);
  const [from, to] = [stops[below]!, stops[below + 1]!];
  return from.map((part, index) => part + (to[index]! - part) * (place - below)) as Rgb;
}

function level(value: number, [low, high]: Range): number {
  const share = (value - low) / (high > low ? high - low : 1);
  return Math.max(0, Math.min(LEVELS - 1, Math.round(share * (LEVELS - 1))));
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

// Round marks at their places along a bar.
export function barMarks([low, high]: Range): HTMLElement[] {
  return roundMarks([low, high]).map((mark) => {
    const made = element("span", {}, inDigits(mark));
    made.style.left = `${high > low ? (100 * (mark - low)) / (high - low) : 0}%`;
    return made;
  });
}
