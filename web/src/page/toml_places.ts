// Where the values of a case stand in its text, in every form of TOML: below headings, with dotted keys, or in braces.

// A value, from its first character to the one after its last.
export interface Entry {
  // Tables and key, joined by points; the second and later tables of a list have numbers.
  path: string;
  // The table of the heading above it.
  section: string;
  from: number;
  to: number;
  isInBraces: boolean;
}

export interface Places {
  entries: Entry[];
  headings: { table: string; end: number }[];
}

const NAME = /[\w-]+|"[^"\n]*"|'[^'\n]*'/g;
const KEY = String.raw`(?:${NAME.source})(?:[ \t]*\.[ \t]*(?:${NAME.source}))*`;
const GAP = /(?:[\s,]|#.*)*/y;
const HEADING = new RegExp(String.raw`\[(\[?)[ \t]*(${KEY})[ \t]*\]\]?`, "y");
const ASSIGNED = new RegExp(String.raw`(${KEY})[ \t]*=[ \t]*`, "y");
const REST_OF_LINE = /.*/y;
// The line below a value that is not closed yet.
const HEADING_BELOW = /\n[ \t]*\[\[?[ \t]*[A-Za-z_]/y;
// A string, a comment, or any other character.
const TOKEN = /"""[\s\S]*?"""|'''[\s\S]*?'''|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|#.*|[\s\S]/y;

export function placesOf(text: string): Places {
  const places: Places = { entries: [], headings: [] };
  const counts = new Map<string, number>();
  let section = "";
  let at = 0;
  const next = (pattern: RegExp) => {
    pattern.lastIndex = at;
    const found = pattern.exec(text);
    if (found) at = pattern.lastIndex;
    return found;
  };
  const read = (end: number, table: string, isInBraces: boolean) => {
    for (next(GAP); at < end; next(GAP)) {
      const heading = !isInBraces && next(HEADING);
      if (heading) {
        section = table = numbered(namesIn(heading[2]!), heading[1] !== "", counts);
        places.headings.push({ table: section, end: at });
        continue;
      }
      const key = next(ASSIGNED)?.[1];
      // Not TOML: condyle reports it.
      if (key === undefined) next(REST_OF_LINE);
      else {
        const [path, from] = [joined(table, namesIn(key).join(".")), at];
        const to = endOfValue(text, from);
        places.entries.push({ path, section, from, to, isInBraces });
        if (text[from] === "{") {
          at = from + 1;
          read(to - 1, path, true);
        }
        at = to;
      }
    }
  };
  read(text.length, "", false);
  return places;
}

export function joined(table: string, key: string): string {
  return table ? `${table}.${key}` : key;
}

function namesIn(key: string): string[] {
  return key.match(NAME)!.map(unquoted);
}

export function unquoted(value: string): string {
  return value.replace(/^(["'])(.*)\1$/, "$2");
}

// The path of a heading; that of a list begins another table of it.
function numbered(names: string[], isList: boolean, counts: Map<string, number>): string {
  return names.reduce((table, name, depth) => {
    const path = joined(table, name);
    const count = (counts.get(path) ?? 0) + Number(isList && depth === names.length - 1);
    counts.set(path, count);
    return count > 1 ? `${path} ${count}` : path;
  }, "");
}

function endOfValue(text: string, from: number): number {
  let depth = 0;
  let end = from;
  TOKEN.lastIndex = from;
  for (let found = TOKEN.exec(text); found; found = TOKEN.exec(text)) {
    const [token] = found;
    if (depth === 0 && /^[#\n,\]}]/.test(token)) break;
    HEADING_BELOW.lastIndex = found.index;
    if (HEADING_BELOW.test(text)) break;
    if (token === "[" || token === "{") depth++;
    if (token === "]" || token === "}") depth--;
    if (token.trim()) end = TOKEN.lastIndex;
  }
  return end;
}
