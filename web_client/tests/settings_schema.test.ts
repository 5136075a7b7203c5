import assert from "node:assert/strict";
import test from "node:test";
import type { JsonObject } from "heliograph/json.ts";
import {
  type Control,
  type SliderControl,
  allControls,
  defaultTree,
  describeControls,
  formatNumber,
  humanise,
  niceStep,
  parseNumber,
  sliderPosition,
  sliderValue,
} from "heliograph/settings_schema.ts";

const leaf = (extra: JsonObject): JsonObject => ({ description: "Help.", ...extra });

const schema: JsonObject = {
  type: "object",
  properties: {
    late: {
      title: "Late group",
      "x-order": 2,
      properties: { flag: leaf({ type: "boolean", default: true, "x-order": 9 }) },
    },
    early: {
      title: "Early group",
      "x-order": 1,
      properties: {
        second: leaf({ type: "number", default: 1, minimum: 0, maximum: 4, "x-order": 2 }),
        first: leaf({ type: "string", enum: ["aces", "linear"], default: "aces", "x-order": 1 }),
        inner: {
          title: "Inner",
          "x-order": 3,
          properties: { name: leaf({ type: "string", default: "output" }) },
        },
      },
    },
  },
};

function only(properties: JsonObject): Control {
  const control = allControls(describeControls({ properties }))[0];
  assert.ok(control);
  return control;
}

function slider(properties: JsonObject): SliderControl {
  const control = only({ setting: properties });
  assert.equal(control.kind, "slider");
  return control as SliderControl;
}

test("groups and settings come in the order the schema gives", () => {
  const panel = describeControls(schema);
  assert.deepEqual(
    panel.groups.map(({ title }) => title),
    ["Early group", "Late group"],
  );
  assert.deepEqual(
    allControls(panel).map(({ path }) => path),
    ["early.first", "early.second", "early.inner.name", "late.flag"],
  );
});

test("each type becomes its widget", () => {
  const kind = (properties: JsonObject): string => only({ setting: properties }).kind;
  assert.equal(kind({ type: "boolean" }), "toggle");
  assert.equal(kind({ type: "number", minimum: 0, maximum: 1 }), "slider");
  assert.equal(kind({ type: "number", minimum: 0 }), "number");
  assert.equal(kind({ type: "integer", minimum: 0, maximum: 2147483647 }), "number");
  assert.equal(kind({ type: "string", enum: ["a", "b"] }), "choice");
  assert.equal(kind({ type: "string" }), "text");
  assert.equal(kind({ type: ["number", "null"], minimum: 0, maximum: 1 }), "slider");
  const vector = { type: "array", items: { type: "number" }, minItems: 3, maxItems: 3 };
  assert.equal(kind(vector), "vector");
});

test("a setting of unknown type gets a JSON control", () => {
  const control = only({ odd: { type: "object", default: { a: 1 }, description: "Odd." } });
  assert.equal(control.kind, "json");
  assert.equal(control.label, "Odd");
});

test("a schema without titles or orders keeps its own order and readable labels", () => {
  const panel = describeControls({ properties: { max_history: {}, second: {} } });
  assert.deepEqual(
    panel.controls.map(({ label }) => label),
    ["Max history", "Second"],
  );
});

test("references within the schema are followed", () => {
  const panel = describeControls({
    $defs: { share: { type: "number", minimum: 0, maximum: 1 } },
    properties: { a: { $ref: "#/$defs/share", default: 0.5 } },
  });
  assert.equal(panel.controls[0]?.kind, "slider");
  assert.equal(panel.controls[0]?.default, 0.5);
});

test("defaults form a tree", () => {
  assert.deepEqual(defaultTree(describeControls(schema)), {
    early: { first: "aces", second: 1, inner: { name: "output" } },
    late: { flag: true },
  });
});

test("linear sliders step in round numbers and reach both ends", () => {
  const control = slider({ type: "number", minimum: -180, maximum: 180, default: 0 });
  assert.equal(control.scale, "linear");
  assert.equal(control.step, 1);
  assert.equal(sliderPosition(control, 0), 0.5);
  assert.equal(sliderValue(control, 0), -180);
  assert.equal(sliderValue(control, 1), 180);
  assert.equal(sliderValue(control, 0.5021), 1);
});

test("wide positive ranges are logarithmic, whole numbers stay whole", () => {
  const control = slider({ type: "integer", minimum: 1, maximum: 65536, default: 64 });
  assert.equal(control.scale, "logarithmic");
  assert.ok(Math.abs(sliderPosition(control, 256) - 0.5) < 1e-9);
  assert.equal(sliderValue(control, 0.5), 256);
  assert.equal(sliderValue(control, 1), 65536);
  assert.equal(sliderValue(control, 0), 1);
});

test("ranges from zero whose default is small leave room for small values", () => {
  const control = slider({ type: "number", minimum: 0, maximum: 100, default: 1 });
  assert.equal(control.scale, "cubic");
  assert.ok(sliderPosition(control, 1) > 0.2);
  assert.equal(sliderValue(control, sliderPosition(control, 1)), 1);
  assert.equal(sliderValue(control, 0), 0);
});

test("typed numbers are clamped to the range and invalid ones rejected", () => {
  const range = { minimum: 0, maximum: 4, step: 0.1, integer: false };
  assert.equal(parseNumber("1,5", range), 1.5);
  assert.equal(parseNumber("9", range), 4);
  assert.equal(parseNumber("-1", range), 0);
  assert.equal(parseNumber("two", range), null);
  assert.equal(parseNumber("  ", range), null);
  assert.equal(parseNumber("1.6", { ...range, integer: true }), 2);
});

test("numbers are written with the digits that matter", () => {
  const range = { minimum: 0, maximum: 1, step: 0.005, integer: false };
  assert.equal(formatNumber(Math.fround(0.1), range), "0.1");
  assert.equal(formatNumber(0.125, range), "0.125");
  assert.equal(formatNumber(0, range), "0");
  assert.equal(formatNumber(0.00012, range), "0.00012");
});

test("steps are 1, 2 or 5 times a power of ten", () => {
  assert.equal(niceStep(0.16), 0.1);
  assert.equal(niceStep(0.02), 0.02);
  assert.equal(niceStep(7.3), 5);
});

test("names become readable labels", () => {
  assert.equal(humanise("environment_diffuse"), "Environment diffuse");
  assert.equal(humanise("agx"), "AgX");
});
