"""The client in asyncio: many requests under way at once, and what arrives as an asynchronous iterator."""
from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from types import TracebackType

from galatea.client import TIMEOUT_S
from galatea.conversation import Conversation, Request
from galatea.endpoint import ADMISSION_S, Credentials, Endpoint, TokenProof
from galatea.errors import Ended, Refused
from galatea.message import Message, inq, parse, set_


class AsyncClient:
    """As galatea.Client, for asyncio:

        async with await AsyncClient.connect("unix:/tmp/hub", name="ME") as hub:
            await hub.set("Speak", "Hello.", to="AM-MCL")
    """

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter,
                 process: asyncio.subprocess.Process | None = None) -> None:
        self._reader = reader
        self._writer = writer
        self._process = process
        self._heard: asyncio.Queue[Message | None] = asyncio.Queue()
        self._conversation = Conversation(self._heard.put_nowait)
        self._carrier = asyncio.create_task(self._carry())

    @staticmethod
    async def connect(endpoint: str, *, name: str = "", token_file: str = "", certificate: str = "", key: str = "",
                      authority: str = "") -> AsyncClient:
        """To `unix:PATH`, `tcp:HOST:PORT` or `tls:HOST:PORT`. With a name, `to @NAME` reaches you from then on."""
        where, shown = Endpoint.read(endpoint), Credentials(token_file, certificate, key, authority)
        async with asyncio.timeout(ADMISSION_S):
            if where.kind == "unix":
                reader, writer = await asyncio.open_unix_connection(where.host)
            else:
                tls = shown.tls() if where.kind == "tls" else None
                reader, writer = await asyncio.open_connection(where.host, where.port, ssl=tls)
            try:
                if token := shown.token():
                    proof = TokenProof(token)
                    writer.write(proof.answer(await reader.readline()).encode() + b"\n")
                    proof.check(await reader.readline())
            except BaseException:
                writer.close()
                raise
        client = AsyncClient(reader, writer)
        if name:
            try:
                await client.set("Name", name, to="AM")
            except BaseException:
                await client.close()
                raise
        return client

    @staticmethod
    async def start(command: Sequence[str], *, cwd: str | None = None, env: dict[str, str] | None = None) -> AsyncClient:
        """Starts a program and speaks to it over its stdin and stdout; its stderr is ours."""
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, cwd=cwd, env=env)
        assert process.stdin and process.stdout
        return AsyncClient(process.stdout, process.stdin, process)

    async def send(self, message: Message | str, to: str | tuple[str, ...] = "") -> None:
        """Says something and does not wait for an answer. A str is a whole line."""
        whole = parse(message) if isinstance(message, str) else message
        await self._write(whole.addressed(to).checked())

    async def request(self, message: Message, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        return (await self._ask(message, to, timeout_s)).value()

    async def set(self, slot: str, value: object, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        return await self.request(set_(slot, str(value)), to, timeout_s)

    async def inq(self, slot: str, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        return await self.request(inq(slot), to, timeout_s)

    async def inq_group(self, slot: str, to: str = "", timeout_s: float = TIMEOUT_S) -> dict[str, str]:
        """The members of a group (`inq Speak`) with their values."""
        asked = await self._ask(inq(slot), to, timeout_s)
        asked.value()
        return {member.slot: member.value for member in asked.members}

    async def auto_output(self, slot: str, to: str = "", on: bool = True) -> None:
        """Whether changes of a slot are reported unasked."""
        await self.request(Message("prop", slot, "AutoOutput" if on else "NoAutoOutput", "="), to)

    async def subscribe(self, *modules: str) -> None:
        """Hear what these modules report to nobody in particular: names, "*" for all; none = nobody."""
        await self.set("Subscribe", " ".join(name.removeprefix("@") for name in modules) or "NONE", to="AM")

    async def messages(self) -> AsyncIterator[Message]:
        """What arrives that is no answer to a request, until the other side ends."""
        while (message := await self._heard.get()) is not None:
            yield message
        self._heard.put_nowait(None)  # for whoever asks again

    async def close(self) -> None:
        """Lets go; a program that was started ends once it has done what it was told."""
        self._writer.close()
        if self._process:
            await self._carrier
            await self._process.wait()
            return
        self._carrier.cancel()
        try:
            await self._writer.wait_closed()
        except OSError:  # it has gone already
            pass

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None,
                        trace: TracebackType | None) -> None:
        await self.close()

    async def _ask(self, message: Message, to: str, timeout_s: float) -> Request:
        if self._carrier.done():
            raise Ended("the other side has gone")
        asked = self._conversation.request(message.addressed(to))
        answered = asyncio.Event()
        asked.on_done = answered.set
        await self._write(asked.message)
        try:
            await asyncio.wait_for(answered.wait(), timeout_s)
        except TimeoutError:
            self._conversation.end(asked, Refused("TIMEOUT", "no answer"))
            raise TimeoutError(f"no answer to '{asked.message}' within {timeout_s} s") from None
        if self._carrier.done() and isinstance(asked.answer, Refused) and asked.answer.code == "UNAVAILABLE":
            raise Ended(f"the other side ended before it answered '{asked.message}'")
        return asked

    async def _write(self, message: Message) -> None:
        try:
            self._writer.write(str(message).encode() + b"\n")
            await self._writer.drain()
        except OSError as error:
            raise Ended(f"the other side has gone: {error.strerror}") from None

    async def _carry(self) -> None:
        try:
            while data := await self._reader.read(65536):
                self._conversation.feed(data)
        except OSError:  # reset: it has gone
            pass
        finally:
            self._heard.put_nowait(None)
            asyncio.get_running_loop().call_soon(
                self._conversation.abandon, Refused("UNAVAILABLE", "the other side has gone"))
