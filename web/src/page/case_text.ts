// Finds and changes numbers in the text of a case; the rest of the text stays as it is.

export interface Place {
  // The table by its name, such as `machine.axial_force`.
  table: string;
  key: string;
}

// The heading of a table or of an item of a list of tables; rows of numbers over several lines are none.
const HEADING = /^\s*\[\[?\s*([A-Za-z_][\w.-]*)\s*\]\]?\s*(#.*)?$/;

export function headingOf(line: string): string | undefined {
  return HEADING.exec(line)?.[1];
}

// The table of a line; empty before the first heading.
export function tableAt(lines: string[], line: number): string {
  for (let i = line; i >= 0; i--) {
    const heading = headingOf(lines[i]!);
    if (heading !== undefined) return heading;
  }
  return "";
}

// The text of a value, without quotes around it.
export function valueAt(text: string, place: Place): string | undefined {
  const lines = text.split("\n");
  const line = lineOf(lines, place);
  if (line === undefined) return undefined;
  const { value } = parts(lines[line]!);
  return value.replace(/^"(.*)"$/, "$1");
}

export function numberOf(text: string, place: Place): number | undefined {
  const value = Number(valueAt(text, place)?.replaceAll("_", ""));
  return Number.isFinite(value) ? value : undefined;
}

// The text with a value replaced, or added to its table.
export function withValue(text: string, place: Place, value: string): string {
  const lines = text.split("\n");
  const line = lineOf(lines, place);
  if (line !== undefined) {
    const { before, value: old, after } = parts(lines[line]!);
    // A comment after it stays in its column.
    const gap = Math.max(1, /^\s*/.exec(after)![0].length + old.length - value.length);
    lines[line] = before + value + (after.trim() ? " ".repeat(gap) + after.trim() : "");
    return lines.join("\n");
  }
  const added = `${place.key} = ${value}`;
  const heading = lines.findIndex((found) => headingOf(found) === place.table);
  if (heading < 0) return `${text.trimEnd()}\n\n[${place.table}]\n${added}\n`;
  lines.splice(endOfTable(lines, heading), 0, added);
  return lines.join("\n");
}

// The values that differ between two cases, by table and key; a list of tables has numbers.
export function changed(before: string, after: string): [key: string, before?: string, after?: string][] {
  const [first, second] = [valuesOf(before), valuesOf(after)];
  const keys = [...new Set([...first.keys(), ...second.keys()])];
  return keys.filter((key) => first.get(key) !== second.get(key)).map((key) => [key, first.get(key), second.get(key)]);
}

function valuesOf(text: string): Map<string, string> {
  const [values, seen] = [new Map<string, string>(), new Map<string, number>()];
  let table = "";
  for (const line of text.split("\n")) {
    const heading = headingOf(line);
    if (heading !== undefined) {
      const count = (seen.get(heading) ?? 0) + 1;
      seen.set(heading, count);
      table = `${heading}${count > 1 ? ` ${count}` : ""}.`;
    }
    const key = keyOf(line);
    if (key !== undefined) values.set(table + key, VALUE.exec(line)?.[2] ?? "");
  }
  return values;
}

function lineOf(lines: string[], { table, key }: Place): number | undefined {
  const found = lines.findIndex((line, index) => keyOf(line) === key && tableAt(lines, index) === table);
  return found < 0 ? undefined : found;
}

export function keyOf(line: string): string | undefined {
  return /^\s*([A-Za-z0-9_-]+)\s*=/.exec(line)?.[1];
}

// A number or a word has no `#` in it.
const VALUE = /^(\s*[A-Za-z0-9_-]+\s*=\s*)("[^"]*"|[^#]*?)(\s*(?:#.*)?)$/;

function parts(line: string): { before: string; value: string; after: string } {
  const [, before, value, after] = VALUE.exec(line)!;
  return { before: before!, value: value!, after: after! };
}

// After the last line of a table that is neither empty nor a comment.
function endOfTable(lines: string[], heading: number): number {
  let last = heading;
  for (let i = heading + 1; i < lines.length && headingOf(lines[i]!) === undefined; i++) {
    if (/^\s*[^\s#]/.test(lines[i]!)) last = i;
  }
  return last + 1;
}
