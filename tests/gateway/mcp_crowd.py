#!/usr/bin/env python3
"""Clients of `mcp --http` who go: mcp_crowd.py http://HOST:PORT/mcp?token=TOKEN   while a module never answers.

72 ask for the tools and close at once; then a `ping` must be answered, and of 33 who ask and wait the last is refused. Once
those have closed, there is room again. Prints what it finds wrong and ends with 1, or `ok`.
"""
import json
import select
import socket
import sys
import time
import urllib.parse

LIMIT_S = 20
AT_A_TIME = 32


class Client:
    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.place, self.target = (parts.hostname, parts.port), parts.path + "?" + parts.query
        self.session = ""

    def ask(self, method):
        """An open connection that has asked."""
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": {"protocolVersion": "2025-11-25"}})
        connection = socket.create_connection(self.place, LIMIT_S)
        head = (f"POST {self.target} HTTP/1.1\r\nHost: {self.place[0]}:{self.place[1]}\r\nContent-Type: application/json\r\n"
                f"Content-Length: {len(body)}\r\n" + (f"Mcp-Session-Id: {self.session}\r\n" if self.session else "") + "\r\n")
        connection.sendall((head + body).encode())
        return connection

    def answer(self, connection):
        """(status, headers, body); all that has come when the other side is quiet or has closed."""
        text = b""
        while b"\r\n\r\n" not in text:
            piece = connection.recv(65536)
            if not piece:
                break
            text += piece
        head, _, body = text.decode().partition("\r\n\r\n")
        lines = head.split("\r\n")
        headers = {name.lower(): value for name, _, value in (line.partition(": ") for line in lines[1:])}
        while len(body) < int(headers.get("content-length", 0)):
            body += connection.recv(65536).decode()
        connection.close()
        return (lines[0].split(" ") + ["nothing"])[1], headers, body


def expect(right, what):
    if not right:
        sys.exit(f"mcp_crowd: wrong: {what}")


def until_there_is_room(client):
    """Asks for the tools until that is not refused at once, and returns the connection that waits."""
    until = time.monotonic() + LIMIT_S
    while time.monotonic() < until:
        connection = client.ask("tools/list")
        status, _, body = client.answer(client.ask("ping"))
        expect(status == "200" and '"result"' in body, ("ping", status, body))
        if not select.select([connection], [], [], 0)[0]:
            return connection
        connection.close()
    sys.exit("mcp_crowd: wrong: those who have gone still have the places")


def main():
    client = Client(sys.argv[1])
    status, headers, _ = client.answer(client.ask("initialize"))
    expect(status == "200", status)
    client.session = headers["mcp-session-id"]
    for _ in range(72):
        client.ask("tools/list").close()
    for turn in range(2):
        waiting = [until_there_is_room(client)]
        waiting += [client.ask("tools/list") for _ in range(AT_A_TIME)]
        status, _, body = client.answer(client.ask("tools/call"))
        expect("-32000" in body, (turn, "one more than allowed", status, body))
        for connection in waiting:
            connection.close()
    until_there_is_room(client)
    print("ok")


if __name__ == "__main__":
    main()
