// An example that can be edited and run.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { isObject } from "heliograph/settings_tree.ts";
import { copyText } from "../common/clipboard.ts";
import { element, setText, uniqueId } from "../widgets/element.ts";
import { type Answer, call, curlCommand, pythonProgram } from "./calls.ts";

/** Longer results, such as images, are cut. */
const maxShown = 20_000;

export interface ExampleContext {
  base: string;
  /** The session in which examples run. */
  session(): string;
}

/** What the user typed, or why it is no object of parameters. */
function parsed(typed: string): JsonObject | string {
  try {
    const value = JSON.parse(typed || "{}") as JsonValue;
    return isObject(value) ? value : "The parameters are not an object: { … }";
  } catch (error) {
    return `This is not JSON: ${(error as Error).message}`;
  }
}

export function createExample(
  context: ExampleContext,
  method: string,
  params: JsonObject,
): HTMLElement {
  const id = uniqueId("params");
  const text = JSON.stringify(params, null, 2);
  const input = element("textarea", {
    id,
    spellcheck: "false",
    autocomplete: "off",
    rows: String(Math.min(12, text.split("\n").length)),
  });
  input.value = text;
  const status = element("p", { class: "status", role: "status" });
  const output = element("pre", { class: "answer", tabindex: "0", hidden: true });
  const run = element("button", { type: "submit", class: "button" }, "Run");
  const fail = (message: string): void => {
    output.hidden = true;
    status.className = "status bad";
    setText(status, message);
  };
  const show = ({ result, error, milliseconds }: Answer): void => {
    const time = `${Math.round(milliseconds)} ms`;
    status.className = error ? "status bad" : "status";
    setText(status, error ? `Error ${error.code} after ${time}: ${error.message}` : `Answered in ${time}`);
    output.hidden = false;
    const answer = JSON.stringify(error ?? result, null, 2);
    const rest = answer.length - maxShown;
    output.textContent =
      rest > 0 ? `${answer.slice(0, maxShown)}\n… and ${rest} more characters` : answer;
    output.setAttribute("aria-label", `Answer of ${method}`);
  };
  const submit = async (): Promise<void> => {
    const values = parsed(input.value);
    if (typeof values === "string") return fail(values);
    run.disabled = true;
    status.className = "status";
    setText(status, "Waiting for the server");
    try {
      show(await call(context.base, context.session(), method, values));
    } catch (error) {
      fail(`No answer: ${(error as Error).message}`);
    } finally {
      run.disabled = false;
    }
  };
  const copy = (label: string, write: typeof curlCommand): HTMLButtonElement =>
    element(
      "button",
      {
        type: "button",
        class: "button quiet",
        click: () => {
          const values = parsed(input.value);
          if (typeof values === "string") return fail(values);
          const program = write(context.base, context.session(), method, values);
          copyText(program).then(
            () => {
              status.className = "status";
              setText(status, `Copied for ${label}`);
            },
            (error: Error) => fail(error.message),
          );
        },
      },
      `Copy for ${label}`,
    );
  return element(
    "form",
    {
      class: "example",
      submit: (event: Event) => {
        event.preventDefault();
        void submit();
      },
      keydown: (event: KeyboardEvent) => {
        if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void submit();
      },
    },
    element("label", { for: id }, "Example"),
    input,
    element("div", { class: "actions" }, run, copy("curl", curlCommand), copy("Python", pythonProgram)),
    status,
    output,
  );
}
