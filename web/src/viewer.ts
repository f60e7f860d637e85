// The stage with its controls: update or instant, field, colours, sections and views.

import { colourBar, ColourMap, type Range } from "./colours";
import { button, choice, element, labelled, Slider } from "./dom";
import type { FlatStage } from "./flat_stage";
import { forces, shares } from "./forces";
import { cyclesInWords, inDigits } from "./digits";
import { withUnit } from "./plots";
import { glb } from "./glb";
import { save, savePicture } from "./save";
import { newSlide, slide } from "./slide";
import { typeOfVideo, video } from "./video";
import { matrixOf, stageOf, VIEWS, type Axis, type Force, type Stage, type View } from "./stage";
import type { CycleFacts, Pressed, Scene } from "./scene";

// The pressure through the cycle, by which the surface can be coloured besides the fields of an update.
const IN_CYCLE = "pressure_mpa";
// Duration of a cycle on the screen, s.
const SECONDS_A_CYCLE = 4;
// Smallest time between two changes of the text while the cycle plays, ms.
const READ_MS = 150;
// Range of the section slider on both sides of the middle, mm.
const SECTION_MM = 45;
// Height of the bodies in a saved picture, px.
const SLIDE_PX = 850;
// The same in a video, which is drawn while it is recorded.
const VIDEO_PX = 600;
// A point farther than this from every node is outside of the surface, mm.
const REACH_MM = 3;

// What is shown; absent parts stay as they are.
export interface Chosen {
  // Cycles before the update.
  cycles?: number;
  field?: string;
  percent?: number;
}

interface Cycle {
  facts: CycleFacts;
  // Known once the cycle is shown.
  pressed?: Pressed[];
  poses: Float64Array;
  percents: Float64Array;
  // The update with the surface that the cycle was solved on.
  update: number;
}

export class Viewer {
  readonly box = element("div", { class: "viewer" });
  readonly stage: Stage | FlatStage;
  // Called with the percent of the cycle that is shown.
  onPercent: (percent: number) => void = () => {};
  // Called with the node that was picked.
  onPick: (node: number) => void = () => {};
  // Called when update, field or instant have been chosen.
  onChoose: (chosen: Chosen) => void = () => {};
  private readonly cycles: Cycle[];
  private field: string;
  private update: number;
  private instant = 0;
  private exaggeration = 1;
  private isInCycle = false;
  private cycle: Cycle | undefined;
  private playing = 0;
  private surface = new Float32Array();
  private share = new Float32Array();
  private node: number | undefined;
  private legendShown = "";
  private statusAt = 0;
  private readonly status = element("output", { class: "status" });
  private readonly picked = element("div", { class: "picked", "aria-live": "polite" });
  private readonly legend = element("div", { class: "legend" });
  private ranges = new Map<string, Range>();
  private readonly maps = new Map<string, ColourMap>();
  private readonly fields: HTMLSelectElement;
  private readonly updates: Slider;
  private readonly instants: Slider;
  private readonly play = button("Play", () => this.togglePlay());

  // `previous`: a viewer that ends, whose renderer goes on.
  constructor(
    private readonly scene: Scene,
    previous?: Viewer,
  ) {
    const { updates, fields } = scene.facts;
    const host = element("div", { class: "stage" });
    this.stage = stageOf(host, scene, previous?.stage);
    this.update = updates.length - 1;
    this.field = (fields.find(({ name }) => name === "wear_depth_mm") ?? fields[0])?.name ?? IN_CYCLE;
    this.cycles = cyclesOf(scene);
    this.cycle = this.cycles.at(-1);
    this.fields = choice(this.shownFields(), (field) => this.chooseField(field));
    this.fields.value = this.field;
    const after = (update: number) => cyclesInWords(updates[update] ?? null);
    this.updates = new Slider("After update", [0, updates.length - 1, 1], after, (update) => this.chooseUpdate(update));
    const last = Math.max(0, (this.cycle?.percents.length ?? 1) - 1);
    const percent = (instant: number) => `${inDigits(this.cycle?.percents[instant] ?? 0)} %`;
    this.instants = new Slider("Through the cycle", [0, last, 1], percent, (instant) => this.chooseInstant(instant));
    this.instants.value = 0;
    this.box.append(host, this.legend, this.status, this.controls(), this.picked);
    this.listen(host);
    this.showUpdate(this.update);
  }

  showUpdate(update: number): void {
    this.stop();
    this.isInCycle = false;
    this.update = update;
    this.updates.value = update;
    if (this.field === IN_CYCLE) this.field = this.fields.value = this.scene.facts.fields[0]?.name ?? IN_CYCLE;
    this.surface = this.scene.surface(update) as Float32Array<ArrayBuffer>;
    this.stage.moveFemur();
    this.stage.press([]);
    this.place();
    this.say(`After ${cyclesInWords(this.scene.facts.updates[update] ?? null)}`);
  }

  showInstant(instant: number): void {
    const cycle = this.cycle;
    if (!cycle) return;
    if (!this.isInCycle) this.enter(cycle);
    this.instant = instant;
    const isRead = this.isToBeRead();
    if (isRead) this.instants.value = instant;
    const pressed = cycle.pressed?.[instant];
    this.stage.moveFemur(matrixOf(cycle.poses.subarray(12 * instant, 12 * instant + 12)));
    if (pressed) {
      const found = forces(pressed, this.surface, this.share, this.scene.facts.has_sides);
      this.stage.press(found);
      if (isRead) this.describe(cycle, instant, found);
    }
    this.recolour();
    this.onPercent(cycle.percents[instant] ?? 0);
  }

  // Shows the instant nearest to a percent of the cycle.
  showPercent(percent: number): void {
    if (this.cycle) this.showInstant(nearest(this.cycle.percents, percent));
  }

  get shownField(): string {
    return this.field;
  }

  // Takes the view and the field of another viewer.
  lookAs(other: Viewer): void {
    this.stage.lookAs(other.stage);
    if (other.field !== IN_CYCLE) this.choose({ field: other.field });
  }

  // Takes what was chosen in another viewer.
  choose({ cycles, field, percent }: Chosen): void {
    if (cycles !== undefined) this.showUpdate(updateAfter(this.scene, cycles));
    if (percent !== undefined) this.showPercent(percent);
    if (field === undefined || ![...this.fields.options].some(({ value }) => value === field)) return;
    this.fields.value = field;
    this.colourBy(field);
  }

  // Colours the field as in the other viewers, which have larger values.
  widen(ranges: Map<string, Range>): void {
    this.ranges = ranges;
    this.recolour();
  }

  // The range of each field.
  ownRanges(): Map<string, Range> {
    const names = [...this.scene.facts.fields.map(({ name }) => name), IN_CYCLE];
    return new Map(names.map((name) => [name, this.rangeOf(name)]));
  }

  dispose(): void {
    this.stop();
    this.stage.dispose();
  }

  // While the cycle plays, text and controls change no more often than can be read, since every change is painted.
  private isToBeRead(): boolean {
    const now = performance.now();
    if (this.playing && now - this.statusAt < READ_MS) return false;
    this.statusAt = now;
    return true;
  }

  private describe({ facts, percents }: Cycle, instant: number, found: Force[]): void {
    const sides = found.map(({ newtons }) => `${Math.round(newtons)} N`).join(" and ");
    this.say(`${inDigits(percents[instant]!)} % of the ${facts.name} cycle${sides ? `: ${sides} on the surface` : ""}`);
  }

  private enter(cycle: Cycle): void {
    this.isInCycle = true;
    if (cycle.facts.has_pressure) cycle.pressed ??= this.scene.pressed(cycle.facts);
    this.surface = this.scene.surface(cycle.update) as Float32Array<ArrayBuffer>;
    this.share = shares(this.surface, this.scene.whole("surface.quads")) as Float32Array<ArrayBuffer>;
    if (cycle.facts.has_pressure) this.field = this.fields.value = IN_CYCLE;
    this.place();
  }

  private colourBy(field: string): void {
    if (field === IN_CYCLE) this.showInstant(this.instant);
    else {
      this.field = field;
      this.recolour();
    }
  }

  private place(): void {
    this.stage.place(this.surface, this.exaggeration);
    if (this.node !== undefined) this.stage.mark(this.node);
    this.recolour();
  }

  private recolour(): void {
    const range = this.range();
    this.stage.colour(this.shownValues(), range, this.map());
    this.drawLegend(range);
  }

  private drawLegend(range: Range): void {
    const shown = [this.field, ...range].join();
    if (shown === this.legendShown) return;
    this.legendShown = shown;
    this.legend.replaceChildren(...colourBar(this.map(), range, this.fieldInWords()));
  }

  private fieldInWords(): string {
    return this.shownFields().find(([name]) => name === this.field)?.[1] ?? "";
  }

  // The pressure of an instant has the colours of the peak pressure.
  private map(): ColourMap {
    const name = this.field === IN_CYCLE ? "peak_pressure_mpa" : this.field;
    const { fields } = this.scene.facts;
    const { colours } = fields.find((field) => field.name === name) ?? fields[0]!;
    const made = this.maps.get(name) ?? new ColourMap(colours);
    this.maps.set(name, made);
    return made;
  }

  private shownValues(): Float32Array {
    if (this.field !== IN_CYCLE) return this.scene.field(this.field, this.isInCycle ? this.cycle!.update : this.update);
    const values = new Float32Array(this.surface.length / 3);
    const pressed = this.cycle?.pressed?.[this.instant];
    pressed?.nodes.forEach((node, index) => (values[node] = pressed.pressures[index]!));
    return values;
  }

  private range(): Range {
    return this.ranges.get(this.field) ?? this.rangeOf(this.field);
  }

  private rangeOf(field: string): Range {
    if (field !== IN_CYCLE) return this.scene.fieldRange(field);
    return [0, this.cycle ? this.scene.highestPressure(this.cycle.facts) : 1];
  }

  private chooseUpdate(update: number): void {
    this.showUpdate(update);
    const cycles = this.scene.facts.updates[update] ?? undefined;
    this.onChoose({ cycles });
  }

  private chooseInstant(instant: number): void {
    this.showInstant(instant);
    this.onChoose({ percent: this.cycle?.percents[instant] });
  }

  private chooseField(field: string): void {
    this.colourBy(field);
    this.onChoose({ field });
  }

  private togglePlay(): void {
    if (this.playing) return this.stop();
    this.play.textContent = "Pause";
    const count = this.cycle?.percents.length ?? 1;
    const began = performance.now() - (1000 * SECONDS_A_CYCLE * this.instant) / count;
    const frame = (now: number) => {
      const part = ((now - began) / 1000 / SECONDS_A_CYCLE) % 1;
      const instant = Math.max(0, Math.floor(part * count));
      if (instant !== this.instant || !this.isInCycle) this.chooseInstant(instant);
      this.playing = requestAnimationFrame(frame);
    };
    this.playing = requestAnimationFrame(frame);
  }

  private stop(): void {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.instants.value = this.instant;
    this.play.textContent = "Play";
  }

  private say(words: string): void {
    this.status.textContent = words;
  }

  private shownFields(): [string, string][] {
    const options = this.scene.facts.fields.map(({ name, label, unit }): [string, string] => [name, withUnit({ title: label, unit })]);
    if (this.cycles.some(({ facts }) => facts.has_pressure)) options.push([IN_CYCLE, "Pressure through the cycle, MPa"]);
    return options;
  }

  private controls(): HTMLElement {
    const box = element("div", { class: "controls" });
    box.append(labelled("Colours show", this.fields), this.updates.box);
    if (this.cycles.length) box.append(this.instants.box, this.play);
    box.append(element("div", { class: "views" }, ...this.viewButtons()));
    const more = this.moreControls();
    if (more.childElementCount)
      box.append(element("details", { class: "more" }, element("summary", {}, `Cycle, sections and ${this.scene.facts.counterface}`), more));
    return box;
  }

  private moreControls(): HTMLElement {
    const box = element("div", { class: "controls" });
    if (this.cycles.length > 1) box.append(labelled("Cycle", this.cycleChoice()));
    if (this.stage.isFlat) return box;
    const larger = new Slider(
      "Wear made larger",
      [1, 20, 1],
      (times) => `${times} times`,
      (times) => this.exaggerate(times),
    );
    larger.value = 1;
    box.append(larger.box, this.sectionSlider("z"), this.sectionSlider("x"));
    const { has_femur, counterface } = this.scene.facts;
    if (has_femur) box.append(labelled(counterface.charAt(0).toUpperCase() + counterface.slice(1), this.femurChoice()));
    return box;
  }

  private viewButtons(): HTMLElement[] {
    const views = this.stage.isFlat ? [] : (Object.keys(VIEWS) as View[]).map((view) => button(view, () => this.stage.look(view)));
    const saves = [button("Save picture", () => savePicture(`${this.field}.png`, this.slide(SLIDE_PX)))];
    if (this.cycles.length && typeOfVideo()) saves.push(button("Save video", () => void this.saveVideo()));
    if (!this.stage.isFlat) saves.push(button("Save bodies", () => this.saveBodies()));
    return [...views, button("Pick the highest", () => this.pickHighest()), ...saves];
  }

  private cycleChoice(): HTMLSelectElement {
    const options = this.cycles.map(({ facts }): [string, string] => [facts.name, `${facts.name}, after ${cyclesInWords(facts.cycles)}`]);
    const select = choice(options, (name) => this.useCycle(name));
    select.value = this.cycle!.facts.name;
    return select;
  }

  private useCycle(name: string): void {
    this.cycle = this.cycles.find(({ facts }) => facts.name === name);
    this.isInCycle = false;
    this.showInstant(this.instant);
  }

  private femurChoice(): HTMLSelectElement {
    const options: [string, string][] = [
      ["0.3", "see-through"],
      ["1", "solid"],
      ["0", "hidden"],
    ];
    return choice(options, (opacity) => this.stage.showFemur(Number(opacity)));
  }

  private sectionSlider(axis: Axis): HTMLElement {
    const moved = (at: number) => this.stage.cut(axis, at >= SECTION_MM ? undefined : at);
    const words = (at: number) => (at >= SECTION_MM ? "none" : `${inDigits(at)} mm`);
    const slider = new Slider(`Section at ${axis}`, [-SECTION_MM, SECTION_MM, 1], words, moved);
    slider.value = SECTION_MM;
    return slider.box;
  }

  private exaggerate(times: number): void {
    this.exaggeration = times;
    this.place();
  }

  // A slide of what is shown, with at least `height` pixels for the bodies.
  private slide(height: number, made?: HTMLCanvasElement): HTMLCanvasElement {
    const { title } = this.scene.facts;
    const larger = this.exaggeration > 1 ? `; wear made ${this.exaggeration} times larger` : "";
    const legend = { title, field: this.fieldInWords(), state: this.status.textContent + larger, range: this.range(), map: this.map() };
    return slide(this.stage.shot(height), legend, made);
  }

  // A cycle of the gait as a video of slides.
  private async saveVideo(): Promise<void> {
    this.stop();
    const { instant, isInCycle } = this;
    const count = this.cycle?.percents.length ?? 1;
    const made = newSlide();
    const film = await video(made, SECONDS_A_CYCLE, (part) => {
      this.statusAt = 0;
      this.showInstant(Math.min(count - 1, Math.floor(part * count)));
      this.slide(VIDEO_PX, made);
    });
    save(`cycle.${film.type.split("/")[1]}`, film);
    if (isInCycle) this.showInstant(instant);
    else this.showUpdate(this.update);
  }

  // Exaggerated wear is in the name of the file.
  private saveBodies(): void {
    if (this.stage.isFlat) return;
    const times = this.exaggeration > 1 ? `_wear_x${this.exaggeration}` : "";
    save(`bodies${times}.glb`, glb(this.scene.facts.title, this.stage.bodies()));
  }

  private listen(host: HTMLElement): void {
    let began = [0, 0];
    host.addEventListener("pointerdown", (event) => (began = [event.clientX, event.clientY]));
    host.addEventListener("pointerup", (event) => {
      // A drag turns the bodies; a click picks a point.
      if (Math.hypot(event.clientX - began[0]!, event.clientY - began[1]!) >= 4) return;
      const node = this.stage.pick(event);
      if (node !== undefined) this.chooseNode(node);
    });
  }

  // Picks the node nearest to x, z, mm, seen from above, within a few millimetres.
  pickAt(x: number, z: number): void {
    const away = (node: number) => Math.hypot(this.surface[3 * node]! - x, this.surface[3 * node + 2]! - z);
    const node = this.best((one) => -away(one));
    if (away(node) <= REACH_MM) this.chooseNode(node);
  }

  // Picks the node with the highest value of the field that is shown.
  pickHighest(): void {
    const values = this.shownValues();
    this.chooseNode(this.best((node) => values[node]!));
  }

  private best(score: (node: number) => number): number {
    let best = 0;
    for (let node = 1; 3 * node < this.surface.length; node++) if (score(node) > score(best)) best = node;
    return best;
  }

  // The position of a node, mm.
  placeOf(node: number): [number, number, number] {
    return [...this.surface.subarray(3 * node, 3 * node + 3)] as [number, number, number];
  }

  private chooseNode(node: number): void {
    this.node = node;
    this.stage.mark(node);
    const [x, y, z] = this.placeOf(node);
    const place = `x ${inDigits(x)}, y ${inDigits(y)}, z ${inDigits(z)} mm`;
    const rows = this.scene.facts.fields.map(({ name, label, unit }) => {
      const value = this.scene.field(name, this.update)[node]!;
      return element("div", {}, element("dt", {}, label), element("dd", {}, `${inDigits(value)} ${unit}`));
    });
    this.picked.replaceChildren(element("p", {}, `At ${place}:`), element("dl", { class: "facts" }, ...rows));
    this.onPick(node);
  }
}

function cyclesOf(scene: Scene): Cycle[] {
  return scene.facts.cycles.map((facts) => ({
    facts,
    poses: scene.exact(`cycle.${facts.name}.poses`),
    percents: scene.exact(`cycle.${facts.name}.percents`),
    update: updateAfter(scene, facts.cycles),
  }));
}

// The available update nearest to a number of cycles.
export function updateAfter(scene: Scene, cycles: number): number {
  return nearest(scene.facts.updates, cycles);
}

// The index of the value nearest to a number; unknown values are far.
function nearest(values: ArrayLike<number | null>, wanted: number): number {
  const away = Array.from(values, (value) => Math.abs((value ?? Infinity) - wanted));
  return Math.max(0, away.indexOf(Math.min(...away)));
}
