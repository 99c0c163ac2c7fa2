"""Where a hub is, and what is shown and asked for there (docs/protocol.md, Other machines)."""
from __future__ import annotations

import hashlib
import hmac
import os
import secrets
import socket
import ssl
from dataclasses import dataclass

from galatea.errors import Ended, Refused
from galatea.message import parse

MIN_TOKEN_BYTES = 16
ADMISSION_S = 10.0
_ASKING = "Galatea 1.0 asks for the token, "


@dataclass(frozen=True)
class Endpoint:
    """`unix:PATH`, `tcp:HOST:PORT` or `tls:HOST:PORT`; HOST is a name, an IPv4 address, or [IPv6]."""

    kind: str
    host: str
    port: int = 0

    @staticmethod
    def read(text: str) -> Endpoint:
        kind, _, rest = text.partition(":")
        if kind == "unix" and rest:
            return Endpoint(kind, rest)
        host, _, port = rest.rpartition(":")
        if kind in ("tcp", "tls") and host and port.isdecimal() and 0 < int(port) < 65536:
            return Endpoint(kind, host.removeprefix("[").removesuffix("]"), int(port))
        raise ValueError(f"'{text}': expected unix:PATH, tcp:HOST:PORT or tls:HOST:PORT")


@dataclass(frozen=True)
class Credentials:
    """Files, by name, all optional: the secret both sides know, what we show (PEM) and its key, and who signs for them."""

    token_file: str = ""
    certificate: str = ""
    key: str = ""
    authority: str = ""

    def token(self) -> str:
        """The first line of the token's file, "" if none is named. Raises ValueError if it is open to others or short."""
        if not self.token_file:
            return ""
        if os.stat(self.token_file).st_mode & 0o077:
            raise ValueError(f"the token file '{self.token_file}' is open to others, expected mode 600")
        with open(self.token_file, encoding="utf-8") as file:
            token = file.readline().rstrip("\r\n ")
        if len(token.encode()) < MIN_TOKEN_BYTES:
            raise ValueError(f"the token in '{self.token_file}' is shorter than {MIN_TOKEN_BYTES} bytes")
        return token

    def tls(self) -> ssl.SSLContext:
        """TLS 1.2 or newer, the host and its certificate checked against `authority`, or else against the system's."""
        context = ssl.create_default_context(cafile=self.authority or None)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        if self.certificate:
            context.load_cert_chain(self.certificate, self.key or None)
        return context


class TokenProof:
    """Our side of showing a token, which is never sent itself. No input or output of its own."""

    def __init__(self, token: str) -> None:
        self._token = token.encode()
        self._ours = secrets.token_hex(32)
        self._theirs = ""

    def _proof(self, role: str) -> str:
        text = f"galatea 1 {role} {self._theirs} {self._ours}".encode()
        return hmac.new(self._token, text, hashlib.sha256).hexdigest()

    def answer(self, question: bytes) -> str:
        """What to say to the listener's first line. Raises Refused (ACCESS)."""
        message = parse(question)
        if message.command != "tell" or not message.value.startswith(_ASKING):
            raise Refused("ACCESS", "it does not ask for the token")
        self._theirs = message.value.removeprefix(_ASKING)
        return f"set#token Token = {self._ours} {self._proof('caller')}"

    def check(self, answer: bytes) -> None:
        """Raises Refused (ACCESS) unless the listener's second line shows that it knows the token, too."""
        message = parse(answer)
        if message.slot != "Token" or not hmac.compare_digest(message.value, self._proof("listener")):
            raise Refused("ACCESS", "the token was refused")


def call(endpoint: Endpoint, credentials: Credentials) -> socket.socket:
    """A connected socket, its TLS and token dealt with. Raises OSError, or Refused (ACCESS)."""
    if endpoint.kind == "unix":
        plain = socket.socket(socket.AF_UNIX)
        plain.settimeout(ADMISSION_S)
        plain.connect(endpoint.host)
    else:
        plain = socket.create_connection((endpoint.host, endpoint.port), ADMISSION_S)
        plain.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    try:
        return _admitted(plain, endpoint, credentials)
    except BaseException:
        plain.close()
        raise


def _admitted(plain: socket.socket, endpoint: Endpoint, credentials: Credentials) -> socket.socket:
    token = credentials.token()
    if endpoint.kind == "tls":
        plain = credentials.tls().wrap_socket(plain, server_hostname=endpoint.host)
    if token:
        proof = TokenProof(token)
        try:
            plain.sendall(proof.answer(_line(plain)).encode() + b"\n")
            proof.check(_line(plain))
        except BaseException:
            plain.close()
            raise
    plain.settimeout(None)
    return plain


def _line(plain: socket.socket) -> bytes:
    """One line, read byte by byte: what follows it is for whoever gets the socket."""
    line = b""
    while not line.endswith(b"\n"):
        byte = plain.recv(1)
        if not byte or len(line) > 1024:
            raise Ended("it ended the connection instead of asking for a token")
        line += byte
    return line
