// The numbers of a run from summary.json with their errors, and the comparison of two runs.

import { element } from "../dom";
import { inDigits } from "../digits";
import { HEADLINES, type Headline, type Numbers } from "./catalogue";

interface Interval {
  low: number;
  median: number;
  high: number;
}

// What laboratories would find: `is_of_run` if by the law of the run.
interface Prediction {
  is_of_run: boolean;
  mass_loss_mg: Interval;
  max_depth_mm: Interval;
}

export interface Summary extends Numbers {
  joint: string;
  error: ({ wall_s: number } & Record<string, { total: number } | number>) | null;
  plausibility: { message: string; advice: string }[];
  notes: { message: string; advice: string }[];
  prediction?: Prediction;
  warnings: string[];
}

function shownValue(summary: Summary, { key, isShare }: Headline): number {
  const value = summary[key] ?? NaN;
  return isShare ? 100 * value : value;
}

// The numbers that one of the runs has: other joints than the knee lack some.
export function headlinesOf(...summaries: Partial<Numbers>[]): Headline[] {
  return HEADLINES.filter(({ key }) => summaries.some((summary) => (summary[key] ?? null) !== null));
}

function errorOf(summary: Summary, name: string): number | undefined {
  const found = summary.error?.[name];
  return typeof found === "object" ? found.total : undefined;
}

function printed(unit: string): string {
  return unit.replace("mm2", "mm²").replace("mm3", "mm³");
}

function capital(label: string): string {
  return label.charAt(0).toUpperCase() + label.slice(1);
}

// Each number in large type, with its discretisation error where one was estimated.
export function tiles(summary: Summary): HTMLElement[] {
  return headlinesOf(summary).map((headline) => {
    const { key, label, unit } = headline;
    const shown = inDigits(shownValue(summary, headline));
    const value = element("dd", { "data-number": key }, shown, element("span", {}, ` ${printed(unit)}`));
    const interval = key === "mass_loss_mg" || key === "max_depth_mm" ? summary.prediction?.[key] : undefined;
    if (interval !== undefined) {
      const [low, median, high] = [interval.low, interval.median, interval.high].map((end) => Number(end.toPrecision(2)));
      const by = summary.prediction?.is_of_run ? "" : `calibrated law: ${median}; `;
      value.append(element("small", { "data-interval": key }, `${by}90 % of laboratories: ${low} to ${high} ${unit}`));
    }
    const error = errorOf(summary, key);
    if (error !== undefined) value.append(element("small", {}, `± ${Number(error.toPrecision(2))} ${printed(unit)} by discretisation`));
    return element("div", {}, element("dt", {}, capital(label)), value);
  });
}

// Plausibility warnings, and warnings from reading the case.
export function doubts({ plausibility, warnings }: Summary): HTMLElement[] {
  const doubtful = plausibility.map(({ message, advice }) => element("li", {}, element("strong", {}, message), ` ${advice}`));
  return [...doubtful, ...warnings.map((warning) => element("li", {}, warning))];
}

// Remarks on the physics that leave the numbers sound.
export function notes(summary: Summary): HTMLElement[] {
  return summary.notes.map(({ message, advice }) => element("p", { class: "note" }, `${capital(message)}. ${advice}`));
}

// Two runs with their errors, and the difference of the second from the first.
export function comparison(kept: Summary, now: Summary): HTMLTableElement {
  const cells = (tag: "th" | "td", words: string[]) => words.map((text) => element(tag, {}, text));
  const head = element("tr", {}, ...cells("th", ["", "kept", "this run", "difference", "of the errors"]));
  const rows = headlinesOf(kept, now).map((headline) => {
    const [before, after] = [shownValue(kept, headline), shownValue(now, headline)];
    const [first, second] = [kept, now].map((summary) => errorOf(summary, headline.key));
    const withError = (value: number, error?: number) => (error === undefined ? inDigits(value) : `${inDigits(value)} ± ${Number(error.toPrecision(2))}`);
    const change = before === 0 || !Number.isFinite(after / before) ? "–" : signed(100 * (after / before - 1), "%");
    const named = element("th", { scope: "row" }, `${capital(headline.label)}, ${printed(headline.unit)}`);
    return element("tr", {}, named, ...cells("td", [withError(before, first), withError(after, second), change, times(after - before, first, second)]));
  });
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
}

// The answer to which of two runs wears more, in a sentence.
export function verdict(kept: Summary, now: Summary): string {
  const [before, after] = [kept.mass_loss_mg, now.mass_loss_mg];
  if (before === after) return "Both runs wear the same mass.";
  const judged = times(after - before, errorOf(kept, "mass_loss_mg"), errorOf(now, "mass_loss_mg"));
  const errors = judged === "–" ? "" : `, ${judged} the discretisation errors of both`;
  const [more, part] = [inDigits(Math.abs(after - before)), signed(100 * (after / before - 1), "%")];
  return `This run wears ${more} mg ${after > before ? "more" : "less"} than the kept one (${part})${errors}.`;
}

// A difference over the sum of the errors.
function times(difference: number, ...errors: (number | undefined)[]): string {
  const sum = errors.reduce((sum: number, error) => sum + (error ?? NaN), 0);
  return sum > 0 ? `${Number((Math.abs(difference) / sum).toPrecision(2))} times` : "–";
}

function signed(value: number, unit: string): string {
  return `${value > 0 ? "+" : ""}${inDigits(Number(value.toPrecision(3)))} ${unit}`;
}
