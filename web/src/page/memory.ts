// The case of the page in its address, which can be sent, and in the storage of the browser.

import { piped } from "../save";

const MARK = "#case=";
const STORED = "condyle.case";

// A text, compressed, in letters that an address may have.
export async function packed(text: string): Promise<string> {
  const bytes = await piped(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  return btoa(String.fromCharCode(...bytes))
    .replaceAll("+", "-")
    .replaceAll("/", "_")
    .replaceAll("=", "");
}

// The text of `packed`; undefined if the letters are not from there.
export async function unpacked(letters: string): Promise<string | undefined> {
  try {
    const bytes = Uint8Array.from(atob(letters.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
    return new TextDecoder("utf-8", { fatal: true }).decode(await piped(bytes, new DecompressionStream("deflate-raw")));
  } catch {
    return undefined;
  }
}

export class Memory {
  private shown: string | undefined;

  // `silent`: the case of an address without one.
  constructor(private readonly silent: string) {
    this.shown = silent;
  }

  // The case of the address, or else the one of the last visit, or that of an address without one; undefined if the address is damaged.
  async recalled(): Promise<string | undefined> {
    this.shown = await ofAddress(() => stored() ?? this.silent);
    return this.shown;
  }

  // Remembers a case that was solved. The address before it is one step back. An address has no meshes: a case that names some is kept
  // for this visit only, with an address without a case.
  async remember(text: string, isWhole: boolean): Promise<void> {
    if (isWhole) store(text);
    if (text === this.shown) return;
    this.shown = text;
    const bare = location.pathname + location.search;
    if (isWhole) history.pushState(null, "", text === this.silent ? bare : MARK + (await packed(text)));
    else history.pushState({ text }, "", bare);
  }

  // Calls with the case of an address that was gone back or forward to; undefined if that is damaged.
  onReturn(returned: (text: string | undefined) => void): void {
    const show = async (kept: { text: string } | null) => {
      const text = await ofAddress(() => kept?.text ?? this.silent);
      if (text === this.shown) return;
      this.shown = text;
      returned(text);
    };
    addEventListener("popstate", ({ state }) => void show(state as { text: string } | null));
  }
}

// The case of the address, or `otherwise` without one; undefined if it is damaged.
async function ofAddress(otherwise: () => string): Promise<string | undefined> {
  const { hash } = location;
  return hash.startsWith(MARK) ? unpacked(hash.slice(MARK.length)) : otherwise();
}

// Without permission to store, the page remembers nothing.
function stored(): string | undefined {
  try {
    return localStorage.getItem(STORED) ?? undefined;
  } catch {
    return undefined;
  }
}

function store(text: string): void {
  try {
    localStorage.setItem(STORED, text);
  } catch {}
}
