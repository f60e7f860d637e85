// Sliders for numbers of the case.

import { element, Slider } from "../dom";
import { inDigits } from "../digits";
import { numberIn, valuesOf, withValue, type Place } from "./case_text";
import { unquoted } from "./toml_places";

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

// The slider of a key, such as `insert.thickness_mm`.
function moved(path: string, label: string, [least, most, step]: [number, number, number], unit = "", shapes?: string[]): Moved {
  const [table, key] = path.split(".") as [string, string];
  return { table, key, label, least, most, step, unit, ...(shapes && { shapes }) };
}

// By their headings.
const GROUPS: Record<string, Moved[]> = {
  Femur: [
    moved("femur.distal_radius_mm", "Distal radius", [25, 60, 0.5], "mm", GENERIC),
    moved("femur.posterior_radius_mm", "Posterior radius", [15, 30, 0.5], "mm", GENERIC),
    moved("femur.coronal_radius_mm", "Coronal radius of the femur", [15, 29, 0.5], "mm", GENERIC),
  ],
  Insert: [
    moved("insert.sagittal_radius_mm", "Sagittal radius of the dish", [42, 120, 1], "mm", GENERIC),
    moved("insert.coronal_radius_mm", "Coronal radius of the dish", [25, 100, 1], "mm", GENERIC),
    moved("insert.thickness_mm", "Thickness", [4, 15, 0.5], "mm", GENERIC),
  ],
  Placement: [
    moved("femur.varus_deg", "Varus of the femur", [-4, 4, 0.25], "°", OF_KNEES),
    moved("femur.external_rotation_deg", "External rotation of the femur", [-8, 8, 0.5], "°", OF_KNEES),
    moved("insert.posterior_slope_deg", "Posterior slope of the insert", [-4, 10, 0.5], "°", OF_KNEES),
  ],
  Test: [
    moved("machine.load_scale", "Loads, relative to the waveforms", [0.4, 1.6, 0.05]),
    moved("contact.friction", "Friction", [0, 0.2, 0.01]),
    { ...moved("march.cycles", "Cycles", [0.5, 20, 0.5], "million"), times: 1e6 },
  ],
};

// The label and the range of the slider of a number.
export function movedAt({ table, key }: Place): Limits {
  const found = Object.values(GROUPS)
    .flat()
    .find((one) => one.table === table && one.key === key);
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
    for (const [heading, all] of Object.entries(GROUPS)) {
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
