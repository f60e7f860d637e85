// A worker that calls the program, one call at a time; a cancelled call ends with its worker.

import type { Answer, Call, Message } from "./program";

export class Solver {
  private worker: Worker | undefined;
  private giveUp: (() => void) | undefined;

  constructor(private readonly module: WebAssembly.Module) {}

  // The answer of a call; undefined if it was cancelled or replaced by the next.
  call(order: Call, onMessage: (message: Message) => void = () => {}): Promise<Answer | undefined> {
    this.cancel();
    const worker = (this.worker ??= new Worker("worker.js"));
    return new Promise((done) => {
      const end = (answer?: Answer) => {
        this.giveUp = undefined;
        done(answer);
      };
      this.giveUp = () => end();
      worker.onmessage = ({ data }: MessageEvent<{ message?: Message; answer?: Answer }>) => {
        if (data.message) onMessage(data.message);
        if (data.answer) end(data.answer);
      };
      worker.onerror = ({ message }) => {
        this.drop();
        end({ files: {}, failure: { message: `error: the worker of the page ended: ${message}`, problems: [] } });
      };
      worker.postMessage({ module: this.module, order });
    });
  }

  cancel(): void {
    if (!this.giveUp) return;
    this.drop();
    this.giveUp();
  }

  private drop(): void {
    this.worker?.terminate();
    this.worker = undefined;
  }
}
