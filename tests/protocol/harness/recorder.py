"""A relay between a proxy and the server that keeps what passes, connection by connection."""

import contextlib
import socket
import threading


class Passage:
    """One connection: bytes to the server, bytes from it."""

    def __init__(self):
        self.sent = bytearray()
        self.answered = bytearray()


class Recorder:
    def __init__(self, target):
        """`target`: the port of the server."""
        self.target = target
        self.passages = []
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=64)
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def stop(self):
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                client = self._listener.accept()[0]
                server = socket.create_connection(("127.0.0.1", self.target))
                passage = Passage()
                self.passages.append(passage)
                for source, sink, record in ((client, server, passage.sent),
                                             (server, client, passage.answered)):
                    threading.Thread(target=self._pump, args=(source, sink, record), daemon=True).start()

    @staticmethod
    def _pump(source, sink, record):
        """Until one side ends; an end of one direction is passed on as such."""
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                record += data
                sink.sendall(data)
        with contextlib.suppress(OSError):
            sink.shutdown(socket.SHUT_WR)
