// The numbers of a run: those of summary.json, with their errors; and two runs beside each other.

import { element } from "../dom";
import { inDigits, quantity, withUnit } from "../quantities";

export interface Summary {
  cycles: number;
  wall_s: number;
  error: ({ wall_s: number } & Record<string, { total: number } | number>) | null;
  plausibility: { message: string; advice: string }[];
  warnings: string[];
  [number: string]: unknown;
}

const SHOWN: [name: string, label: string][] = [
  ["mass_loss_mg", "Mass loss"],
  ["max_depth_mm", "Deepest wear"],
  ["volume_loss_mm3", "Volume loss"],
  ["peak_pressure_mpa", "Peak pressure"],
  ["peak_contact_area_mm2", "Largest contact area"],
  ["ap_range_mm", "AP range, first cycle"],
  ["ie_range_deg", "IE range, first cycle"],
];

function errorOf(summary: Summary, name: string): number | undefined {
  const found = summary.error?.[name];
  return typeof found === "object" ? found.total : undefined;
}

// Each number in large type, with its discretisation error where one was estimated.
export function tiles(summary: Summary): HTMLElement[] {
  return SHOWN.map(([name, label]) => {
    const { unit } = quantity(name);
    const value = element("dd", { "data-number": name }, inDigits(summary[name] as number), element("span", {}, ` ${unit}`));
    const error = errorOf(summary, name);
    if (error !== undefined) value.append(element("small", {}, `± ${Number(error.toPrecision(2))} ${unit} by discretisation`));
    return element("div", {}, element("dt", {}, label), value);
  });
}

// What makes the run doubtful, and what was put right on the way in.
export function doubts({ plausibility, warnings }: Summary): HTMLElement[] {
  const doubtful = plausibility.map(({ message, advice }) => element("li", {}, element("strong", {}, message), ` ${advice}`));
  return [...doubtful, ...warnings.map((warning) => element("li", {}, warning))];
}

// Two runs and by how much the second differs.
export function comparison(kept: Summary, now: Summary): HTMLTableElement {
  const cells = (tag: "th" | "td", words: string[]) => words.map((text) => element(tag, {}, text));
  const head = element("tr", {}, ...cells("th", ["", "kept", "now", "difference"]));
  const rows = SHOWN.map(([name, label]) => {
    const [before, after] = [kept[name] as number, now[name] as number];
    const change = before === 0 ? "–" : `${inDigits(100 * (after / before - 1))} %`;
    const named = element("th", { scope: "row" }, withUnit({ ...quantity(name), label }));
    return element("tr", {}, named, ...cells("td", [inDigits(before), inDigits(after), change]));
  });
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
}
