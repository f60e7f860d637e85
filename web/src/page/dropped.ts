// Files that are dropped on the page or chosen: two meshes, a case with the files that it names, or such files alone.

import { element } from "../dom";
import type { Files } from "./wasi";

export interface Bodies {
  femur: string;
  insert: string;
  files: Files;
}

const MESH = /\.(stl|obj|ply|vtp)$/i;
const TABLE = /\.csv$/i;
const CASE = /\.toml$/i;
// A machine file has joints.
const MACHINE = /^\s*\[\[joint\]\]/m;
const WANTED =
  "error: give two meshes (STL, OBJ, PLY or VTP), one of the femoral component and one of the insert, or one case (.toml) with the files that it names, or waveforms (.csv)";
const FEMUR = /fem/i;
const INSERT = /insert|inlay|tib|poly|pe\b/i;

export interface Listener {
  bodies(bodies: Bodies): void;
  // Files that a case can name, and the case among them.
  named(files: Files, caseText?: string): void;
  refused(why: string): void;
}

// Takes files that are dropped anywhere on the page.
export function takeDropped(listener: Listener): void {
  const over = (event: DragEvent) => {
    event.preventDefault();
    document.body.toggleAttribute("data-dropping", event.type === "dragover");
  };
  addEventListener("dragover", over);
  addEventListener("dragleave", over);
  addEventListener("drop", (event) => {
    over(event);
    void take([...(event.dataTransfer?.files ?? [])], listener);
  });
}

export async function take(files: File[], listener: Listener): Promise<void> {
  const [one, other] = files.filter(({ name }) => MESH.test(name));
  if (!one || !other || files.length !== 2) return takeNamed(files, listener);
  const femur = femurByName(one, other) ?? (await askFemur(one, other));
  if (!femur) return;
  const insert = femur === one ? other : one;
  if (femur.name === insert.name) return listener.refused("error: both files have the same name; rename one");
  listener.bodies({ femur: femur.name, insert: insert.name, files: await read(files) });
}

async function takeNamed(files: File[], listener: Listener): Promise<void> {
  const texts = await Promise.all(files.filter(({ name }) => CASE.test(name)).map(async (file) => ({ file, text: await file.text() })));
  const [found, ...more] = texts.filter(({ text }) => !MACHINE.test(text));
  // Without a case, meshes are those of a new one.
  const kinds = found ? [CASE, TABLE, MESH] : [CASE, TABLE];
  const areKnown = files.every(({ name }) => kinds.some((kind) => kind.test(name)));
  if (!areKnown || files.length === 0 || more.length > 0) return listener.refused(WANTED);
  listener.named(await read(files.filter((file) => file !== found?.file)), found?.text);
}

async function read(files: File[]): Promise<Files> {
  const entry = async (file: File) => [file.name, new Uint8Array(await file.arrayBuffer())] as const;
  return Object.fromEntries(await Promise.all(files.map(entry)));
}

// The femur among two files, if exactly one assignment fits their names.
export function femurByName<Named extends { name: string }>(one: Named, other: Named): Named | undefined {
  const fits = (femur: Named, insert: Named) => FEMUR.test(femur.name) || INSERT.test(insert.name);
  const [first, second] = [fits(one, other), fits(other, one)];
  if (first === second) return undefined;
  return first ? one : other;
}

// Shows a dialog to choose which of two files is the femur; undefined if the dialog is closed.
function askFemur(one: File, other: File): Promise<File | undefined> {
  return new Promise((done) => {
    // A button of the form closes the dialog.
    const names = [one, other].map(({ name }) => element("button", { value: name }, name));
    const words = element("p", {}, "Which file is the femoral component? The file names do not identify it.");
    const form = element("form", { method: "dialog" }, words, ...names, element("button", {}, "Neither"));
    const dialog = element("dialog", { "aria-label": "Which file is the femoral component?" }, form);
    dialog.addEventListener("close", () => {
      dialog.remove();
      done([one, other].find(({ name }) => name === dialog.returnValue));
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
