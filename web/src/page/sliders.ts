// Sliders for numbers of the case.

import { element, Slider } from "../dom";
import { inDigits } from "../digits";
import { numberIn, unquoted, valuesOf, withValue, type Place } from "./case_text";

export interface Limits {
  label: string;
  least: number;
  most: number;
  step: number;
}

interface Moved extends Place, Limits {
  unit: string;
  // The shapes of the body that have the key; absent where every shape has it.
  shapes?: string[];
  // Factor from the number shown to that of the case.
  times?: number;
}

const GENERIC = ["generic"];
const OF_KNEES = ["generic", "mesh"];
const GROUPS: [heading: string, moved: Moved[]][] = [
  [
    "Femur",
    [
      { table: "femur", key: "distal_radius_mm", label: "Distal radius", unit: "mm", least: 25, most: 60, step: 0.5, shapes: GENERIC },
      { table: "femur", key: "posterior_radius_mm", label: "Posterior radius", unit: "mm", least: 15, most: 30, step: 0.5, shapes: GENERIC },
      {
        table: "femur",
        key: "coronal_radius_mm",
        label: "Coronal radius of the femur",
        unit: "mm",
        least: 15,
        most: 29,
        step: 0.5,
        shapes: GENERIC,
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
        shapes: GENERIC,
      },
      {
        table: "insert",
        key: "coronal_radius_mm",
        label: "Coronal radius of the dish",
        unit: "mm",
        least: 25,
        most: 100,
        step: 1,
        shapes: GENERIC,
      },
      { table: "insert", key: "thickness_mm", label: "Thickness", unit: "mm", least: 4, most: 15, step: 0.5, shapes: GENERIC },
    ],
  ],
  [
    "Placement",
    [
      { table: "femur", key: "varus_deg", label: "Varus of the femur", unit: "°", least: -4, most: 4, step: 0.25, shapes: OF_KNEES },
      { table: "femur", key: "external_rotation_deg", label: "External rotation of the femur", unit: "°", least: -8, most: 8, step: 0.5, shapes: OF_KNEES },
      { table: "insert", key: "posterior_slope_deg", label: "Posterior slope of the insert", unit: "°", least: -4, most: 10, step: 0.5, shapes: OF_KNEES },
    ],
  ],
  [
    "Test",
    [
      { table: "machine", key: "load_scale", label: "Loads, relative to the waveforms", unit: "", least: 0.4, most: 1.6, step: 0.05 },
      { table: "contact", key: "friction", label: "Friction", unit: "", least: 0, most: 0.2, step: 0.01 },
      { table: "march", key: "cycles", label: "Cycles", unit: "million", least: 0.5, most: 20, step: 0.5, times: 1e6 },
    ],
  ],
];

// The label and the range of the slider of a number.
export function movedAt({ table, key }: Place): Limits {
  const found = GROUPS.flatMap(([, moved]) => moved).find((moved) => moved.table === table && moved.key === key);
  if (!found) throw new Error(`no slider moves ${table}.${key}`);
  return found;
}

// Facts from the run of a case: its joint, and the values of the case with every default.
export interface Defaults {
  joint: string;
  values: Map<string, string>;
}

// The number of the case for a slider, or why it has none.
export function shownAt({ table, key, shapes }: Place & Partial<Moved>, values: Map<string, string>, defaults?: Defaults): number | string {
  const at = (name: string) => values.get(`${table}.${name}`) ?? defaults?.values.get(`${table}.${name}`);
  const shape = unquoted(at("shape") ?? "");
  if (shapes && shape && !shapes.includes(shape)) return OF_KNEES.includes(shape) ? "not of this shape" : "not of this joint";
  const written = numberIn(at(key));
  if (written !== undefined) return written;
  if (!defaults) return "–";
  return defaults.joint === "knee" ? "not of this case" : "not of this joint";
}

export class Sliders {
  readonly box = element("div", { class: "sliders" });
  private readonly rows: { moved: Moved; slider: Slider }[] = [];
  private defaults: Defaults | undefined;

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
    const values = valuesOf(this.text());
    for (const { moved, slider } of this.rows) {
      const { input } = slider;
      const value = shownAt(moved, values, this.defaults);
      input.disabled = typeof value === "string";
      if (typeof value === "string") slider.say(value);
      else {
        const shown = value / (moved.times ?? 1);
        // A number outside of the slider widens its range.
        input.min = String(Math.min(moved.least, shown));
        input.max = String(Math.max(moved.most, shown));
        slider.value = shown;
      }
    }
  }

  // Shows the defaults of a run; without them, sliders whose number is not in the text wait, since defaults depend on the joint.
  showDefaults(defaults?: Defaults): void {
    this.defaults = defaults;
    this.show();
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
