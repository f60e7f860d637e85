// The present case and its runs.

import { Scene } from "../scene";
import type { Files } from "./wasi";
import type { Summary } from "./numbers";
import type { Failure, Message } from "./program";
import type { Found } from "./shown_run";
import { Solver } from "./solver";
import type { Bodies } from "./dropped";

const CASE = "case.toml";
// All keys of a case have defaults, but a text that was deleted is not meant to be one.
const EMPTY = 'error: the case is empty\n\nWrite at least one key, such as `title = "Defaults"`, or go back to the case before.';
// Pause after a change before a run starts, ms: a moving slider starts none.
const PATIENCE_MS = 120;

export interface Listener {
  message(message: Message): void;
  found(found: Found): void;
  failed(failure: Failure | null): void;
  // Called with whether a run is in progress.
  busy(isBusy: boolean): void;
}

export class Laboratory {
  text: string;
  private bodies: Files = {};
  private readonly runs: Solver;
  private readonly checks: Solver;
  private timer = 0;
  private folder: { text: string; files: Files } | undefined;

  constructor(
    module: WebAssembly.Module,
    text: string,
    private readonly listener: Listener,
  ) {
    this.text = text;
    this.runs = new Solver(module);
    this.checks = new Solver(module);
  }

  // Checks a changed text and runs it once it no longer changes.
  change(text: string): void {
    this.text = text;
    this.cancel();
    this.timer = window.setTimeout(() => void this.checkAndRun(), PATIENCE_MS);
  }

  cancel(): void {
    clearTimeout(this.timer);
    this.runs.cancel();
    this.listener.busy(false);
  }

  async run(): Promise<void> {
    this.listener.busy(true);
    const answer = await this.runs.call({ words: ["run", CASE, "out"], files: this.files(), output: "out" }, this.listener.message);
    if (!answer) return;
    this.listener.busy(false);
    this.listener.failed(answer.failure);
    const [scene, summary] = [answer.files["out/scene"], answer.files["out/summary.json"]];
    if (answer.failure || !scene || !summary) return;
    this.listener.found({ scene: new Scene(scene.buffer as ArrayBuffer), summary: JSON.parse(decode(summary)) as Summary });
  }

  // A case of two meshes, with unit and axes as condyle detects them.
  async draft({ femur, insert, files }: Bodies): Promise<string | undefined> {
    this.cancel();
    this.listener.busy(true);
    const answer = await this.runs.call({ words: ["draft", CASE, femur, insert], files, output: CASE }, this.listener.message);
    if (!answer) return undefined;
    this.listener.busy(false);
    this.listener.failed(answer.failure);
    const drafted = answer.files[CASE];
    if (answer.failure || !drafted) return undefined;
    this.bodies = files;
    this.folder = undefined;
    return decode(drafted);
  }

  // The results folder of the case, as the command writes it; solved once for each text.
  async kept(folder: string): Promise<Files | undefined> {
    if (this.folder?.text === this.text) return this.folder.files;
    this.cancel();
    const { text } = this;
    this.listener.busy(true);
    const answer = await this.runs.call({ words: ["keep", CASE, folder], files: this.files(), output: folder }, this.listener.message);
    if (!answer) return undefined;
    this.listener.busy(false);
    this.listener.failed(answer.failure);
    if (answer.failure) return undefined;
    this.folder = { text, files: answer.files };
    return answer.files;
  }

  // The meshes that the case names.
  get meshes(): Files {
    return this.bodies;
  }

  private async checkAndRun(): Promise<void> {
    if (this.text.trim() === "") return this.listener.failed({ message: EMPTY, problems: [] });
    const answer = await this.checks.call({ words: ["check", CASE], files: this.files(), output: CASE });
    if (!answer) return;
    this.listener.failed(answer.failure);
    if (!answer.failure) await this.run();
  }

  // The files of the case; a worker gets copies of them.
  private files(): Files {
    const text = new TextEncoder().encode(this.text);
    return { ...this.bodies, [CASE]: text };
  }
}

function decode(bytes: Uint8Array): string {
  return new TextDecoder().decode(bytes);
}
