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

// A slider below its name and its value in words.
export class Slider {
  readonly box: HTMLElement;
  readonly input: HTMLInputElement;
  private readonly shown = element("output");
  private static count = 0;

  constructor(
    name: string,
    [min, max, step]: [min: number, max: number, step: number],
    private readonly words: (value: number) => string,
    moved: (value: number) => void,
  ) {
    const id = `slider-${Slider.count++}`;
    const act = () => {
      this.say(words(this.input.valueAsNumber));
      moved(this.input.valueAsNumber);
    };
    this.input = element("input", { type: "range", id, min, max, step, input: act });
    this.box = element("div", { class: "slider" }, element("label", { for: id }, name), this.shown, this.input);
  }

  set value(value: number) {
    this.input.value = String(value);
    this.say(this.words(value));
  }

  // Shows words instead of those of the value.
  say(words: string): void {
    if (this.shown.textContent === words) return;
    this.shown.textContent = words;
    this.input.setAttribute("aria-valuetext", words);
  }
}

export function button(words: string, pressed: () => void): HTMLButtonElement {
  return element("button", { type: "button", click: pressed }, words);
}
