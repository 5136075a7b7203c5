// The TypeScript shapes of messages against what the server itself declares: a member that a client
// reads must be there, of that kind. Members that clients do not read yet are none of its business.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import test from "node:test";
import { serverBinary } from "./harness/environment.mjs";

const repository = new URL("../../", import.meta.url);
const typescript = createRequire(new URL("web_client/package.json", repository))("typescript");
const messages = new URL("protocol/typescript/messages.ts", repository);

/** Which result has which shape. Methods that a server lacks are passed over. */
const results = {
  hello: "Hello",
  "scene.list": "SceneList",
  "scene.info": "SceneInfo",
  "camera.get": "Camera",
  "animation.list": "AnimationState",
  "stream.configure": "StreamSettings",
  "frame.capture": "Capture",
  "frame.inspect": "Inspection",
  "scene.pick": "Pick",
  "session.info": "SessionInfo",
  "environment.list": "EnvironmentState",
};

function declaredMembers() {
  const source = typescript.createSourceFile(
    "messages.ts",
    readFileSync(messages, "utf8"),
    typescript.ScriptTarget.Latest,
  );
  const members = new Map();
  for (const statement of source.statements) {
    if (!typescript.isInterfaceDeclaration(statement)) continue;
    const properties = statement.members
      .filter(typescript.isPropertySignature)
      .map((member) => ({
        name: member.name.text,
        optional: member.questionToken !== undefined,
        type: member.type.getText(source),
      }));
    members.set(statement.name.text, properties);
  }
  return members;
}

function declaredByServer() {
  const run = spawnSync(serverBinary, ["schema"], { encoding: "utf8", maxBuffer: 1 << 26 });
  assert.equal(run.status, 0, run.stderr);
  return JSON.parse(run.stdout).openrpc;
}

function resolved(document, schema) {
  if (typeof schema?.$ref !== "string") return schema;
  const names = schema.$ref.slice(2).split("/");
  return resolved(document, names.reduce((node, name) => node[name], document));
}

/** The kinds of JSON value that a TypeScript type written like this stands for. */
function kindsOf(type) {
  return type.split("|").map((part) => {
    const name = part.trim();
    if (name === "number" || name === "string" || name === "boolean" || name === "null") return name;
    if (name.startsWith('"')) return "string";
    return /\[\]$|^Vector3$/.test(name) ? "array" : "object";
  });
}

function kindsOfSchema(document, schema) {
  const node = resolved(document, schema);
  const variants = node.anyOf ?? node.oneOf;
  if (variants) return variants.flatMap((variant) => kindsOfSchema(document, variant));
  const types = [node.type ?? (node.enum ? "string" : "object")].flat();
  return types.map((type) => (type === "integer" ? "number" : type));
}

test("every member that clients read is declared by the server, of that kind", () => {
  const document = declaredByServer();
  const shapes = declaredMembers();
  let checked = 0;
  for (const [method, shape] of Object.entries(results)) {
    const declared = document.methods.find(({ name }) => name === method);
    if (!declared) continue;
    const { properties } = resolved(document, declared.result.schema);
    for (const { name, optional, type } of shapes.get(shape)) {
      const schema = properties[name];
      if (!schema) {
        assert.ok(optional, `${method} gives no ${name}, which ${shape} has`);
        continue;
      }
      const known = kindsOf(type);
      const given = kindsOfSchema(document, schema);
      for (const kind of given) {
        const passed = known.includes(kind) || (kind === "null" && optional);
        assert.ok(passed, `${method}: ${name} may be ${kind}, ${shape} says ${type}`);
      }
      checked += 1;
    }
  }
  assert.ok(checked > 40, `only ${checked} members were compared`);
});
