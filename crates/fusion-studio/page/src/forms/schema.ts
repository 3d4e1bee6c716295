// Reads the JSON schema of operations into fields of forms. No option is written by hand: what the schema says is shown.

import type { Json } from '../protocol';

export interface Schema {
  $ref?: string;
  $defs?: { [name: string]: Schema };
  anyOf?: Schema[];
  oneOf?: Schema[];
  type?: string | string[];
  const?: Json;
  enum?: Json[];
  title?: string;
  description?: string;
  default?: Json;
  pattern?: string;
  properties?: { [key: string]: Schema };
  required?: string[];
  items?: Schema;
  minItems?: number;
  maxItems?: number;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
}

export type Kind =
  | { is: 'toggle' }
  | { is: 'number'; least: number; most: number; whole: boolean }
  | { is: 'length' }
  | { is: 'choice'; choices: { value: Json; description: string }[] }
  | { is: 'vector'; size: number }
  | { is: 'list'; item: Field }
  | { is: 'group'; fields: Field[] }
  | { is: 'variant'; variants: { name: string; fields: Field[] }[]; file: boolean }
  | { is: 'text'; suggestions: string[] }
  | { is: 'json' };

export interface Field {
  key: string;
  description: string;
  title: string;
  default: Json;
  required: boolean;
  kind: Kind;
}

/** An operation by its verb. */
export interface Operation {
  verb: string;
  description: string;
  fields: Field[];
}

/** Keys of a step that are not options. */
const NO_OPTIONS = ['do', 'of', 'as', 'off'];
/** Keys of a part that are not its pose. */
const NO_POSE = ['name', 'mesh'];
/** The order in which a person looks for options; all others follow by name. */
const FIRST = [
  'shape', 'radius', 'height', 'size', 'base', 'axis', 'profile', 'near', 'translate', 'rotate', 'scale', 'on', 'plane', 'path', 'keep', 'loops', 'silhouette', 'edge_length',
  'intensity', 'source', 'target', 'clusters', 'bulge', 'extent', 'radius_at', 'overlap',
];

/** The documents' schema, read once. */
export class Vocabulary {
  readonly operations = new Map<string, Operation>();
  readonly pose: Field[];
  readonly primitive: Field[];

  constructor(private root: Schema) {
    for (const variant of this.define('Step').oneOf ?? []) {
      for (const verb of this.verbs(variant)) {
        const fields = this.fields(variant, NO_OPTIONS);
        this.operations.set(verb, { verb, description: this.about(verb, variant), fields });
      }
    }
    this.pose = this.fields(this.define('Part'), NO_POSE);
    this.primitive = this.fields(this.define('Primitive'), []);
  }

  private define(name: string): Schema {
    return this.root.$defs?.[name] ?? {};
  }

  private verbs(variant: Schema): string[] {
    const verb = variant.properties?.do;
    return (verb?.enum ?? [verb?.const ?? null]).filter((v): v is string => typeof v === 'string');
  }

  private about(verb: string, variant: Schema): string {
    if (variant.description) return variant.description;
    const own = this.root.properties?.[verb];
    const set = this.define('SetOperation').oneOf?.find((o) => o.const === verb);
    if (set?.description) return `Join solids into one that holds: ${set.description.toLowerCase()}; and fillet the seams with a rolling ball.`;
    return (own && this.resolve(own).description) ?? '';
  }

  private resolve(schema: Schema): Schema {
    if (!schema.$ref) return schema;
    const { $ref, ...rest } = schema;
    return { ...this.define($ref.split('/').pop() ?? ''), ...rest };
  }

  private fields(schema: Schema, without: string[]): Field[] {
    const keys = Object.keys(schema.properties ?? {}).filter((key) => !without.includes(key));
    const rank = (key: string) => (FIRST.includes(key) ? FIRST.indexOf(key) : FIRST.length);
    keys.sort((a, b) => rank(a) - rank(b) || a.localeCompare(b));
    return keys.map((key) => this.field(key, schema.properties![key], schema.required?.includes(key) ?? false));
  }

  /** One field; alternatives such as "or null" and "or a parameter" are taken apart. */
  private field(key: string, given: Schema, required: boolean): Field {
    let schema = this.resolve(given);
    let { description = '', default: value = null } = schema;
    while (schema.anyOf && schema.title !== 'length') {
      const rest = schema.anyOf.filter((s) => s.type !== 'null' && s.pattern !== '^\\$');
      if (rest.length !== 1) break;
      const inner = this.resolve(rest[0]);
      description ||= inner.description ?? '';
      value ??= inner.default ?? null;
      schema = inner;
    }
    return { key, description, title: schema.title ?? '', default: value, required, kind: this.kind(key, schema) };
  }

  private kind(key: string, schema: Schema): Kind {
    const { title = '' } = schema;
    if (title.startsWith('length')) return { is: 'length' };
    const types = [schema.type ?? []].flat().filter((t) => t !== 'null');
    // A point, or a table that begins with one: the point is what a click gives.
    const point = schema.anyOf?.map((s) => this.resolve(s)).find((s) => s.minItems === 3 && s.maxItems === 3);
    if (point) return { is: 'vector', size: 3 };
    const choices = this.choices(schema);
    if (choices) return { is: 'choice', choices };
    const [type] = types;
    if (type === 'boolean') return { is: 'toggle' };
    if (type === 'number' || type === 'integer') {
      const least = schema.minimum ?? schema.exclusiveMinimum ?? -Infinity;
      const most = schema.maximum ?? schema.exclusiveMaximum ?? Infinity;
      return { is: 'number', least, most, whole: type === 'integer' };
    }
    if (type === 'string' || title.includes('`')) return { is: 'text', suggestions: suggestions(title) };
    if (type === 'array' && schema.items) {
      const item = this.field(key, schema.items, true);
      if (schema.minItems !== undefined && schema.minItems === schema.maxItems && item.kind.is === 'number') {
        return { is: 'vector', size: schema.minItems };
      }
      return { is: 'list', item };
    }
    if (schema.properties) return { is: 'group', fields: this.fields(schema, []) };
    return this.variants(schema) ?? { is: 'json' };
  }

  /** Alternatives that are tables, perhaps with a file's name besides. */
  private variants(schema: Schema): Kind | undefined {
    const all = (schema.anyOf ?? []).map((s) => this.resolve(s));
    const tables = all.filter((s) => s.properties);
    const file = all.some((s) => s.type === 'string');
    if (tables.length === 0 || tables.length + Number(file) !== all.length) return undefined;
    const variants = tables.map((s) => ({ name: (s.required ?? Object.keys(s.properties!)).join(', '), fields: this.fields(s, []) }));
    return { is: 'variant', variants, file };
  }

  private choices(schema: Schema) {
    if (schema.enum) return schema.enum.map((value) => ({ value, description: '' }));
    const variants = schema.oneOf?.flatMap((o) => o.enum?.map((value) => ({ const: value, description: o.description })) ?? [o]);
    if (!variants?.every((o) => o.const !== undefined)) return undefined;
    return variants.map((o) => ({ value: o.const!, description: o.description ?? '' }));
  }
}

/** Words in backticks are values to choose from, unless they stand for something. */
function suggestions(title: string): string[] {
  return [...title.matchAll(/`([a-z0-9_]+)`/g)].map((m) => m[1]);
}
