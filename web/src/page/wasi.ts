// A run of a program for `wasm32-wasip1`, with its files in memory.

import { ConsoleStdout, Directory, Fd, File, type Inode, PreopenDirectory, WASI } from "@bjorn3/browser_wasi_shim";

// Files by their paths from the root, without a slash in front.
export type Files = Record<string, Uint8Array>;

export class Wasi {
  // The text on standard error.
  errors = "";
  private readonly root: PreopenDirectory;
  private readonly wasi: WASI;

  constructor(
    words: string[],
    files: Files,
    // Called with every line of standard output.
    heard: (line: string) => void,
  ) {
    this.root = new PreopenDirectory("/", new Map());
    for (const [path, bytes] of Object.entries(files)) this.put(path, new File(bytes));
    const decoder = new TextDecoder();
    const errors = new ConsoleStdout((bytes) => (this.errors += decoder.decode(bytes, { stream: true })));
    this.wasi = new WASI(words, [], [new NoInput(), ConsoleStdout.lineBuffered(heard), errors, this.root], { debug: false });
  }

  // Runs a program to its end and returns its exit code; throws if the program stops in the middle.
  run(module: WebAssembly.Module): number {
    const instance = new WebAssembly.Instance(module, {
      wasi_snapshot_preview1: { ...this.wasi.wasiImport, ...this.overrides() } as WebAssembly.ModuleImports,
    });
    return this.wasi.start(instance as Parameters<WASI["start"]>[0]);
  }

  // A file, or the files in a folder, by their paths.
  at(name: string): Files {
    const found: Files = {};
    const visit = (path: string, inode: Inode | undefined) => {
      if (inode instanceof File) found[path] = inode.data;
      if (inode instanceof Directory) for (const [name, inner] of inode.contents) visit(`${path}/${name}`, inner);
    };
    visit(name, this.root.dir.contents.get(name));
    return found;
  }

  private put(path: string, file: File): void {
    const [name, ...folders] = path.split("/").reverse() as [string, ...string[]];
    let folder = this.root.dir;
    for (const inner of folders.reverse()) {
      const found = folder.contents.get(inner);
      const next = found instanceof Directory ? found : new Directory(new Map());
      folder.contents.set(inner, next);
      folder = next;
    }
    folder.contents.set(name, file);
  }

  private overrides(): Record<string, (...words: number[]) => unknown> {
    const { wasiImport } = this.wasi;
    const call = (name: string, ...words: number[]) => wasiImport[name]?.(...words);
    return {
      // The same case gives the same bytes: nothing depends on chance.
      random_get: (place = 0, length = 0) => {
        new Uint8Array(this.wasi.inst.exports.memory.buffer, place, length).fill(7);
        return 0;
      },
      // POSIX replaces a file that is there; the shim does not.
      path_rename: (fd = 0, from = 0, fromLength = 0, toFd = 0, to = 0, toLength = 0) => {
        call("path_unlink_file", toFd, to, toLength);
        return call("path_rename", fd, from, fromLength, toFd, to, toLength);
      },
    };
  }
}

// Standard input of a program that reads none.
class NoInput extends Fd {}
