// The case of the page in its address, which can be sent, and in the storage of the browser.

const MARK = "#case=";
const STORED = "condyle.case";

async function piped(bytes: Uint8Array<ArrayBuffer>, through: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(through)).arrayBuffer());
}

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
  private shown: string;

  // `silent`: the case of an address without one.
  constructor(private readonly silent: string) {
    this.shown = silent;
  }

  // The case of the address, or else the one of the last visit; undefined without either, or with a damaged address.
  async recalled(): Promise<string | undefined> {
    const { hash } = location;
    const text = hash.startsWith(MARK) ? await unpacked(hash.slice(MARK.length)) : stored();
    if (text !== undefined) this.shown = text;
    return text;
  }

  // Remembers a case that was solved. The address before it is one step back.
  async remember(text: string): Promise<void> {
    store(text);
    if (text === this.shown) return;
    this.shown = text;
    const address = text === this.silent ? location.pathname + location.search : MARK + (await packed(text));
    history.pushState(null, "", address);
  }

  // Calls with the case of an address that was gone back or forward to.
  onReturn(returned: (text: string) => void): void {
    const show = async () => {
      const { hash } = location;
      const text = hash.startsWith(MARK) ? await unpacked(hash.slice(MARK.length)) : this.silent;
      if (text === undefined || text === this.shown) return;
      this.shown = text;
      returned(text);
    };
    addEventListener("popstate", () => void show());
  }
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
