// The case as text: line numbers, errors at their lines, completion of tables, keys and words.

import { element } from "../dom";
import { tableAtEnd } from "./case_text";
import type { Failure, Wrong } from "./program";
import type { CaseSchema, Offer } from "./schema";

const LINE_PX = 18;
const MAX_OFFERS = 12;

export class Editor {
  readonly box = element("div", { class: "editor" });
  private readonly input = element("textarea", {
    id: "case-text",
    spellcheck: "false",
    autocapitalize: "off",
    wrap: "off",
    "aria-label": "The case as text; Ctrl and space complete words",
    "aria-describedby": "case-help",
  });
  private readonly gutter = element("div", { class: "gutter", "aria-hidden": "true" });
  private readonly help = element("p", { id: "case-help", class: "note", "aria-live": "polite" });
  private readonly list = element("ul", { class: "offers", role: "listbox", hidden: true });
  private readonly problems = element("div", { class: "problems", role: "status" });
  private offers: Offer[] = [];
  private chosen = 0;
  private numbered = "";

  constructor(
    private readonly schema: CaseSchema,
    private readonly changed: (text: string) => void,
  ) {
    this.box.append(element("div", { class: "lines" }, this.gutter, this.input, this.list), this.help, this.problems);
    this.input.addEventListener("input", () => {
      this.number([]);
      this.offer(false);
      this.changed(this.text);
    });
    this.input.addEventListener("scroll", () => (this.gutter.scrollTop = this.input.scrollTop));
    this.input.addEventListener("keydown", (event) => this.press(event));
    this.input.addEventListener("click", () => this.tellAbout());
    this.input.addEventListener("keyup", () => this.tellAbout());
    this.input.addEventListener("blur", () => this.close());
  }

  get text(): string {
    return this.input.value;
  }

  // Shows a text from elsewhere.
  set text(text: string) {
    const { selectionStart, scrollTop } = this.input;
    this.input.value = text;
    this.input.setSelectionRange(selectionStart, selectionStart);
    this.input.scrollTop = scrollTop;
    this.number([]);
  }

  // Shows errors at their lines; null if there are none.
  tell(failure: Failure | null): void {
    const problems = failure?.problems ?? [];
    this.number(problems);
    const places = problems.filter(({ line }) => line !== null).map((problem) => this.jump(problem));
    this.problems.replaceChildren(...(failure ? [element("pre", {}, failure.message), ...places] : []));
  }

  private jump({ line, column, message }: Wrong): HTMLButtonElement {
    const go = () => {
      const lines = this.text.split("\n");
      const at = lines.slice(0, line! - 1).reduce((sum, before) => sum + before.length + 1, 0) + (column ?? 1) - 1;
      this.input.focus();
      this.input.setSelectionRange(at, at);
      this.input.scrollTop = (line! - 6) * LINE_PX;
    };
    return element("button", { type: "button", click: go }, `Line ${line}: ${message}`);
  }

  private number(problems: Wrong[]): void {
    const wrong = new Map(problems.map(({ line, message }) => [line, message]));
    const shown = JSON.stringify([this.text.split("\n").length, ...wrong]);
    // New lines make the browser lay out the whole page.
    if (shown === this.numbered) return;
    this.numbered = shown;
    const lines = this.text.split("\n").map((_, index) => {
      const message = wrong.get(index + 1);
      return message === undefined ? element("div", {}, String(index + 1)) : element("div", { class: "wrong", title: message }, `✕ ${index + 1}`);
    });
    this.gutter.replaceChildren(...lines);
    this.gutter.scrollTop = this.input.scrollTop;
  }

  // The lines above that of the caret, and what stands before it in its own.
  private caret(): { above: string[]; before: string } {
    const above = this.text.slice(0, this.input.selectionStart).split("\n");
    return { before: above.pop()!, above };
  }

  private tellAbout(): void {
    const { above } = this.caret();
    const key = /^\s*([\w-]+)\s*=/.exec(this.text.split("\n")[above.length]!)?.[1];
    this.help.textContent = (key && this.schema.about(tableAtEnd(above.join("\n")), key)) ?? "";
  }

  // Offers words for the caret; without a request, only once a word has begun.
  private offer(isAsked: boolean): void {
    const { above, before } = this.caret();
    const table = tableAtEnd(above.join("\n"));
    const [all, begun] = this.atCaret(table, before);
    const isOffered = begun !== undefined && (isAsked || begun.length > 0);
    const fitting = isOffered ? all.filter(({ word }) => word.startsWith(begun) && word !== begun) : [];
    this.offers = fitting.slice(0, MAX_OFFERS);
    this.chosen = 0;
    this.list.style.top = `${(above.length + 1) * LINE_PX - this.input.scrollTop + 6}px`;
    this.showOffers();
  }

  private atCaret(table: string, before: string): [Offer[], string | undefined] {
    const heading = /^\s*\[([\w.]*)$/.exec(before);
    if (heading) return [this.schema.tables(), heading[1]];
    const value = /^\s*([\w-]+)\s*=\s*("?[\w-]*)$/.exec(before);
    if (value) return [this.schema.values(table, value[1]!), value[2]];
    return [this.schema.keys(table), /^\s*([\w-]*)$/.exec(before)?.[1]];
  }

  private showOffers(): void {
    const items = this.offers.map(({ word, about }, index) =>
      element(
        "li",
        { role: "option", "aria-selected": String(index === this.chosen), pointerdown: (event) => this.take(index, event) },
        element("b", {}, word),
        ` ${about}`,
      ),
    );
    this.list.replaceChildren(...items);
    this.list.hidden = items.length === 0;
  }

  private close(): void {
    this.offers = [];
    this.showOffers();
  }

  private press(event: KeyboardEvent): void {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      this.offer(true);
      return;
    }
    if (!this.offers.length) return;
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: this.offers.length - 1 };
    if (event.key in steps) this.chosen = (this.chosen + steps[event.key]!) % this.offers.length;
    else if (event.key === "Enter" || event.key === "Tab") return this.take(this.chosen, event);
    else if (event.key === "Escape") this.offers = [];
    else return;
    event.preventDefault();
    this.showOffers();
  }

  private take(index: number, event: Event): void {
    event.preventDefault();
    const { before } = this.caret();
    const begun = /("?[\w.-]*)$/.exec(before)![1]!;
    const word = this.offers[index]!.word;
    this.close();
    const end = this.input.selectionStart;
    this.input.setRangeText(word, end - begun.length, end, "end");
    this.input.dispatchEvent(new Event("input"));
  }
}
