// What stands before several servers: requests that name a session go to the server that the name
// leads to, others to the one that a cookie would have kept. A server that has ended is passed over.

import http from "node:http";
import { once } from "node:events";

export class Balancer {
  /** `home` is where requests without a name go while it lives. */
  constructor(servers, home = servers[0]) {
    this.servers = servers;
    this.home = home;
    /** Whether upgrades get through. */
    this.upgrades = true;
    this.paths = [];
    this.pairs = new Set();
  }

  async start() {
    this.proxy = http.createServer((request, response) => this.pass(request, response));
    this.proxy.on("upgrade", (request, socket, head) => this.passSocket(request, socket, head));
    this.proxy.listen(0, "127.0.0.1");
    await once(this.proxy, "listening");
    this.url = `http://127.0.0.1:${this.proxy.address().port}/`;
    return this;
  }

  stop() {
    this.cut();
    this.proxy.closeAllConnections();
    this.proxy.close();
  }

  /** Breaks everything that is under way. */
  cut() {
    for (const end of this.pairs) end.destroy();
    this.pairs.clear();
  }

  /** The server that a name leads to. */
  serverOf(name) {
    const living = this.servers.filter(isAlive);
    const sum = [...name].reduce((hash, letter) => (hash * 31 + letter.charCodeAt(0)) >>> 0, 7);
    return living[sum % living.length];
  }

  /** A name that leads to this server. */
  nameFor(server, stem = "room") {
    let number = 1;
    while (this.serverOf(`${stem}-${number}`) !== server) number += 1;
    return `${stem}-${number}`;
  }

  choose(address) {
    const name = new URL(address, this.url).searchParams.get("session");
    if (name !== null) return this.serverOf(name);
    return isAlive(this.home) ? this.home : this.servers.find(isAlive);
  }

  ask(request) {
    this.paths.push(request.url);
    const { method, url: path, headers } = request;
    const { port } = this.choose(path);
    return http.request({ host: "127.0.0.1", port, method, path, headers, agent: false });
  }

  keep(...ends) {
    for (const end of ends) {
      this.pairs.add(end);
      end.on("error", () => {});
      end.on("close", () => {
        this.pairs.delete(end);
        for (const other of ends) other.destroy();
      });
    }
  }

  pass(request, response) {
    const asked = this.ask(request);
    asked.on("error", () => response.destroy());
    asked.on("response", (answer) => {
      response.writeHead(answer.statusCode, answer.headers);
      answer.on("error", () => response.destroy());
      answer.on("aborted", () => response.destroy());
      this.keep(response);
      response.on("close", () => answer.destroy());
      answer.pipe(response);
    });
    request.pipe(asked);
  }

  passSocket(request, socket, head) {
    if (!this.upgrades) {
      socket.end("HTTP/1.1 501 Not Implemented\r\ncontent-length: 0\r\nconnection: close\r\n\r\n");
      return;
    }
    const asked = this.ask(request);
    socket.on("error", () => {});
    asked.on("error", () => socket.destroy());
    asked.on("response", (answer) => {
      socket.end(`HTTP/1.1 ${answer.statusCode} ${answer.statusMessage}\r\nconnection: close\r\n\r\n`);
      answer.resume();
    });
    asked.on("upgrade", (answer, other, first) => {
      const { rawHeaders } = answer;
      const lines = rawHeaders.flatMap((name, i) => (i % 2 ? [] : [`${name}: ${rawHeaders[i + 1]}`]));
      socket.write(`HTTP/1.1 101 Switching Protocols\r\n${lines.join("\r\n")}\r\n\r\n`);
      socket.write(first);
      other.write(head);
      this.keep(socket, other);
      socket.pipe(other).pipe(socket);
    });
    asked.end();
  }
}

function isAlive({ child }) {
  return child.exitCode === null && child.signalCode === null;
}
