// Elements made in one call.

type Attributes = Record<string, string | number | boolean | EventListener>;

export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (typeof value === "boolean") made.toggleAttribute(name, value);
    else made.setAttribute(name, String(value));
  }
  made.append(...children);
  return made;
}

// A control inside of its label, which screen readers announce.
export function labelled(words: string, control: HTMLElement): HTMLLabelElement {
  return element("label", {}, element("span", {}, words), control);
}

export function choice(options: [value: string, words: string][], changed: (value: string) => void): HTMLSelectElement {
  const select = element("select", { change: () => changed(select.value) });
  select.append(...options.map(([value, words]) => element("option", { value }, words)));
  return select;
}

export function slider(min: number, max: number, step: number, value: number, moved: (value: number) => void): HTMLInputElement {
  const input = element("input", { type: "range", min, max, step, value, input: () => moved(input.valueAsNumber) });
  return input;
}

export function button(words: string, pressed: () => void): HTMLButtonElement {
  return element("button", { type: "button", click: pressed }, words);
}
