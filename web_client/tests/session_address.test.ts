import assert from "node:assert/strict";
import test from "node:test";
import { SessionAddress, rendezvousRoute } from "../src/stream/session_address.ts";

const page = "https://render.example/view/";

test("all requests of a page with a session have its route", () => {
  const address = SessionAddress.ofPage(`${page}?session=review`);
  assert.equal(address.session, "review");
  assert.equal(address.url("ws").href, `${page}ws?session=review&enter=main`);
  const plain = SessionAddress.ofPage(page);
  assert.equal(plain.session, undefined);
  assert.equal(plain.url("ws").href, `${page}ws`);
});

test("the page's URL leads to its session and keeps all other parameters", () => {
  for (const query of ["", "?session=review", "?session=to-a1&enter=main"]) {
    const url = `${page}${query}`;
    assert.equal(SessionAddress.ofPage(url).pageUrl(url).href, url);
  }
  const moved = new SessionAddress(page, "main-0123", "main-0123");
  assert.equal(
    moved.pageUrl(`${page}?session=old&enter=main&theme=dark#view=x`).href,
    `${page}?theme=dark&session=main-0123#view=x`,
  );
  assert.equal(
    new SessionAddress(page, null, "review").pageUrl(page).href,
    `${page}?session=review`,
  );
});

test("all viewers of a lost session get the same route", () => {
  const instance = "0123456789abcdef";
  assert.equal(rendezvousRoute({ instance, session: "review" }), "review");
  assert.equal(rendezvousRoute({ instance, session: "main" }), "main-01234567");
});

test("a shareable address has a route that leads to the same server", async (t) => {
  const tried: string[] = [];
  t.mock.method(globalThis, "fetch", async (url: URL) => {
    tried.push(url.searchParams.get("session") ?? "");
    const instance = tried.length < 4 ? "other" : "own";
    return Response.json({ result: { instance } });
  });
  const address = await new SessionAddress(page, null, "main").findShareable({
    instance: "own",
    session: "main",
  });
  assert.equal(tried[0], "main");
  assert.equal(tried.length, 4);
  assert.equal(address.pageUrl(page).href, `${page}?session=${tried[3]}&enter=main`);
});
