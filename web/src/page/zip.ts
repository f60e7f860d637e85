// A zip file of files in memory, deflated by the browser.

import { piped } from "../save";
import type { Files } from "./wasi";

const DEFLATED = 8;
const VERSION = 20;
const NAMES_IN_UTF8 = 0x800;
// 1 January 1980: the same results give the same bytes.
const DATE = 0x21;
// Bytes of a gzip file without a name before its data, and after them (RFC 1952).
const GZIP_HEAD = 10;
const GZIP_END = 8;

// A number of 4 bytes as two of 2 bytes.
function long(value: number): [low: number, high: number] {
  return [value & 0xffff, value >>> 16];
}

// Numbers of 2 bytes, the lower byte first as on every machine that runs browsers.
function packed(...numbers: number[]): Uint8Array {
  return new Uint8Array(Uint16Array.from(numbers).buffer);
}

export async function zip(files: Files): Promise<Blob> {
  const parts: Uint8Array[] = [];
  const listed: Uint8Array[] = [];
  let offset = 0;
  for (const [path, bytes] of Object.entries(files)) {
    const name = new TextEncoder().encode(path);
    // Gzip has the deflated bytes and, at its end, the checksum that a zip file needs.
    const gzip = await piped(bytes, new CompressionStream("gzip"));
    const small = gzip.subarray(GZIP_HEAD, -GZIP_END);
    const crc = new DataView(gzip.buffer).getUint32(gzip.length - GZIP_END, true);
    const facts = [VERSION, NAMES_IN_UTF8, DEFLATED, 0, DATE, ...long(crc), ...long(small.length), ...long(bytes.length), name.length, 0];
    const head = packed(...long(0x04034b50), ...facts);
    parts.push(head, name, small);
    listed.push(packed(...long(0x02014b50), VERSION, ...facts, 0, 0, 0, 0, 0, ...long(offset)), name);
    offset += head.length + name.length + small.length;
  }
  const list = listed.reduce((sum, part) => sum + part.length, 0);
  const count = Object.keys(files).length;
  const end = packed(...long(0x06054b50), 0, 0, count, count, ...long(list), ...long(offset), 0);
  return new Blob([...parts, ...listed, end] as BlobPart[], { type: "application/zip" });
}
