// JSON values and the vectors that messages are made of.

export type JsonValue = null | boolean | number | string | JsonValue[] | JsonObject;
export interface JsonObject {
  [name: string]: JsonValue;
}

export type Vector3 = [number, number, number];
