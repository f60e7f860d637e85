// The laboratory as a web page: a case, its run, and the controls of both.

import plotStyle from "uplot/dist/uPlot.min.css";
import { choice, element, labelled } from "../dom";
import { inDigits } from "../digits";
import { save, saveText } from "../save";
import viewStyle from "../style.css";
import schema from "../../../cases/condyle.schema.json";
import { valuesOf } from "./case_text";
import { Compared } from "./compared";
import { gripsOf } from "./dimensions";
import { take, takeDropped, type Bodies } from "./dropped";
import type { Files } from "./wasi";
import { Editor } from "./editor";
import { EXAMPLES } from "./examples";
import { Laboratory, REPORT } from "./laboratory";
import { Memory } from "./memory";
import { doubts, notes, tiles, type Summary } from "./numbers";
import style from "./page.css";
import type { Failure, Message } from "./program";
import { CaseSchema } from "./schema";
import { ShownRun, type Found } from "./shown_run";
import { Sliders } from "./sliders";
import { zip } from "./zip";

const NOTHING_TO_SAVE = "There is no finished run to save: change the case, and let its run end";

const DAMAGED = "error: the address is damaged: its case cannot be read\n\nCopy the whole link, ask for it again, or choose an example.";

function byId(id: string): HTMLElement {
  return document.getElementById(id)!;
}

// Files are in no address: a case that names them would not run elsewhere.
function namesFiles(text: string): boolean {
  return [...valuesOf(text).keys()].some((path) => /(^|\.)file$/.test(path));
}

// Waits until the page is painted; the time after it is that of another task.
function painted(): Promise<unknown> {
  return new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
}

class Page {
  private readonly laboratory: Laboratory;
  private readonly shown = new ShownRun(byId("present"), byId("worn"), byId("gait"));
  private readonly compared = new Compared(byId("comparison"), byId("kept"));
  private readonly sliders: Sliders;
  private readonly editor: Editor;
  private readonly examples = this.newExamples();
  private now: Found | undefined;
  private runs = 0;

  constructor(
    module: WebAssembly.Module,
    text: string,
    private readonly memory: Memory,
  ) {
    this.laboratory = new Laboratory(module, text, {
      message: (message) => this.report(message),
      previewed: (summary) => this.showNumbers(summary, true),
      found: (found) => void this.find(found),
      failed: (failure) => this.fail(failure),
      busy: (isBusy) => this.begun(isBusy),
    });
    this.sliders = new Sliders(
      () => this.laboratory.text,
      (text) => this.change(text),
    );
    this.editor = new Editor(new CaseSchema(schema), (text) => this.typed(text));
    this.editor.text = text;
    byId("text").append(this.editor.box);
    byId("sliders").append(this.sliders.box);
    byId("examples").append(labelled("Example", this.examples));
    this.sliders.show();
    this.nameExample(text);
    this.buttons();
    this.takeFiles();
    memory.onReturn((text) => (text === undefined ? this.refuse(DAMAGED) : this.open(text)));
  }

  // Runs its case; `isDamaged`: the address has a case that cannot be read.
  async begin(isDamaged: boolean): Promise<void> {
    if (isDamaged) this.refuse(DAMAGED);
    else await this.laboratory.run();
  }

  private buttons(): void {
    const pressed: Record<string, () => unknown> = {
      cancel: () => this.cancel(),
      keep: () => this.now && this.compared.keep(this.now, this.shown.viewer),
      "save-case": () => saveText("case.toml", this.laboratory.text, "text/plain"),
      "save-results": () => this.saveResults(),
      "save-report": () => this.saveReport(),
    };
    for (const [id, act] of Object.entries(pressed)) byId(id).addEventListener("click", () => void act());
  }

  private newExamples(): HTMLSelectElement {
    const options = EXAMPLES.map(([title]): [string, string] => [title, title]);
    return choice([["", "Choose a case"], ...options], (chosen) => {
      const example = EXAMPLES.find(([title]) => title === chosen);
      if (example) this.open(example[1]);
    });
  }

  // A text that is no longer that of an example has none, so that the example can be chosen again.
  private nameExample(text: string): void {
    this.examples.value = EXAMPLES.find(([, known]) => known === text)?.[0] ?? "";
  }

  private takeFiles(): void {
    const listener = {
      bodies: (bodies: Bodies) => void this.draft(bodies),
      named: (files: Files, text?: string) => this.add(files, text),
      refused: (why: string) => this.refuse(why),
    };
    takeDropped(listener);
    const input = byId("files") as HTMLInputElement;
    input.addEventListener("change", () => void take([...(input.files ?? [])], listener).then(() => (input.value = "")));
  }

  private add(files: Files, text?: string): void {
    this.laboratory.add(files);
    const example = (name: string) => element("li", {}, `${name} is read: name it in the case, as in file = "${name}"`);
    byId("remarks").replaceChildren(...(text === undefined ? Object.keys(files).map(example) : []));
    if (text !== undefined) this.open(text);
  }

  private async draft(bodies: Bodies): Promise<void> {
    byId("remarks").replaceChildren();
    const text = await this.laboratory.draft(bodies);
    if (text !== undefined) this.open(text);
  }

  private open(text: string): void {
    this.change(text);
    this.sliders.showDefaults();
  }

  private change(text: string): void {
    this.editor.text = text;
    this.nameExample(text);
    this.laboratory.change(text);
  }

  private typed(text: string): void {
    this.nameExample(text);
    this.laboratory.change(text);
    this.sliders.show();
  }

  private report({ reached, remark, warning }: Message): void {
    if (remark) byId("remarks").append(element("li", {}, remark));
    // The summary repeats the warning.
    else if (warning) this.say(warning);
    else if (reached)
      this.reach(reached.cycles / reached.of_cycles, `${inDigits(reached.cycles / 1e6)} of ${inDigits(reached.of_cycles / 1e6)} million cycles`);
    else this.reach(1, "All cycles are done; their accuracy is being estimated");
  }

  // A new run starts at nothing: words and bar of the run before are not its own.
  private begun(isBusy: boolean): void {
    document.documentElement.toggleAttribute("data-busy", isBusy);
    for (const id of ["save-results", "save-report"]) byId(id).toggleAttribute("disabled", isBusy);
    if (isBusy) this.reach(0, "The run is being prepared");
  }

  private reach(part: number, words: string): void {
    (byId("progress") as HTMLProgressElement).value = part;
    const isPreview = document.documentElement.hasAttribute("data-preview");
    this.say(isPreview ? `${words}; the numbers below are of a coarse run` : words);
  }

  private say(words: string): void {
    byId("state").textContent = words;
  }

  private showNumbers(summary: Summary, isPreview: boolean): void {
    document.documentElement.toggleAttribute("data-preview", isPreview);
    byId("tiles").replaceChildren(...tiles(summary));
    byId("doubts").replaceChildren(...doubts(summary));
    byId("notes").replaceChildren(...notes(summary));
    byId("doubtful").hidden = byId("doubts").childElementCount === 0;
  }

  // The page is painted between numbers, bodies and the rest, so that none of them holds it up for long.
  private async find(found: Found): Promise<void> {
    const { summary } = found;
    this.now = found;
    this.sliders.showDefaults({ joint: summary.joint, values: valuesOf(found.text) });
    this.showNumbers(summary, false);
    const solved = summary.wall_s + (summary.error?.wall_s ?? 0);
    this.say(`${inDigits(summary.cycles / 1e6)} million cycles, solved in ${inDigits(solved)} s on this machine`);
    await painted();
    this.shown.showBodies(found);
    const stage = this.shown.viewer?.stage;
    if (stage && !stage.isFlat) stage.grip(gripsOf(found, (places, value) => this.sliders.set(places, value)));
    await painted();
    this.shown.showCharts();
    await painted();
    this.compared.show(found, this.shown.viewer);
    // Browsers refuse addresses that are too long or change too often.
    const { text } = this.laboratory;
    await this.memory.remember(text, !namesFiles(text)).catch(() => undefined);
    document.documentElement.dataset["ready"] = "yes";
    document.documentElement.dataset["runs"] = String(++this.runs);
  }

  private refuse(message: string): void {
    this.fail({ message, problems: [] });
  }

  private fail(failure: Failure | null): void {
    this.editor.tell(failure);
    byId("failure").hidden = !failure;
    byId("failure").textContent = failure?.message ?? "";
    if (failure) this.say(this.now ? "This case does not run; the previous run is shown." : "This case does not run.");
  }

  private cancel(): void {
    this.laboratory.cancel();
    const isPreview = document.documentElement.hasAttribute("data-preview");
    this.say(
      isPreview ? "The run is stopped; the numbers are of a coarse run, the picture of the run before." : "The run is stopped; the previous run is shown.",
    );
  }

  private async saveResults(): Promise<void> {
    const files = await this.laboratory.kept();
    if (!files) return this.say(NOTHING_TO_SAVE);
    save("results.zip", await zip(files));
    this.say("results.zip is saved; it contains a results folder");
  }

  private async saveReport(): Promise<void> {
    const files = await this.laboratory.kept();
    const report = files?.[REPORT];
    if (!report) return this.say(NOTHING_TO_SAVE);
    save("report.html", new Blob([report as BlobPart], { type: "text/html" }));
    this.say("report.html is saved");
  }
}

async function compiled(): Promise<WebAssembly.Module> {
  const response = await fetch("condyle-web.wasm");
  if (!response.ok) throw new Error(`condyle-web.wasm: the server answers ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

async function start(): Promise<void> {
  document.head.append(element("style", {}, plotStyle + viewStyle + style));
  // In a frame, the page around it has the heading.
  document.documentElement.toggleAttribute("data-framed", window.top !== window);
  const generic = EXAMPLES[0]![1];
  const memory = new Memory(generic);
  const [module, recalled] = await Promise.all([compiled(), memory.recalled()]);
  const page = new Page(module, recalled ?? "", memory);
  await page.begin(recalled === undefined);
  // Refused in a frame of another site, where the page works with the network only.
  if ("serviceWorker" in navigator) await navigator.serviceWorker.register("service_worker.js").catch(() => undefined);
}

start().catch((error: unknown) => {
  byId("failure").hidden = false;
  byId("failure").textContent = `error: the page cannot start: ${String(error)}`;
});
