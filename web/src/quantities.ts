// Names of fields in words; their unit is the end of the name.

const UNITS: [ending: string, unit: string][] = [
  ["_mm2", "mm²"],
  ["_mm3", "mm³"],
  ["_mm", "mm"],
  ["_mpa", "MPa"],
  ["_deg", "°"],
  ["_mg", "mg"],
  ["_n", "N"],
];

const WORDS: Record<string, string> = {
  ap: "AP translation",
  ml: "ML translation",
  is: "IS translation",
  ie: "IE rotation",
  vv: "VV rotation",
  depth_per_cycle: "Depth per cycle",
  sliding_distance: "Sliding distance per cycle",
  thickness: "Thickness left",
  von_mises: "Von Mises stress",
  max_shear: "Greatest shear stress",
};

export interface Quantity {
  name: string;
  label: string;
  unit: string;
}

export function quantity(name: string): Quantity {
  const found = UNITS.find(([ending]) => name.endsWith(ending));
  const stem = found ? name.slice(0, -found[0].length) : name;
  const words = stem.replaceAll("_", " ");
  const label = WORDS[stem] ?? words.charAt(0).toUpperCase() + words.slice(1);
  return { name, label, unit: found?.[1] ?? "" };
}

export function withUnit({ label, unit }: Quantity): string {
  return unit ? `${label}, ${unit}` : label;
}

// Four digits, as in the tables of the report, with a true minus sign.
export function inDigits(value: number): string {
  if (!Number.isFinite(value)) return "–";
  const text = value === 0 ? "0" : Number(value.toPrecision(4)).toString();
  return text.replace("-", "−");
}

export function cyclesInWords(cycles: number | null): string {
  if (cycles === null) return "an unknown number of cycles";
  return cycles >= 1e6 ? `${inDigits(cycles / 1e6)} million cycles` : `${inDigits(cycles)} cycles`;
}
