// Sliders for numbers of the case.

import { element, Slider } from "../dom";
import { inDigits } from "../digits";
import { numberOf, valueAt, withValue, type Place } from "./case_text";

export interface Limits {
  label: string;
  least: number;
  most: number;
  step: number;
}

interface Moved extends Place, Limits {
  unit: string;
  // The default of condyle where the case has no value.
  silent: number;
  // The shape of the body that has the key; absent where every shape has it.
  shape?: string;
  // Factor from the number shown to that of the case.
  times?: number;
}

const GROUPS: [heading: string, moved: Moved[]][] = [
  [
    "Femur",
    [
      { table: "femur", key: "distal_radius_mm", label: "Distal radius", unit: "mm", least: 25, most: 60, step: 0.5, silent: 38, shape: "generic" },
      { table: "femur", key: "posterior_radius_mm", label: "Posterior radius", unit: "mm", least: 15, most: 30, step: 0.5, silent: 22, shape: "generic" },
      {
        table: "femur",
        key: "coronal_radius_mm",
        label: "Coronal radius of the femur",
        unit: "mm",
        least: 15,
        most: 29,
        step: 0.5,
        silent: 24,
        shape: "generic",
      },
    ],
  ],
  [
    "Insert",
    [
      {
        table: "insert",
        key: "sagittal_radius_mm",
        label: "Sagittal radius of the dish",
        unit: "mm",
        least: 42,
        most: 120,
        step: 1,
        silent: 55,
        shape: "generic",
      },
      {
        table: "insert",
        key: "coronal_radius_mm",
        label: "Coronal radius of the dish",
        unit: "mm",
        least: 25,
        most: 100,
        step: 1,
        silent: 30,
        shape: "generic",
      },
      { table: "insert", key: "thickness_mm", label: "Thickness", unit: "mm", least: 4, most: 15, step: 0.5, silent: 9, shape: "generic" },
    ],
  ],
  [
    "Placement",
    [
      { table: "femur", key: "varus_deg", label: "Varus of the femur", unit: "°", least: -4, most: 4, step: 0.25, silent: 0 },
      { table: "femur", key: "external_rotation_deg", label: "External rotation of the femur", unit: "°", least: -8, most: 8, step: 0.5, silent: 0 },
      { table: "insert", key: "posterior_slope_deg", label: "Posterior slope of the insert", unit: "°", least: -4, most: 10, step: 0.5, silent: 0 },
    ],
  ],
  [
    "Test",
    [
      { table: "machine.axial_force", key: "scale", label: "Load, relative to the waveform", unit: "", least: 0.4, most: 1.6, step: 0.05, silent: 1 },
      { table: "contact", key: "friction", label: "Friction", unit: "", least: 0, most: 0.2, step: 0.01, silent: 0.07 },
      { table: "march", key: "cycles", label: "Cycles", unit: "million", least: 0.5, most: 20, step: 0.5, silent: 5, times: 1e6 },
    ],
  ],
];

// The label and the range of the slider of a number.
export function movedAt({ table, key }: Place): Limits {
  const found = GROUPS.flatMap(([, moved]) => moved).find((moved) => moved.table === table && moved.key === key);
  if (!found) throw new Error(`no slider moves ${table}.${key}`);
  return found;
}

export class Sliders {
  readonly box = element("div", { class: "sliders" });
  private readonly rows: { moved: Moved; slider: Slider }[] = [];

  constructor(
    private readonly text: () => string,
    // Called with the changed text of the case.
    private readonly changed: (text: string) => void,
  ) {
    for (const [heading, all] of GROUPS) {
      const rows = all.map((moved) => this.row(moved));
      this.box.append(element("fieldset", {}, element("legend", {}, heading), ...rows));
    }
  }

  // Shows the numbers of the present case.
  show(): void {
    const text = this.text();
    for (const { moved, slider } of this.rows) {
      const { input } = slider;
      const times = moved.times ?? 1;
      const value = numberOf(text, moved);
      const found = value === undefined ? moved.silent : value / times;
      input.disabled = moved.shape !== undefined && (valueAt(text, { table: moved.table, key: "shape" }) ?? "generic") !== moved.shape;
      // A number outside of the slider widens its range.
      input.min = String(Math.min(moved.least, found));
      input.max = String(Math.max(moved.most, found));
      slider.value = found;
      if (input.disabled) slider.say("not of this shape");
    }
  }

  private row(moved: Moved): HTMLElement {
    const slider = new Slider(
      moved.label,
      [moved.least, moved.most, moved.step],
      (value) => inWords(value, moved),
      (value) => this.move(moved, value),
    );
    this.rows.push({ moved, slider });
    return slider.box;
  }

  private move(moved: Moved, value: number): void {
    const times = moved.times ?? 1;
    if (times === 1) this.set([moved], value);
    else this.write([moved], String(Number((value * times).toPrecision(12))));
  }

  // Sets the keys at some places to one number.
  set(places: Place[], value: number): void {
    // Steps are decimal: without rounding noise in the text.
    const written = Number(value.toPrecision(12));
    this.write(places, Number.isInteger(written) ? written.toFixed(1) : String(written));
  }

  private write(places: Place[], written: string): void {
    this.changed(places.reduce((text, place) => withValue(text, place, written), this.text()));
    this.show();
  }
}

function inWords(value: number, { unit }: Moved): string {
  return unit ? `${inDigits(value)} ${unit}` : inDigits(value);
}
