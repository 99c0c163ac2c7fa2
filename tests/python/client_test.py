"""Clients: requests and what arrives, over pipes, sockets, with a token and with TLS, waiting and in asyncio."""
import asyncio
import os
import pathlib
import subprocess
import tempfile
import tomllib
import unittest

import support
from galatea import AsyncClient, Client, Credentials, Ended, Message, Refused

TOKEN = "a secret of more than sixteen bytes"
LAMP = {"name": "LAMP", "command": support.LAMP}


class ClientTest(unittest.TestCase):
    def test_requests_are_answered_or_refused(self) -> None:
        with Client.start([support.program("lamp_module")]) as lamp:
            self.assertEqual(lamp.set("Lamp", "on"), "ON")
            self.assertEqual(lamp.inq("Lamp"), "ON")
            with self.assertRaises(Refused) as refused:
                lamp.set("Lamp", "PURPLE")
            self.assertEqual((refused.exception.code, refused.exception.column), ("BAD_VALUE", 1))
            with self.assertRaises(Refused) as refused:
                lamp.inq("Lam")
            self.assertIn("did you mean 'Lamp'?", refused.exception.text)

    def test_reports_are_kept_for_whoever_asks_for_them(self) -> None:
        with Client.start([support.program("lamp_module"), "--clock", "virtual"]) as lamp:
            lamp.set("Lamp", "ON 500")
            self.assertEqual(lamp.inq("Clock.mode"), "VIRTUAL")
            self.assertEqual(lamp.wait_for("Lamp", "OFF").value, "OFF")
            lamp.set("Lamp", "ON")
            self.assertEqual([str(message) for message in lamp.finish()], ["rep Lamp = ON"])

    def test_a_group_is_listed(self) -> None:
        with Client.start([support.program("fsm"), "--headless"]) as face:
            self.assertEqual(face.inq_group("Speak")["Speak.stat"], "IDLE")

    def test_more_than_two_pipes_hold_goes_both_ways(self) -> None:
        with Client.start([support.program("lamp_module")]) as lamp:
            for number in range(4000):
                lamp.send(f"inq#{number} Lamp.help")
            lamp.inq("Lamp")
            self.assertEqual(sum(message.slot == "Lamp.help" for message in lamp.messages(0)), 4000)

    def test_a_program_that_ends_is_noticed(self) -> None:
        with Client.start(["true"]) as nobody, self.assertRaises(Ended):
            nobody.inq("Run")

    def test_one_that_does_not_answer_times_out(self) -> None:
        with Client.start(["cat"]) as echo, self.assertRaises(TimeoutError):
            echo.inq("Run", timeout_s=0.05)

    def test_what_is_no_line_is_not_sent(self) -> None:
        with Client.start([support.program("lamp_module")]) as lamp:
            self.assertRaises(Refused, lamp.set, "Lamp", "ON\nset Run = EXIT")
            self.assertEqual(lamp.inq("Run"), "LIVE")


class AtTheHubTest(unittest.TestCase):
    def test_clients_hear_what_they_subscribed_to_and_are_reached_by_name(self) -> None:
        with support.hub(LAMP) as (place, *_), Client.connect(place, name="ONE") as one, Client.connect(place) as two:
            one.subscribe("LAMP")
            two.set("Lamp", "ON", to="LAMP")
            heard = one.wait_for("Lamp")
            self.assertEqual((heard.sender, heard.value), ("LAMP", "ON"))
            two.send(Message("tell", "", "hello"), to="ONE")
            self.assertEqual([message.value for message in one.messages(0.2) if message.command == "tell"], ["hello"])
            with self.assertRaises(Refused) as refused:
                two.inq("Run", to="NOBODY")
            self.assertEqual(refused.exception.code, "UNKNOWN_MODULE")

    def test_a_hub_that_ends_is_noticed(self) -> None:
        with support.hub() as (place, *_):
            client = Client.connect(place)
        with client, self.assertRaises(Ended):
            client.inq("Modules", to="AM")


class OtherMachinesTest(unittest.TestCase):
    """A hub that asks for a token, and one that shows and asks for certificates."""

    def setUp(self) -> None:
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.token = self.secret("token", TOKEN)

    def secret(self, name: str, text: str, mode: int = 0o600) -> str:
        path = self.folder / name
        path.write_text(text + "\nwhat follows is not read\n")
        path.chmod(mode)
        return str(path)

    def openssl(self, arguments: str) -> None:
        subprocess.run(["openssl", *arguments.split()], cwd=self.folder, check=True, capture_output=True)

    def certificates(self) -> dict[str, str]:
        """An authority, and one certificate by it, good for 127.0.0.1."""
        new = "-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes"
        self.openssl(f"req -x509 {new} -days 2 -subj /CN=ca -keyout ca.key -out ca.pem")
        self.openssl(f"req {new} -subj /CN=us -keyout us.key -out us.csr")
        (self.folder / "names").write_text("subjectAltName=IP:127.0.0.1\n")
        self.openssl("x509 -req -days 2 -in us.csr -CA ca.pem -CAkey ca.key -CAcreateserial -extfile names -out us.pem")
        return {name: str(self.folder / file) for name, file in
                (("certificate", "us.pem"), ("key", "us.key"), ("authority", "ca.pem"))}

    def test_who_knows_the_token_comes_in(self) -> None:
        with support.hub(LAMP, listen=[{"at": "tcp:127.0.0.1:0", "token_file": self.token}]) as (_, place):
            with Client.connect(place, token_file=self.token) as client:
                self.assertEqual(client.set("Lamp", "ON", to="LAMP"), "ON")
            with Client.start([*support.LAMP, "--connect", place, "--token-file", self.token, "--name", "TWO"]) as module:
                with Client.connect(place, token_file=self.token) as client:
                    client.subscribe("TWO")
                    while "TWO" not in client.inq("Modules", to="AM"):
                        pass
                    self.assertEqual(client.inq("Lamp", to="TWO"), "OFF")
                module._process.terminate()  # type: ignore[union-attr]

    def test_who_does_not_stays_outside(self) -> None:
        wrong = self.secret("wrong", "another secret of that length")
        with support.hub(listen=[{"at": "tcp:127.0.0.1:0", "token_file": self.token}]) as (unix, place):
            with self.assertRaisesRegex(Refused, "the token was refused"):
                Client.connect(place, token_file=wrong)
            with self.assertRaisesRegex(Refused, "the token was refused"):
                asyncio.run(AsyncClient.connect(place, token_file=wrong))

    def test_a_token_that_others_can_read_is_not_used(self) -> None:
        self.assertRaisesRegex(ValueError, "open to others", Credentials(self.secret("open", TOKEN, 0o644)).token)
        self.assertRaisesRegex(ValueError, "shorter than 16", Credentials(self.secret("short", "abc")).token)

    def test_tls_shows_certificates_both_ways_and_checks_them(self) -> None:
        shown = self.certificates()
        with support.hub(LAMP, listen=[{"at": "tls:127.0.0.1:0", "token_file": self.token, **shown}]) as (_, place):
            with Client.connect(place, token_file=self.token, **shown) as client:
                self.assertEqual(client.set("Lamp", "ON", to="LAMP"), "ON")

            async def the_same() -> str:
                async with await AsyncClient.connect(place, token_file=self.token, **shown) as client:
                    return await client.inq("Lamp", to="LAMP")
            self.assertEqual(asyncio.run(the_same()), "ON")
            self.assertRaises(OSError, Client.connect, place, token_file=self.token)  # its authority is not known to us


class AsyncClientTest(unittest.IsolatedAsyncioTestCase):
    async def test_many_requests_are_under_way_at_once(self) -> None:
        async with await AsyncClient.start([support.program("lamp_module")]) as lamp:
            names = ("Run", "Lamp", "Clock.mode", "Clock.busy")
            answers = await asyncio.gather(*(lamp.inq(name) for name in names))
            self.assertEqual((answers[0], answers[1], answers[3]), ("LIVE", "OFF", "IDLE"))
            with self.assertRaises(Refused):
                await lamp.set("Lamp", "PURPLE")

    async def test_what_arrives_is_an_iterator(self) -> None:
        with support.hub(LAMP) as (place, *_):
            async with await AsyncClient.connect(place, name="ME") as hub:
                await hub.subscribe("LAMP")
                await hub.set("Lamp", "ON 10", to="LAMP")
                heard = []
                async for message in hub.messages():
                    heard.append(str(message))
                    if message.value == "OFF":
                        break
                self.assertEqual(heard[-2:], ["From @LAMP rep Lamp = ON", "From @LAMP rep Lamp = OFF"])

    async def test_a_program_that_ends_is_noticed(self) -> None:
        async with await AsyncClient.start(["true"]) as nobody:
            with self.assertRaises(Ended):
                await nobody.inq("Run")


class PackageTest(unittest.TestCase):
    def test_its_version_is_the_toolkits(self) -> None:
        project = tomllib.loads((support.ROOT / "python" / "pyproject.toml").read_text())["project"]
        self.assertIn(f"project(galatea VERSION {project['version']} ", (support.ROOT / "CMakeLists.txt").read_text())

    def test_pip_installs_it_without_the_net(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            python = f"{folder}/venv/bin/python"
            try:
                subprocess.run(["python3", "-m", "venv", f"{folder}/venv"], check=True, capture_output=True)
            except (OSError, subprocess.CalledProcessError):
                self.skipTest("python3-venv is not installed")
            nowhere = {**os.environ, "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
            subprocess.run([python, "-m", "pip", "install", "-q", str(support.ROOT / "python")], check=True, env=nowhere)
            told = subprocess.run([python, "-c", "import galatea; print(galatea.__file__)"], cwd=folder, check=True,
                                  capture_output=True, text=True).stdout
            self.assertTrue(told.startswith(folder), told)
            self.assertTrue((pathlib.Path(told.strip()).parent / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
