// A picture of the bodies as a slide: with title, names of the directions, scale and colour bar.

import { partOf, roundMarks, type ColourMap, type Range } from "./colours";
import { inDigits } from "./digits";
import { element } from "./dom";
import type { Shot } from "./stage";

const [WIDTH, HEIGHT] = [1920, 1080];
// The part of the slide for the bodies, px, and the colour bar.
const BODIES = { left: 40, top: 150, width: 1500, height: 850 };
const BAR = { left: 1640, top: 220, width: 44, height: 640 };
const [INK, SOFT] = ["#16191d", "#5d666f"];

export interface Legend {
  // The run, and what the colours show.
  title: string;
  field: string;
  // The state of the bodies in words.
  state: string;
  range: Range;
  map: ColourMap;
}

export function newSlide(): HTMLCanvasElement {
  return element("canvas", { width: WIDTH, height: HEIGHT });
}

// Draws on a slide and returns it.
export function slide({ canvas, names, scale }: Shot, legend: Legend, made = newSlide()): HTMLCanvasElement {
  const pen = made.getContext("2d")!;
  const write = (words: string, x: number, y: number, px: number, colour = INK) => {
    pen.font = `${px}px Inter, "Helvetica Neue", "Segoe UI", Roboto, Arial, sans-serif`;
    pen.fillStyle = colour;
    pen.fillText(words, x, y);
  };
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, WIDTH, HEIGHT);
  const size = Math.min(BODIES.width / canvas.width, BODIES.height / canvas.height);
  const [width, height] = [size * canvas.width, size * canvas.height];
  const [left, top] = [BODIES.left + (BODIES.width - width) / 2, BODIES.top + (BODIES.height - height) / 2];
  pen.drawImage(canvas, left, top, width, height);
  write(legend.title, BODIES.left, 72, 46);
  write(legend.state, BODIES.left, 122, 28, SOFT);
  if (scale) {
    const [from, to, below] = [left + 24, left + 24 + scale.part * height, top + height - 24];
    pen.fillRect(from, below, to - from, 4);
    pen.textAlign = "center";
    write(scale.words, (from + to) / 2, below - 10, 24);
  }
  pen.textAlign = "center";
  for (const { words, x, y } of names) write(words, left + x * width, top + y * height, 26, SOFT);
  // A long name ends at the edge of the slide.
  pen.textAlign = "right";
  write(legend.field, WIDTH - BODIES.left, BAR.top - 40, 28);
  pen.textAlign = "left";
  drawBar(pen, legend, write);
  return made;
}

function drawBar(pen: CanvasRenderingContext2D, { range, map }: Legend, write: (words: string, x: number, y: number, px: number) => void): void {
  pen.fillStyle = map.fill(pen, [0, BAR.top + BAR.height], [0, BAR.top]);
  pen.fillRect(BAR.left, BAR.top, BAR.width, BAR.height);
  for (const mark of roundMarks(range)) {
    const y = BAR.top + BAR.height * (1 - partOf(mark, range));
    write(inDigits(mark), BAR.left + BAR.width + 18, y + 9, 26);
    pen.fillRect(BAR.left + BAR.width, y - 1, 10, 2);
  }
}
