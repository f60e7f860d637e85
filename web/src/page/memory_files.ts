// Files and folders in memory, by their paths from the root, without a slash in front.

export type Files = Record<string, Uint8Array>;

interface Growing {
  bytes: Uint8Array;
  length: number;
}

export class MemoryFiles {
  private readonly files = new Map<string, Growing>();
  private readonly folders = new Set<string>([""]);

  constructor(files: Files = {}) {
    for (const [path, bytes] of Object.entries(files)) this.files.set(path, { bytes, length: bytes.length });
  }

  isFile(path: string): boolean {
    return this.files.has(path);
  }

  isFolder(path: string): boolean {
    return this.folders.has(path);
  }

  size(path: string): number {
    return this.files.get(path)?.length ?? 0;
  }

  empty(path: string): void {
    this.files.set(path, { bytes: new Uint8Array(), length: 0 });
  }

  makeFolder(path: string): void {
    this.folders.add(path);
  }

  remove(path: string): void {
    this.files.delete(path);
    this.folders.delete(path);
  }

  rename(from: string, to: string): void {
    const file = this.files.get(from)!;
    this.files.delete(from);
    this.files.set(to, file);
  }

  // Names in a folder, and whether each is a folder.
  list(folder: string): [name: string, isFolder: boolean][] {
    const within = folder ? `${folder}/` : "";
    const names = (paths: Iterable<string>, isFolder: boolean) =>
      [...paths]
        .filter((path) => path !== folder && path.startsWith(within) && !path.slice(within.length).includes("/"))
        .map((path): [string, boolean] => [path.slice(within.length), isFolder]);
    return [...names(this.files.keys(), false), ...names(this.folders, true)];
  }

  read(path: string, from: number, into: Uint8Array): number {
    const { bytes, length } = this.files.get(path)!;
    const part = bytes.subarray(from, Math.min(length, from + into.length));
    into.set(part);
    return part.length;
  }

  write(path: string, at: number, part: Uint8Array): void {
    const file = this.files.get(path)!;
    const end = at + part.length;
    if (end > file.bytes.length) {
      const larger = new Uint8Array(Math.max(end, 2 * file.bytes.length));
      larger.set(file.bytes.subarray(0, file.length));
      file.bytes = larger;
    }
    file.bytes.set(part, at);
    file.length = Math.max(file.length, end);
  }

  // The files in a folder by their paths, each in memory of its own.
  inFolder(folder: string): Files {
    const found = [...this.files].filter(([path]) => path.startsWith(`${folder}/`));
    return Object.fromEntries(found.map(([path, { bytes, length }]) => [path, bytes.slice(0, length)]));
  }

  whole(path: string): Uint8Array | undefined {
    const file = this.files.get(path);
    return file && file.bytes.slice(0, file.length);
  }
}
