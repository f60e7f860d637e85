// A scene as condyle writes it: bodies, updates, cycles and charts as arrays (crates/condyle-report/src/scene).

import type { Range } from "./colours";

export interface CycleFacts {
  name: string;
  cycles: number;
  increments: number;
  has_pressure: boolean;
}

export interface Pose {
  femoral_origin_mm: number[];
  rotation: number[][];
}

// A field of the surface, its name in words and its unit.
export interface Field {
  name: string;
  label: string;
  unit: string;
  // The colours of its flat map, from little to much.
  colours: string[];
}

interface Facts {
  title: string;
  // Names of +x, -x, -z and +z.
  directions: string[];
  // Whether the surface has one side at z below 0 and one above, as that of a knee.
  has_sides: boolean;
  // JSON has no NaN: an update whose cycles are not known has none.
  updates: (number | null)[];
  fields: Field[];
  cycles: CycleFacts[];
  neutral_pose: Pose | null;
  has_femur: boolean;
  // The name of the moving body, such as "femur" or "head".
  counterface: string;
  charts: ChartFacts[];
  missing: string[];
}

interface ChartFacts {
  id: string;
  // Charts of one group share their cursor.
  group: string;
  title: string;
  unit: string;
  // The positive direction in words; may be empty.
  positive: string;
  from_zero: boolean;
  // The smallest span of the vertical axis, so that noise does not fill the picture.
  min_span: number;
  x_title: string;
  // Cycles for one unit of the horizontal axis; 0 where it shows no cycles.
  cycles_per_x: number;
  curves: { name: string; style: string; has_dots: boolean }[];
}

export type Curve = ChartFacts["curves"][number] & { x: ArrayLike<number>; y: ArrayLike<number> };

export interface Chart extends ChartFacts {
  curves: Curve[];
}

interface Entry {
  name: string;
  kind: "u16" | "u32" | "f64" | "q16";
  offset: number;
  length: number;
  range?: Range;
}

type Whole = Uint16Array | Uint32Array;

export interface Pressed {
  nodes: Whole;
  pressures: Float32Array;
}

export class Scene {
  readonly facts: Facts;
  private readonly entries = new Map<string, Entry>();
  private readonly start: number;

  constructor(private readonly buffer: ArrayBuffer) {
    const length = Number(new DataView(buffer).getBigUint64(0, true));
    const head = new TextDecoder().decode(new Uint8Array(buffer, 8, length));
    const { facts, arrays } = JSON.parse(head) as { facts: Facts; arrays: Entry[] };
    this.facts = facts;
    this.start = 8 + length;
    for (const entry of arrays) this.entries.set(entry.name, entry);
  }

  whole(name: string): Whole {
    const { kind, offset, length } = this.entry(name);
    const Kind = kind === "u32" ? Uint32Array : Uint16Array;
    return new Kind(this.buffer, this.start + offset, length);
  }

  exact(name: string): Float64Array {
    const { offset, length } = this.entry(name);
    return new Float64Array(this.buffer, this.start + offset, length);
  }

  // Values of an array that is stored in 16 bits of its range.
  values(name: string): Float32Array {
    const { offset, length, range } = this.entry(name);
    const [low, high] = range ?? [0, 0];
    const levels = new Uint16Array(this.buffer, this.start + offset, length);
    const values = new Float32Array(length);
    // Several times as fast as `Float32Array.from` with a function.
    for (let i = 0; i < length; i++) values[i] = low + ((high - low) * levels[i]!) / 65535;
    return values;
  }

  // The articulating surface after an update, mm.
  surface(update: number): Float32Array {
    const places = this.values("surface.nodes");
    this.values(`surface.moved.${update}`).forEach((moved, index) => (places[index]! += moved));
    return places;
  }

  field(name: string, update: number): Float32Array {
    return this.values(`field.${name}.${update}`);
  }

  fieldRange(name: string): Range {
    return this.entry(`field.${name}.0`).range ?? [0, 0];
  }

  // The nodes under pressure at every increment of a cycle.
  pressed(cycle: CycleFacts): Pressed[] {
    const starts = this.whole(`cycle.${cycle.name}.starts`);
    const nodes = this.whole(`cycle.${cycle.name}.nodes`);
    const pressures = this.values(`cycle.${cycle.name}.pressure_mpa`);
    const all: Pressed[] = [];
    for (let i = 0; i + 1 < starts.length; i++) {
      const [from, to] = [starts[i]!, starts[i + 1]!];
      all.push({ nodes: nodes.subarray(from, to), pressures: pressures.subarray(from, to) });
    }
    return all;
  }

  highestPressure(cycle: CycleFacts): number {
    return this.entry(`cycle.${cycle.name}.pressure_mpa`).range?.[1] ?? 0;
  }

  // The charts of the run, as the report declares them.
  charts(): Chart[] {
    return this.facts.charts.map((chart) => ({
      ...chart,
      curves: chart.curves.map((curve, index) => {
        const values = (axis: string) => this.exact(`chart.${chart.id}.${index}.${axis}`);
        return { ...curve, x: values("x"), y: values("y") };
      }),
    }));
  }

  private entry(name: string): Entry {
    const entry = this.entries.get(name);
    if (!entry) throw new Error(`the scene has no array ${name}`);
    return entry;
  }
}
