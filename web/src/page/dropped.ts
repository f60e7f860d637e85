// Files that are dropped on the page or chosen: two meshes, or a case.

import { button, element } from "../dom";
import type { Files } from "./wasi";

export interface Bodies {
  femur: string;
  insert: string;
  files: Files;
}

const MESH = /\.(stl|obj|ply|vtp)$/i;
const CASE = /\.toml$/i;
const NAMED: [body: "femur" | "insert", words: RegExp][] = [
  ["femur", /fem/i],
  ["insert", /insert|inlay|tib|poly|pe\b/i],
];

export interface Listener {
  bodies(bodies: Bodies): void;
  caseText(text: string): void;
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
  const text = files.find(({ name }) => CASE.test(name));
  if (text && files.length === 1) return listener.caseText(await text.text());
  const [one, other] = files.filter(({ name }) => MESH.test(name));
  if (!one || !other || files.length !== 2) {
    return listener.refused("error: give two meshes (STL, OBJ, PLY or VTP), one of the femoral component and one of the insert, or one case (.toml)");
  }
  const femur = femurByName(one, other) ?? (await askFemur(one, other));
  if (!femur) return;
  const insert = femur === one ? other : one;
  if (femur.name === insert.name) return listener.refused("error: both files have the same name; rename one");
  const bytes = async (file: File) => new Uint8Array(await file.arrayBuffer());
  listener.bodies({ femur: femur.name, insert: insert.name, files: { [femur.name]: await bytes(femur), [insert.name]: await bytes(insert) } });
}

// The femur among two files, if exactly one assignment fits their names.
export function femurByName<Named extends { name: string }>(one: Named, other: Named): Named | undefined {
  const fits = (femur: Named, insert: Named) => NAMED.some(([body, words]) => words.test((body === "femur" ? femur : insert).name));
  const [first, second] = [fits(one, other), fits(other, one)];
  if (first === second) return undefined;
  return first ? one : other;
}

// Shows a dialog to choose which of two files is the femur; undefined if the dialog is closed.
function askFemur(one: File, other: File): Promise<File | undefined> {
  return new Promise((done) => {
    const dialog = element("dialog", { "aria-label": "Which file is the femoral component?" });
    const answer = (femur?: File) => {
      dialog.remove();
      done(femur);
    };
    dialog.append(
      element("p", {}, "Which file is the femoral component? The file names do not identify it."),
      ...[one, other].map((file) => button(file.name, () => answer(file))),
      button("Neither", () => answer()),
    );
    dialog.addEventListener("close", () => answer());
    document.body.append(dialog);
    dialog.showModal();
  });
}
