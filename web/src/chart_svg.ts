// A chart as a picture on white, for a paper.

import { acrossTitle, withUnit } from "./plots";
import { inDigits } from "./digits";
import type { Chart } from "./scene";

const [WIDTH, HEIGHT] = [480, 300];
const BOX = { left: 62, right: 466, top: 34, bottom: 256 };
const COLOURS: Record<string, string> = { first: "#f3b562", last: "#0b4f7d" };
const GREY = "#5d666f";

type Range = [number, number];

export function chartSvg(chart: Chart): string {
  const { curves, title } = chart;
  const xs = range(curves.flatMap((curve) => Array.from(curve.x)));
  const ys = range(curves.flatMap((curve) => Array.from(curve.y)));
  const x = (value: number) => BOX.left + ((value - xs[0]) / (xs[1] - xs[0])) * (BOX.right - BOX.left);
  const y = (value: number) => BOX.bottom - ((value - ys[0]) / (ys[1] - ys[0])) * (BOX.bottom - BOX.top);
  const colour = (style: string) => COLOURS[style] ?? GREY;
  const lines = curves.map((curve) => {
    const points = Array.from(curve.x, (at, index) => [at, curve.y[index] ?? NaN] as const);
    const known = points.filter((point) => Number.isFinite(point[1]));
    const places = known.map((point) => `${x(point[0]).toFixed(1)},${y(point[1]).toFixed(1)}`);
    return `<polyline points="${places.join(" ")}" fill="none" stroke="${colour(curve.style)}" stroke-width="1.6"/>`;
  });
  const keys = curves.map(({ name, style }, index) => text(BOX.left + 200 * index, 26, name, `fill="${colour(style)}"`));
  const marks = [
    ...xs.map((value) => text(x(value), BOX.bottom + 16, inDigits(value), 'text-anchor="middle"')),
    ...ys.map((value) => text(BOX.left - 6, y(value) + 4, inDigits(value), 'text-anchor="end"')),
  ];
  const named = [
    text(BOX.left, 14, title, 'font-weight="bold"'),
    text((BOX.left + BOX.right) / 2, HEIGHT - 8, acrossTitle(chart), 'text-anchor="middle"'),
    `<g transform="translate(14 ${(BOX.top + BOX.bottom) / 2}) rotate(-90)">${text(0, 0, withUnit(chart), 'text-anchor="middle"')}</g>`,
  ];
  const frame = `<path d="M${BOX.left} ${BOX.top}V${BOX.bottom}H${BOX.right}" fill="none" stroke="#444"/>`;
  const inside = [frame, ...lines, ...(curves.length > 1 ? keys : []), ...marks, ...named].join("");
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="#fff"/>${inside}</svg>\n`;
}

function text(x: number, y: number, words: string, style: string): string {
  const safe = words.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  return `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" ${style}>${safe}</text>`;
}

function range(values: number[]): Range {
  const finite = values.filter(Number.isFinite);
  const [low, high] = [finite.reduce((a, b) => Math.min(a, b), Infinity), finite.reduce((a, b) => Math.max(a, b), -Infinity)];
  if (low > high) return [0, 1];
  return low === high ? [low - 1, high + 1] : [low, high];
}
