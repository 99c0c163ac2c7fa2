#!/usr/bin/env python3
"""A stand-in for a language model's endpoint, for tests and measurements.

    stub_model.py [--port N] [--tls CERTIFICATE KEY]

Prints its port, then a line for each request: `POST PATH Authorization MODEL LAST-WORDS`. Streams what the model's name asks for:

    echo          "You said: WORDS." and a second sentence, at once
    say TEXT      TEXT
    slow          the same, a word each 50 ms
    long          sentences without end, one each 20 ms
    stall         one sentence, then nothing more
    break         one sentence and a half, then the connection is closed
    nonsense      an event that is no JSON
    giant         one line of 4 MiB
    big           100 MiB of comments
    whole         an answer that is no stream
    tool SLOT V   has SLOT set to V, then says what came of it
    CODE          an answer with that status; 429 has Retry-After: 2, 307 leads to /elsewhere
    close         closes without an answer
"""
import argparse
import http.server
import json
import ssl
import sys
import time


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        self.do_POST()

    def do_POST(self):
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        try:
            asked = json.loads(body)
        except ValueError:
            asked = {"model": "400", "messages": [{"content": "?"}]}
        self.messages = asked["messages"]
        self.words = str(self.messages[-1].get("content"))
        print("POST", self.path, self.headers.get("Authorization", "-"), asked["model"], "|", self.words, flush=True)
        self.close_connection = True
        name, *arguments = asked["model"].split(" ")
        try:
            if name.isdigit():
                return self.status(int(name))
            getattr(self, "do_" + name)(*arguments)
        except (BrokenPipeError, ConnectionResetError):
            print("CLOSED", flush=True)

    def status(self, code):
        text = json.dumps({"error": {"message": "stub says no, " + self.headers.get("Authorization", "")}}).encode()
        self.send_response(code)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(text)))
        if code == 429:
            self.send_header("Retry-After", "2")
        if code == 307:
            self.send_header("Location", "/elsewhere")
        self.end_headers()
        self.wfile.write(text)

    def begin(self, kind="text/event-stream"):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Connection", "close")
        self.end_headers()

    def raw(self, text):
        self.wfile.write(text.encode() if isinstance(text, str) else text)
        self.wfile.flush()

    def delta(self, delta, reason=None):
        self.raw("data: " + json.dumps({"object": "chat.completion.chunk",
                                        "choices": [{"index": 0, "delta": delta, "finish_reason": reason}]}) + "\n\n")

    def say(self, text):
        self.delta({"content": text})

    def end(self):
        self.delta({}, "stop")
        self.raw("data: [DONE]\n\n")

    def answer(self):
        return f"[happy 70] You said: {self.words.rstrip('.?!')}. [nod] That is all I know."

    def do_echo(self):
        self.begin()
        for word in self.answer().split(" "):
            self.say(word + " ")
        self.end()

    def do_say(self, *words):
        self.begin()
        self.say(" ".join(words))
        self.end()

    def do_slow(self):
        self.begin()
        for word in self.answer().split(" "):
            self.say(word + " ")
            time.sleep(0.05)
        self.end()

    def do_long(self):
        self.begin()
        for number in range(100000):
            self.say(f"This is sentence number {number} of very many. ")
            time.sleep(0.02)

    def do_stall(self):
        self.begin()
        self.say("I begin. And")
        while True:
            time.sleep(1)

    def do_break(self):
        self.begin()
        self.say("I begin. And I")

    def do_nonsense(self):
        self.begin()
        self.say("I begin. ")
        self.raw("data: {nonsense\n\n")
        self.end()

    def do_giant(self):
        self.begin()
        self.raw("data: " + "x" * (4 << 20) + "\n\n")
        self.end()

    def do_big(self):
        self.begin()
        for _ in range(1600):
            self.raw(": " + "x" * (64 << 10) + "\n")
        self.end()

    def do_whole(self):
        self.begin("application/json")
        self.raw(json.dumps({"choices": [{"message": {"content": self.answer()}}]}))

    def do_tool(self, module, slot, value):
        self.begin()
        if self.messages[-1]["role"] == "tool":
            self.say("It says: " + self.words + ".")
        else:
            arguments = json.dumps({"slot": module + " " + slot, "value": value})
            for piece in (arguments[:7], arguments[7:]):
                self.delta({"tool_calls": [{"index": 0, "id": "c1", "function": {"name": "set_slot", "arguments": piece}}]})
        self.end()

    def do_close(self):
        self.connection.close()


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--port", type=int, default=0)
    options.add_argument("--tls", nargs=2)
    given = options.parse_args()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", given.port), Handler)
    server.daemon_threads = True
    if given.tls:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(*given.tls)
        server.socket = context.wrap_socket(server.socket, server_side=True)
    print(server.server_address[1], flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        sys.exit(0)


if __name__ == "__main__":
    main()
