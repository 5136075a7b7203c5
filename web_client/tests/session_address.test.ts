import assert from "node:assert/strict";
import test from "node:test";
import { SessionAddress, rendezvousRoute } from "../src/stream/session_address.ts";

const page = "https://render.example/view/";

test("everything of a page that names a session is led by its name", () => {
  const place = SessionAddress.ofPage(`${page}?session=review`);
  assert.equal(place.session, "review");
  assert.equal(place.address("ws").href, `${page}ws?session=review&enter=main`);
  const bare = SessionAddress.ofPage(page);
  assert.equal(bare.session, undefined);
  assert.equal(bare.address("ws").href, `${page}ws`);
});

test("a page's address leads to where it is, and keeps what else it says", () => {
  for (const query of ["", "?session=review", "?session=to-a1&enter=main"]) {
    const address = `${page}${query}`;
    assert.equal(SessionAddress.ofPage(address).pageUrl(address).href, address);
  }
  const moved = new SessionAddress(page, "main-0123", "main-0123");
  assert.equal(
    moved.pageUrl(`${page}?session=old&enter=main&theme=dark#view=x`).href,
    `${page}?theme=dark&session=main-0123#view=x`,
  );
  assert.equal(new SessionAddress(page, null, "review").pageUrl(page).href, `${page}?session=review`);
});

test("those who lost a session are led to one server", () => {
  const instance = "0123456789abcdef";
  assert.equal(rendezvousRoute({ instance, session: "review" }), "review");
  assert.equal(rendezvousRoute({ instance, session: "main" }), "main-01234567");
});

test("a place is shared by a name that leads to its server", async (t) => {
  const asked: string[] = [];
  t.mock.method(globalThis, "fetch", async (address: URL) => {
    asked.push(address.searchParams.get("session") ?? "");
    const instance = asked.length < 4 ? "other" : "own";
    return Response.json({ result: { instance } });
  });
  const place = await new SessionAddress(page, null, "main").findShareable({ instance: "own", session: "main" });
  assert.equal(asked[0], "main");
  assert.equal(asked.length, 4);
  assert.equal(place.pageUrl(page).href, `${page}?session=${asked[3]}&enter=main`);
});
