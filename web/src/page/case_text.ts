// Finds and changes numbers in the text of a case; the rest of the text stays as it is.

import { joined, placesOf, type Entry } from "./toml_places";

export interface Place {
  // The table by its name, such as `machine.axial_force`.
  table: string;
  key: string;
}

// The table that a text ends in, without the numbers of lists; empty before the first heading.
export function tableAtEnd(text: string): string {
  return placesOf(text).headings.at(-1)?.table.replaceAll(/ \d+/g, "") ?? "";
}

export function numberIn(words: string | undefined): number | undefined {
  const value = Number(words?.replaceAll("_", ""));
  return Number.isFinite(value) ? value : undefined;
}

// The text with a value replaced, or added to its table in the form that this has.
export function withValue(text: string, { table, key }: Place, value: string): string {
  const places = placesOf(text);
  const path = joined(table, key);
  const found = places.entries.find((entry) => entry.path === path);
  if (found) return replaced(text, found, value);
  const braces = places.entries.filter(({ path: outer, from }) => text[from] === "{" && path.startsWith(`${outer}.`)).at(-1);
  if (braces) {
    const inside = text.slice(braces.from + 1, braces.to - 1).trim();
    const added = `${path.slice(braces.path.length + 1)} = ${value}`;
    return replaced(text, braces, `{ ${inside ? `${inside}, ` : ""}${added} }`);
  }
  // The last value of the table, below its heading or with dotted keys below that of an outer one.
  const isOfTable = (entry: Entry) => !entry.isInBraces && entry.path.startsWith(`${table}.`) && path.startsWith(joined(entry.section, ""));
  const last = places.entries.filter(isOfTable).at(-1);
  const from = last?.to ?? places.headings.findLast((heading) => heading.table === table)?.end;
  if (from === undefined) return `${text.trimEnd()}\n\n[${table}]\n${key} = ${value}\n`;
  const end = text.indexOf("\n", from);
  const at = end < 0 ? text.length : end;
  return `${text.slice(0, at)}\n${last ? path.slice(joined(last.section, "").length) : key} = ${value}${text.slice(at)}`;
}

// The values that differ between two cases, by table and key; a list of tables has numbers.
export function changed(before: string, after: string): [key: string, before?: string, after?: string][] {
  const [first, second] = [valuesOf(before), valuesOf(after)];
  const keys = [...new Set([...first.keys(), ...second.keys()])];
  return keys.filter((key) => first.get(key) !== second.get(key)).map((key) => [key, first.get(key), second.get(key)]);
}

// The values of a case as they are written, by table and key.
export function valuesOf(text: string): Map<string, string> {
  const plain = placesOf(text).entries.filter(({ from }) => text[from] !== "{");
  return new Map(plain.map(({ path, from, to }) => [path, text.slice(from, to).replaceAll(/\s+/g, " ")]));
}

// A key that differs in words; long lists have none of their numbers.
export function inWords(before?: string, after?: string): string {
  const isLong = (value?: string) => value?.startsWith("[") && value.length > LONG;
  if (isLong(before) && isLong(after)) return "other points";
  const words = (value?: string) => (value === undefined ? "not given" : isLong(value) ? "points" : value);
  return `${words(before)} → ${words(after)}`;
}

// Letters of a list that is read at a glance.
const LONG = 40;

function replaced(text: string, { from, to }: Entry, value: string): string {
  // A comment after it stays in its column.
  const after = text.slice(to).replace(/^[ \t]+(?=#)/, (gap) => " ".repeat(Math.max(1, gap.length + to - from - value.length)));
  return text.slice(0, from) + value + after;
}
