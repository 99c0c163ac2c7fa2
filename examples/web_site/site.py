#!/usr/bin/env python3
"""A web site with an agent, for trying: / is index.html, and three addresses go on to the hub's page, with its token.

Visitors never see the token (docs/tutorial/web_site.md). Usage: site.py PORT PORT_OF_THE_HUB TOKEN_FILE
"""
import errno
import http.server
import pathlib
import socket
import sys
import threading

PORT, HUB = int(sys.argv[1]), int(sys.argv[2])
TOKEN = pathlib.Path(sys.argv[3]).read_text().strip()


def copy(source, drain):
    try:
        while data := source.recv(65536):
            drain.sendall(data)
        drain.shutdown(socket.SHUT_WR)
    except OSError:
        pass  # one of the two has gone


class Site(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        if self.path in ("/agent/ws", "/agent/face", "/agent/voice"):
            return self.pass_on(self.path.removeprefix("/agent"))
        self.send_response(200 if self.path == "/" else 404)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        if self.path == "/":
            self.wfile.write(pathlib.Path(__file__).with_name("index.html").read_bytes())

    def pass_on(self, path):
        head = [f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{HUB}", f"Authorization: Bearer {TOKEN}"]
        head += [f"{name}: {value}" for name, value in self.headers.items()
                 if name.lower() in ("connection", "upgrade") or name.lower().startswith("sec-websocket-")]
        with socket.create_connection(("127.0.0.1", HUB)) as hub:
            hub.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
            threading.Thread(target=copy, args=(self.connection, hub), daemon=True).start()
            copy(hub, self.connection)
        self.close_connection = True


try:
    server = http.server.ThreadingHTTPServer(("127.0.0.1", PORT), Site)
except OSError as error:
    why = "is taken by another program" if error.errno == errno.EADDRINUSE else f"cannot be opened ({error.strerror})"
    sys.exit(f"site.py: port {PORT} {why}; give another one as the first argument")
print(f"the site is at http://127.0.0.1:{PORT}/", flush=True)
server.serve_forever()
