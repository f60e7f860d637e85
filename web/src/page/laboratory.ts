// The present case and its runs.

import { Scene } from "../scene";
import type { Files } from "./wasi";
import type { Summary } from "./numbers";
import type { Failure, Message } from "./program";
import type { Found } from "./shown_run";
import { Solver } from "./solver";
import type { Bodies } from "./dropped";

const [CASE, RESULTS, SCENE] = ["case.toml", "results", "scene"] as const;
const SUMMARY = `${RESULTS}/summary.json`;
export const REPORT = `${RESULTS}/report.html`;
// The interactive part of a report, which is large and needed only for a report that is saved.
const PROGRAM = "moving.js.zz";
// All keys of a case have defaults, but a text that was deleted is not meant to be one.
const EMPTY = 'error: the case is empty\n\nWrite at least one key, such as `title = "Defaults"`, or go back to the case before.';
// Pause after a change before a run starts, ms: a moving slider starts none.
const PATIENCE_MS = 120;

export interface Listener {
  message(message: Message): void;
  // Called with the numbers of a coarse run.
  previewed(summary: Summary): void;
  found(found: Found): void;
  failed(failure: Failure | null): void;
  // Called with whether a run is in progress.
  busy(isBusy: boolean): void;
}

export class Laboratory {
  text: string;
  // Meshes, waveforms and machines that a case can name.
  private named: Files = {};
  private readonly solver: Solver;
  private timer = 0;
  // The results folder of the last run, without its report until that is asked for.
  private folder: Files = {};

  constructor(
    module: WebAssembly.Module,
    text: string,
    private readonly listener: Listener,
  ) {
    this.text = text;
    this.solver = new Solver(module);
  }

  // Runs a changed text once it no longer changes.
  change(text: string): void {
    this.text = text;
    this.cancel();
    this.timer = window.setTimeout(() => void this.run(), PATIENCE_MS);
  }

  cancel(): void {
    clearTimeout(this.timer);
    this.solver.cancel();
    this.listener.busy(false);
  }

  // Solves the case coarsely, for numbers at once, and then as it is. Failures are those of the whole run.
  async run(): Promise<void> {
    if (this.text.trim() === "") return this.listener.failed({ message: EMPTY, problems: [] });
    this.listener.busy(true);
    // A worker gets copies of them.
    const files = { ...this.named, [CASE]: new TextEncoder().encode(this.text) };
    const preview = await this.solver.call({ words: ["preview", CASE, RESULTS], files, outputs: [RESULTS] });
    if (!preview) return;
    if (!preview.failure) {
      this.folder = {};
      this.listener.previewed(summaryOf(preview.files));
    }
    const found = await this.call(["run", CASE, RESULTS, SCENE], files, [RESULTS, SCENE]);
    if (!found) return;
    const { [SCENE]: scene, ...folder } = found;
    this.folder = folder;
    this.listener.found({ scene: new Scene(scene!.buffer as ArrayBuffer), summary: summaryOf(folder), text: decode(folder[`${RESULTS}/${CASE}`]!) });
  }

  // The files of a call; undefined if it failed or was cancelled.
  private async call(words: string[], files: Files, outputs: string[]): Promise<Files | undefined> {
    this.listener.busy(true);
    const answer = await this.solver.call({ words, files, outputs }, this.listener.message);
    if (!answer) return undefined;
    this.listener.busy(false);
    this.listener.failed(answer.failure);
    return answer.failure ? undefined : answer.files;
  }

  add(files: Files): void {
    this.named = { ...this.named, ...files };
  }

  // A case of two meshes, with unit and axes as condyle detects them.
  async draft({ femur, insert, files }: Bodies): Promise<string | undefined> {
    this.cancel();
    const drafted = (await this.call(["draft", CASE, femur, insert], files, [CASE]))?.[CASE];
    if (!drafted) return undefined;
    this.add(files);
    return decode(drafted);
  }

  // The results folder of the run that is shown, as the command writes it; undefined if that was stopped.
  async kept(): Promise<Files | undefined> {
    if (!this.folder[SUMMARY]) return undefined;
    if (!this.folder[REPORT]) {
      const program = await loaded(PROGRAM);
      const files = program ? { ...this.folder, [PROGRAM]: program } : this.folder;
      this.folder = (await this.call(["report", RESULTS], files, [RESULTS])) ?? this.folder;
      if (!program) this.listener.failed({ message: `error: ${PROGRAM} cannot be loaded: the saved report has no 3-D view`, problems: [] });
    }
    return this.folder[REPORT] && this.folder;
  }
}

async function loaded(name: string): Promise<Uint8Array | undefined> {
  const response = await fetch(name).catch(() => undefined);
  return response?.ok ? new Uint8Array(await response.arrayBuffer()) : undefined;
}

function summaryOf(files: Files): Summary {
  return JSON.parse(decode(files[SUMMARY]!)) as Summary;
}

function decode(bytes: Uint8Array): string {
  return new TextDecoder().decode(bytes);
}
