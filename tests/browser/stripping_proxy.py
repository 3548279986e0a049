"""A proxy that serves a service below a path, and takes that path off before it asks."""

import contextlib
import socket
import socketserver
import threading
from collections.abc import Iterator

from tests.servers import free_port


@contextlib.contextmanager
def below(prefix: str, service_port: int) -> Iterator[str]:
    """Yield the address at which the service on a port of this machine is found below a prefix."""

    class Stripping(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            """Pass one request on, and its answer back as it comes."""
            method, target, version = self.rfile.readline().decode("latin-1").split()
            lines = list(iter(self.rfile.readline, b"\r\n"))
            kept = [line for line in lines if not line.lower().startswith(b"connection:")]
            length = sum(int(line[15:]) for line in lines if line.lower().startswith(b"content-length:"))
            if not target.startswith(f"{prefix}/"):
                self.wfile.write(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
                return
            first = f"{method} {target.removeprefix(prefix)} {version}\r\n".encode("latin-1")
            with socket.create_connection(("127.0.0.1", service_port)) as service:
                service.sendall(b"".join((first, *kept, b"Connection: close\r\n\r\n", self.rfile.read(length))))
                while piece := service.recv(65536):
                    self.wfile.write(piece)

    class Server(socketserver.ThreadingTCPServer):
        daemon_threads, allow_reuse_address = True, True

        def handle_error(self, *_: object) -> None:
            """Keep quiet about browsers that leave."""

    port = free_port()
    with Server(("127.0.0.1", port), Stripping) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{port}{prefix}"
        server.shutdown()
