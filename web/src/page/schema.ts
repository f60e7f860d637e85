// The JSON schema of cases, as far as completion needs it.

interface Schema {
  properties?: Record<string, Schema>;
  items?: Schema;
  enum?: unknown[];
  description?: string;
  type?: string;
}

export interface Offer {
  // What is written.
  word: string;
  about: string;
}

export class CaseSchema {
  private readonly root: Schema;

  constructor(json: string) {
    this.root = JSON.parse(json) as Schema;
  }

  // Keys of a table, by its dotted name.
  keys(table: string): Offer[] {
    const found = Object.entries(this.table(table)?.properties ?? {});
    return found.filter(([, { type }]) => type !== "object").map(([word, { description }]) => ({ word, about: description ?? "" }));
  }

  // Words that a key takes.
  values(table: string, key: string): Offer[] {
    const words = this.table(table)?.properties?.[key]?.enum ?? [];
    return words.map((word) => ({ word: JSON.stringify(word), about: "" }));
  }

  // Dotted names of all tables.
  tables(): Offer[] {
    const found: Offer[] = [];
    const visit = (schema: Schema, path: string) => {
      for (const [name, inner] of Object.entries(schema.properties ?? {})) {
        if (!inner.properties) continue;
        found.push({ word: path + name, about: inner.description ?? "" });
        visit(inner, `${path}${name}.`);
      }
    };
    visit(this.root, "");
    return found;
  }

  about(table: string, key: string): string | undefined {
    return this.table(table)?.properties?.[key]?.description;
  }

  private table(name: string): Schema | undefined {
    const step = (schema: Schema | undefined, part: string) => {
      const inner = schema?.properties?.[part];
      return inner?.items ?? inner;
    };
    return name ? name.split(".").reduce(step, this.root as Schema | undefined) : this.root;
  }
}
