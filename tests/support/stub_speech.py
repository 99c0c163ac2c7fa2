#!/usr/bin/env python3
"""A stand-in for an OpenAI-compatible server of voices and ears, for tests.

    stub_speech.py [--sound FILE.wav]

Prints its port, then a line for each request: `POST PATH Authorization MODEL | ...`. What it does the model's name says:

    /v1/audio/speech
      good          the file's sound in the format asked for: wav, pcm, mp3
      streamed      WAV whose header says nothing of its length, as of a server that streams
      wav           WAV, whatever was asked for
      empty         a WAV without sound
      garbage       WAV in name alone
    /v1/audio/transcriptions
      say WORDS     these words
      words WORDS   the same, each with its times (300 ms apart)
      nonsense      no JSON
    either
      text          a page for people in place of an answer
      error         an error with status 200
      short         breaks off before the length it has told
      stall         a head, then nothing
      late          nothing at all
      big           bytes without end
      close         closes without an answer
      CODE          that status; the text has our key in it
"""
import argparse
import email.parser
import email.policy
import http.server
import io
import json
import struct
import subprocess
import threading
import wave

SOUND = None


def read_sound():
    with wave.open(SOUND) as file:
        return file.getframerate(), file.readframes(file.getnframes())


def wav(rate, frames, told=None):
    told = len(frames) if told is None else told
    return (b"RIFF" + struct.pack("<I", min(told + 36, 0xFFFFFFFF)) + b"WAVEfmt " +
            struct.pack("<IHHIIHH", 16, 1, 1, rate, rate * 2, 2, 16) + b"data" + struct.pack("<I", told) + frames)


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_POST(self):
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        speech = self.path.endswith("/speech")
        self.asked = json.loads(body) if speech else self.form(body)
        if speech:
            rest = " ".join(str(self.asked.get(key, "-")) for key in ("voice", "response_format", "speed", "extra"))
            rest += " | " + self.asked["input"].strip()
        else:
            with wave.open(io.BytesIO(self.asked.pop("file"))) as file:
                rest = f"{file.getframerate()} Hz {file.getnchannels()} {file.getsampwidth()} {file.getnframes()}"
            rest = " ".join(f"{k}={v}" for k, v in sorted(self.asked.items()) if k != "model") + " | " + rest
        print("POST", self.path, self.headers.get("Authorization", "-"), self.asked["model"], rest, flush=True)
        name, *words = self.asked["model"].split(" ")
        try:
            if name.isdigit():
                return self.status(int(name))
            getattr(self, "do_" + name)(*words)
        except (BrokenPipeError, ConnectionResetError):
            print("CLOSED", flush=True)

    def form(self, body):
        head = ("Content-Type: " + self.headers["Content-Type"] + "\r\n\r\n").encode()
        parts = email.parser.BytesParser(policy=email.policy.HTTP).parsebytes(head + body)
        values = {}
        for part in parts.iter_parts():
            name = part.get_param("name", header="content-disposition")
            content = part.get_payload(decode=True)
            values[name] = content if name == "file" else content.decode()
        return values

    def answer(self, kind, content, told=None):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content) if told is None else told))
        self.end_headers()
        self.wfile.write(content)
        self.wfile.flush()

    def status(self, code):
        text = json.dumps({"error": {"message": "stub says no, " + self.headers.get("Authorization", "")}}).encode()
        self.send_response(code)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(text)))
        if code == 307:
            self.send_header("Location", "/elsewhere")
        self.end_headers()
        self.wfile.write(text)

    def do_good(self):
        rate, frames = read_sound()
        kind = self.asked["response_format"]
        if kind == "wav":
            return self.answer("audio/wav", wav(rate, frames))
        if kind == "pcm":
            return self.answer("audio/pcm", frames)
        mp3 = subprocess.run(["ffmpeg", "-v", "error", "-i", SOUND, "-f", "mp3", "-"], capture_output=True, check=True)
        self.answer("audio/mpeg", mp3.stdout)

    def do_streamed(self):
        rate, frames = read_sound()
        self.send_response(200)
        self.send_header("Content-Type", "audio/wav")
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()
        sound = wav(rate, frames, 0xFFFFFFFF)
        for at in range(0, len(sound), 4096):
            piece = sound[at:at + 4096]
            self.wfile.write(b"%x\r\n%s\r\n" % (len(piece), piece))
        self.wfile.write(b"0\r\n\r\n")

    def do_wav(self):
        self.answer("audio/wav", wav(*read_sound()))

    def do_empty(self):
        self.answer("audio/wav", wav(16000, b""))

    def do_garbage(self):
        self.answer("audio/wav", b"RIFF" + bytes(range(256)) * 8)

    def do_say(self, *words):
        self.answer("application/json", json.dumps({"text": " ".join(words)}).encode())

    def do_words(self, *words):
        timed = [{"word": word, "start": 0.3 * i, "end": 0.3 * i + 0.2} for i, word in enumerate(words)]
        self.answer("application/json", json.dumps({"text": " ".join(words), "words": timed}).encode())

    def do_nonsense(self):
        self.answer("application/json", b"{nonsense")

    def do_text(self):
        self.answer("text/html", b"<h1>Welcome</h1>")

    def do_error(self):
        self.answer("application/json", b'{"error": {"message": "the voice is ill"}}')

    def do_short(self):
        self.answer("audio/wav", b"RIFF", 4000)
        self.close_connection = True

    def do_stall(self):
        self.answer("audio/wav", b"", 4000)
        threading.Event().wait()

    def do_late(self):
        threading.Event().wait()

    def do_big(self):
        self.send_response(200)
        self.send_header("Content-Type", "audio/wav")
        self.send_header("Connection", "close")
        self.end_headers()
        while True:
            self.wfile.write(b"RIFF" + bytes(1 << 16))

    def do_close(self):
        self.close_connection = True
        self.connection.close()


def main():
    global SOUND
    options = argparse.ArgumentParser()
    options.add_argument("--sound")
    SOUND = options.parse_args().sound
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    print(server.server_address[1], flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
