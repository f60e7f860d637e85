// One call of the program: words and files in, files and what was told out.

import { MemoryFiles, type Files } from "./memory_files";
import { Wasi } from "./wasi";

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
export interface Told {
  warning?: string;
  remark?: string;
  reached?: { updates: number; cycles: number; of_cycles: number };
  failed?: Failure;
}

export interface Call {
  words: string[];
  files: Files;
  // The folder, or the file, that is wanted back.
  wanted: string;
}

export interface Answer {
  files: Files;
  failure: Failure | null;
}

export function call(module: WebAssembly.Module, { words, files, wanted }: Call, told: (told: Told) => void): Answer {
  const memory = new MemoryFiles(files);
  let failure: Failure | null = null;
  const wasi = new Wasi(["condyle-web", ...words], memory, (line) => {
    const heard = JSON.parse(line) as Told | "estimating";
    if (heard === "estimating") return told({});
    if (heard.failed) failure = heard.failed;
    told(heard);
  });
  try {
    const code = wasi.run(module);
    if (code !== 0 && !failure) failure = wordless(wasi.said || `the program ended with ${code}`);
  } catch (thrown) {
    failure = wordless(`${wasi.said}\n${String(thrown)}`);
  }
  const one = memory.whole(wanted);
  return { files: one ? { [wanted]: one } : memory.inFolder(wanted), failure };
}

function wordless(words: string): Failure {
  return { message: `error in condyle itself: ${words.trim()}`, problems: [] };
}
