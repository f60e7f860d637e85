// The system that a program for `wasm32-wasip1` expects: arguments, a clock, and files, which are in memory.
//
// Only what condyle asks for is here. Layouts and numbers are those of WASI preview 1.

import { MemoryFiles } from "./memory_files";

const DONE = 0;
const BAD_FILE = 8;
const THERE_ALREADY = 20;
const INVALID = 28;
const IS_FOLDER = 31;
const NOT_THERE = 44;
const NO_FOLDER = 54;
const NOT_EMPTY = 55;
const NOT_SUPPORTED = 58;

const CHARACTERS = 2;
const FOLDER = 3;
const FILE = 4;

const CREATE = 1;
const MUST_BE_FOLDER = 2;
const MUST_BE_NEW = 4;
const TRUNCATE = 8;

// What a program ends with.
class Exit {
  constructor(readonly code: number) {}
}

interface Opened {
  path: string;
  offset: number;
  isFolder: boolean;
}

const ROOT = 3;

export class Wasi {
  // What was said on standard error.
  said = "";
  private memory!: WebAssembly.Memory;
  private readonly opened = new Map<number, Opened>([[ROOT, { path: "", offset: 0, isFolder: true }]]);
  private nextDescriptor = ROOT + 1;
  private line = "";
  private readonly decoders = [new TextDecoder(), new TextDecoder()] as const;

  constructor(
    private readonly words: string[],
    private readonly files: MemoryFiles,
    // Hears every line of standard output.
    private readonly heard: (line: string) => void,
  ) {}

  // Runs a program to its end, and gives its exit code; one that stops in the middle throws.
  run(module: WebAssembly.Module): number {
    const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: this.calls() });
    this.memory = instance.exports["memory"] as WebAssembly.Memory;
    try {
      (instance.exports["_start"] as () => void)();
      return 0;
    } catch (thrown) {
      if (thrown instanceof Exit) return thrown.code;
      throw thrown;
    }
  }

  private calls(): WebAssembly.ModuleImports {
    return { ...this.processCalls(), ...this.fileCalls(), ...this.pathCalls() };
  }

  private processCalls(): WebAssembly.ModuleImports {
    return {
      args_sizes_get: (count: number, size: number) => this.sizes(this.words, count, size),
      args_get: (places: number, text: number) => this.texts(this.words, places, text),
      environ_sizes_get: (count: number, size: number) => this.sizes([], count, size),
      environ_get: () => DONE,
      clock_time_get: (_id: number, _precision: bigint, place: number) => {
        this.view().setBigUint64(place, BigInt(Math.round(1e6 * performance.now())), true);
        return DONE;
      },
      // The same case gives the same bytes: nothing here is left to chance.
      random_get: (place: number, length: number) => {
        this.bytes(place, length).fill(7);
        return DONE;
      },
      proc_exit: (code: number) => {
        throw new Exit(code);
      },
    };
  }

  private fileCalls(): WebAssembly.ModuleImports {
    return {
      fd_close: (fd: number) => (this.opened.delete(fd) ? DONE : BAD_FILE),
      fd_sync: () => DONE,
      fd_prestat_get: (fd: number, place: number) => {
        if (fd !== ROOT) return BAD_FILE;
        this.view().setUint32(place, 0, true);
        this.view().setUint32(place + 4, 1, true);
        return DONE;
      },
      fd_prestat_dir_name: (_fd: number, place: number) => {
        this.bytes(place, 1)[0] = "/".charCodeAt(0);
        return DONE;
      },
      fd_fdstat_get: (fd: number, place: number) => this.tellState(fd, place),
      fd_filestat_get: (fd: number, place: number) => {
        const opened = this.opened.get(fd);
        return opened ? this.tellFile(opened.path, place) : BAD_FILE;
      },
      fd_read: (fd: number, parts: number, count: number, done: number) => this.read(fd, this.parts(parts, count), done),
      fd_write: (fd: number, parts: number, count: number, done: number) => this.write(fd, this.parts(parts, count), done),
      fd_readdir: (fd: number, place: number, length: number, cookie: bigint, used: number) =>
        this.list(fd, this.bytes(place, length), Number(cookie), used),
    };
  }

  private pathCalls(): WebAssembly.ModuleImports {
    const { files } = this;
    const at = (fd: number, place: number, length: number) => this.path(fd, place, length);
    return {
      path_open: (fd: number, _flags: number, place: number, length: number, how: number, _rights: bigint, _inherited: bigint, _fdFlags: number, out: number) =>
        this.open(at(fd, place, length), how, out),
      path_filestat_get: (fd: number, _flags: number, place: number, length: number, out: number) => this.tellFile(at(fd, place, length), out),
      path_create_directory: (fd: number, place: number, length: number) => {
        const path = at(fd, place, length);
        if (files.isFile(path) || files.isFolder(path)) return THERE_ALREADY;
        files.makeFolder(path);
        return DONE;
      },
      path_remove_directory: (fd: number, place: number, length: number) => {
        const path = at(fd, place, length);
        if (!files.isFolder(path)) return NOT_THERE;
        if (files.list(path).length) return NOT_EMPTY;
        files.remove(path);
        return DONE;
      },
      path_unlink_file: (fd: number, place: number, length: number) => {
        const path = at(fd, place, length);
        if (!files.isFile(path)) return files.isFolder(path) ? IS_FOLDER : NOT_THERE;
        files.remove(path);
        return DONE;
      },
      path_rename: (fd: number, from: number, fromLength: number, toFd: number, to: number, toLength: number) => {
        const path = at(fd, from, fromLength);
        if (!files.isFile(path)) return NOT_THERE;
        files.rename(path, at(toFd, to, toLength));
        return DONE;
      },
      path_link: () => NOT_SUPPORTED,
      path_readlink: (fd: number, place: number, length: number) => {
        const path = at(fd, place, length);
        return files.isFile(path) || files.isFolder(path) ? INVALID : NOT_THERE;
      },
    };
  }

  private open(path: string, how: number, out: number): number {
    const { files } = this;
    const isFolder = files.isFolder(path);
    if (how & MUST_BE_FOLDER && !isFolder) return files.isFile(path) ? NO_FOLDER : NOT_THERE;
    if (!isFolder) {
      const isThere = files.isFile(path);
      if (isThere && how & MUST_BE_NEW) return THERE_ALREADY;
      if (!isThere && !(how & CREATE)) return NOT_THERE;
      if (!files.isFolder(folderOf(path))) return NOT_THERE;
      if (!isThere || how & TRUNCATE) files.empty(path);
    }
    this.opened.set(this.nextDescriptor, { path, offset: 0, isFolder });
    this.view().setUint32(out, this.nextDescriptor++, true);
    return DONE;
  }

  private read(fd: number, parts: Uint8Array[], done: number): number {
    const opened = this.opened.get(fd);
    if (!opened) return BAD_FILE;
    if (opened.isFolder) return IS_FOLDER;
    let count = 0;
    for (const part of parts) {
      const read = this.files.read(opened.path, opened.offset, part);
      opened.offset += read;
      count += read;
    }
    this.view().setUint32(done, count, true);
    return DONE;
  }

  private write(fd: number, parts: Uint8Array[], done: number): number {
    const opened = this.opened.get(fd);
    if (fd === 0 || (fd > 2 && (!opened || opened.isFolder))) return BAD_FILE;
    for (const part of parts) {
      if (!opened) this.say(fd, part);
      else {
        this.files.write(opened.path, opened.offset, part);
        opened.offset += part.length;
      }
    }
    this.view().setUint32(done, parts.reduce((sum, part) => sum + part.length, 0), true);
    return DONE;
  }

  private say(fd: number, part: Uint8Array): void {
    const text = this.decoders[fd === 1 ? 0 : 1].decode(part, { stream: true });
    if (fd !== 1) {
      this.said += text;
      return;
    }
    const lines = (this.line + text).split("\n");
    this.line = lines.pop()!;
    lines.forEach((line) => this.heard(line));
  }

  private list(fd: number, into: Uint8Array, cookie: number, used: number): number {
    const opened = this.opened.get(fd);
    if (!opened?.isFolder) return opened ? NO_FOLDER : BAD_FILE;
    const entries = this.files.list(opened.path);
    let at = 0;
    for (let index = cookie; index < entries.length && at < into.length; index++) {
      const [name, isFolder] = entries[index]!;
      const entry = folderEntry(index + 1, name, isFolder);
      // What does not fit is cut off: the program asks again.
      into.set(entry.subarray(0, into.length - at), at);
      at = Math.min(into.length, at + entry.length);
    }
    this.view().setUint32(used, at, true);
    return DONE;
  }

  private tellState(fd: number, place: number): number {
    const opened = this.opened.get(fd);
    if (!opened && fd > 2) return BAD_FILE;
    this.bytes(place, 24).fill(0);
    this.view().setUint8(place, opened ? (opened.isFolder ? FOLDER : FILE) : CHARACTERS);
    // All rights.
    this.view().setBigUint64(place + 8, 0x1fffffffn, true);
    this.view().setBigUint64(place + 16, 0x1fffffffn, true);
    return DONE;
  }

  private tellFile(path: string, place: number): number {
    const { files } = this;
    if (!files.isFile(path) && !files.isFolder(path)) return NOT_THERE;
    this.bytes(place, 64).fill(0);
    this.view().setUint8(place + 16, files.isFolder(path) ? FOLDER : FILE);
    this.view().setBigUint64(place + 24, 1n, true);
    this.view().setBigUint64(place + 32, BigInt(files.size(path)), true);
    return DONE;
  }

  private sizes(words: string[], count: number, size: number): number {
    const lengths = words.map((word) => new TextEncoder().encode(word).length + 1);
    this.view().setUint32(count, words.length, true);
    this.view().setUint32(size, lengths.reduce((sum, length) => sum + length, 0), true);
    return DONE;
  }

  private texts(words: string[], places: number, text: number): number {
    words.forEach((word, index) => {
      const bytes = new TextEncoder().encode(`${word}\0`);
      this.bytes(text, bytes.length).set(bytes);
      this.view().setUint32(places + 4 * index, text, true);
      text += bytes.length;
    });
    return DONE;
  }

  // The path from the root of one that counts from an open folder.
  private path(fd: number, place: number, length: number): string {
    const written = new TextDecoder().decode(this.bytes(place, length));
    const parts = this.opened.get(fd)!.path.split("/");
    for (const part of written.split("/")) {
      if (part === "..") parts.pop();
      else if (part !== ".") parts.push(part);
    }
    return parts.filter(Boolean).join("/");
  }

  private parts(place: number, count: number): Uint8Array[] {
    const view = this.view();
    return Array.from({ length: count }, (_, index) => {
      const at = place + 8 * index;
      return this.bytes(view.getUint32(at, true), view.getUint32(at + 4, true));
    });
  }

  private bytes(place: number, length: number): Uint8Array {
    return new Uint8Array(this.memory.buffer, place, length);
  }

  private view(): DataView {
    return new DataView(this.memory.buffer);
  }
}

function folderOf(path: string): string {
  return path.slice(0, Math.max(0, path.lastIndexOf("/")));
}

function folderEntry(next: number, name: string, isFolder: boolean): Uint8Array {
  const bytes = new TextEncoder().encode(name);
  const entry = new Uint8Array(24 + bytes.length);
  const view = new DataView(entry.buffer);
  view.setBigUint64(0, BigInt(next), true);
  view.setUint32(16, bytes.length, true);
  view.setUint8(20, isFolder ? FOLDER : FILE);
  entry.set(bytes, 24);
  return entry;
}
