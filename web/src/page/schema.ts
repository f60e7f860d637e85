// The JSON schema of cases, as far as completion needs it.

export interface Schema {
  properties?: Record<string, Schema>;
  items?: Schema;
  // The meanings of a key that depends on shape, law or model.
  anyOf?: Schema[];
  enum?: unknown[];
  description?: string;
  type?: string;
}

export interface Offer {
  // The text to insert.
  word: string;
  about: string;
}

export class CaseSchema {
  constructor(private readonly root: Schema) {}

  // Keys of a table, by its dotted name.
  keys(table: string): Offer[] {
    const found = Object.entries(this.table(table)?.properties ?? {});
    return found.filter(([, { type }]) => type !== "object").map(([word, key]) => ({ word, about: about(key) ?? "" }));
  }

  // Words that a key takes.
  values(table: string, key: string): Offer[] {
    const found = this.table(table)?.properties?.[key];
    const words = meanings(found).flatMap((meaning) => meaning.enum ?? []);
    return [...new Set(words)].map((word) => ({ word: JSON.stringify(word), about: "" }));
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
    return about(this.table(table)?.properties?.[key]);
  }

  private table(name: string): Schema | undefined {
    const step = (schema: Schema | undefined, part: string) => {
      const inner = schema?.properties?.[part];
      return inner?.items ?? inner;
    };
    return name ? name.split(".").reduce(step, this.root as Schema | undefined) : this.root;
  }
}

function meanings(key: Schema | undefined): Schema[] {
  return key?.anyOf ?? (key ? [key] : []);
}

function about(key: Schema | undefined): string | undefined {
  return key?.description ?? meanings(key).find(({ description }) => description)?.description;
}
