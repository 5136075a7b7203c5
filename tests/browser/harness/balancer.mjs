// A load balancer: requests with a session go to the server that its name selects, others to the
// one that a cookie would select. Servers that have exited are skipped.

import http from "node:http";
import { once } from "node:events";

export class Balancer {
  /** Requests without a session go to `home` while it is alive. */
  constructor(servers, home = servers[0]) {
    this.servers = servers;
    this.home = home;
    /** Whether upgrades are passed on. */
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
    this.disconnect();
    this.proxy.closeAllConnections();
    this.proxy.close();
  }

  /** Closes all open connections. */
  disconnect() {
    for (const end of this.pairs) end.destroy();
    this.pairs.clear();
  }

  /** The server that a name selects. */
  serverOf(name) {
    const living = this.servers.filter(isAlive);
    const sum = [...name].reduce((hash, letter) => (hash * 31 + letter.charCodeAt(0)) >>> 0, 7);
    return living[sum % living.length];
  }

  /** A name that selects this server. */
  nameFor(server, stem = "session") {
    let number = 1;
    while (this.serverOf(`${stem}-${number}`) !== server) number += 1;
    return `${stem}-${number}`;
  }

  choose(address) {
    const name = new URL(address, this.url).searchParams.get("session");
    if (name !== null) return this.serverOf(name);
    return isAlive(this.home) ? this.home : this.servers.find(isAlive);
  }

  forward(request) {
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
    const outgoing = this.forward(request);
    outgoing.on("error", () => response.destroy());
    outgoing.on("response", (answer) => {
      response.writeHead(answer.statusCode, answer.headers);
      answer.on("error", () => response.destroy());
      answer.on("aborted", () => response.destroy());
      this.keep(response);
      response.on("close", () => answer.destroy());
      answer.pipe(response);
    });
    request.pipe(outgoing);
  }

  passSocket(request, socket, head) {
    if (!this.upgrades) {
      socket.end("HTTP/1.1 501 Not Implemented\r\ncontent-length: 0\r\nconnection: close\r\n\r\n");
      return;
    }
    const outgoing = this.forward(request);
    socket.on("error", () => {});
    outgoing.on("error", () => socket.destroy());
    outgoing.on("response", (answer) => {
      socket.end(
        `HTTP/1.1 ${answer.statusCode} ${answer.statusMessage}\r\nconnection: close\r\n\r\n`,
      );
      answer.resume();
    });
    outgoing.on("upgrade", (answer, other, first) => {
      const { rawHeaders } = answer;
      const lines = rawHeaders.flatMap((name, i) =>
        i % 2 ? [] : [`${name}: ${rawHeaders[i + 1]}`],
      );
      socket.write(`HTTP/1.1 101 Switching Protocols\r\n${lines.join("\r\n")}\r\n\r\n`);
      socket.write(first);
      other.write(head);
      this.keep(socket, other);
      socket.pipe(other).pipe(socket);
    });
    outgoing.end();
  }
}

function isAlive({ child }) {
  return child.exitCode === null && child.signalCode === null;
}
