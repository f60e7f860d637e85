// One call of the program: words and files as input, files and messages as output.

import { Wasi, type Files } from "./wasi";

export interface Wrong {
  message: string;
  advice: string | null;
  file: string | null;
  line: number | null;
  column: number | null;
}

export interface Failure {
  message: string;
  problems: Wrong[];
}

// A line of standard output: one of these.
export interface Message {
  warning?: string;
  remark?: string;
  reached?: { updates: number; cycles: number; of_cycles: number };
  failed?: Failure;
}

export interface Call {
  words: string[];
  files: Files;
  // The folders and files to return.
  outputs: string[];
}

export interface Answer {
  files: Files;
  failure: Failure | null;
}

export function call(module: WebAssembly.Module, { words, files, outputs }: Call, onMessage: (message: Message) => void): Answer {
  let failure: Failure | null = null;
  const wasi = new Wasi(["condyle-web", ...words], files, (line) => {
    const message = JSON.parse(line) as Message | "estimating";
    if (message === "estimating") return onMessage({});
    if (message.failed) failure = message.failed;
    onMessage(message);
  });
  try {
    const code = wasi.run(module);
    if (code !== 0 && !failure) failure = internal(wasi.errors || `the program ended with ${code}`);
  } catch (thrown) {
    failure = internal(`${wasi.errors}\n${String(thrown)}`);
  }
  return { files: Object.assign({}, ...outputs.map((name) => wasi.at(name))) as Files, failure };
}

function internal(words: string): Failure {
  return { message: `error in condyle itself: ${words.trim()}`, problems: [] };
}
