"""Modules: what a class declares, how it answers, and that it goes with the hub's clock."""
import unittest
import unittest.mock
from typing import Any

import support
from galatea import WRITE_ONLY, Module, Refused, Slot
from galatea.client import Client

# Everything that can be said to a module of one slot; what lamp_module answers is what ours has to answer.
CONVERSATION = """
set Lamp = ON
set#1 lamp = ON
set#1 Lamp = on 300
set Lamp << 400
set#2 Lamp =  OFF\t
inq Lamp
inq#3 Lamp.help
inq#3 Lamp.prop
inq#3 Lamp.nothing
inq#3 Slots
inq#3 Slots.files
inq#3 Error
prop#4 Lamp = NoAutoOutput
set Lamp = OFF
prop#4 Lamp = Loud
prop Error = AutoOutput
set Lamp = PURPLE
bogus
set#5 Slots = x
def#6 Mine = hello
def#6 Mine = hello again
inq#6 Mine
set#6 Mine << and more
inq#6 Mine.help
def#6 Lamp = x
del#6 Lamp
save#7 one
save#7 two = Mine Lamp
save#7 three = Slots
set Mine = other
rest#7 two
inq#7 Mine
rest#7 nothing
def#8 Blink << set Lamp = ON
def#8 Blink << set#inner Lamp = OFF
def#8 Blink << nonsense line
do#8 Blink
def#8 Loop << do Loop
do#8 Loop
del#8 Blink
del#8 Blink
do#8 no/such/file
set#9 Mine < no/such/file
def#9 Nothing
inq#9 Clock.mode
set#9 Clock = 5
set#9 Wait = 250
inq#9 Clock
set#9 Run = SLEEP
set#9 Run = INIT
inq#9 Wait
set#9 Wait = IDLE
inq#9 Clock.busy
rep Lamp = ON
tell something
set#10 Clock.mode = HUB
set#10 Lamp = ON 100
set#10 Clock = 50
set#10 Clock = 100
set#10 Clock.mode = VIRTUAL
set Lamp = ON 5000
set#11 Run = EXIT
inq Clock
"""


class Door(Module):
    """A door that takes its time."""

    name = "DOOR"
    opens_ms = Slot(int, "<int 0..10000>", name="Opens", initial=200, help="How long it takes to open, in ms.")
    share = Slot(float, "<number 0..1>", name="Share", auto_output=True)
    locked = Slot(bool, initial=False)
    open = Slot(str, "NOW | STOP", name="Open", access=WRITE_ONLY)
    fails = Slot(str, "<text>", name="Fails")
    opening: Any = None

    @open.on_set
    async def begin(self, word: str) -> str:
        if word == "STOP":
            if self.opening:
                self.opening.cancel()
            return "stopped"
        if self.locked:
            raise Refused("BUSY", "it is locked")
        self.opening = self.current_task()
        for part in range(1, 5):
            await self.sleep(self.opens_ms / 4)
            self.share = part / 4
        self.tell("open")
        return "open"

    @fails.on_set
    def fail(self, text: str) -> str:
        raise KeyError(text)


class InMemory:
    """A door that is told lines, and what it said."""

    def __init__(self) -> None:
        self.door = Door()
        self.said: list[str] = []
        self.door.output = lambda message: self.said.append(str(message))

    def say(self, line: str) -> list[str]:
        self.said.clear()
        self.door.slots.handle_line(line)
        return list(self.said)


class ModuleTest(unittest.TestCase):
    def test_a_module_in_python_answers_as_one_in_cpp(self) -> None:
        theirs, their_complaints = support.piped([support.program("lamp_module")], CONVERSATION)
        ours, our_complaints = support.piped(support.LAMP, CONVERSATION)
        self.assertEqual(ours, theirs)
        self.assertEqual(our_complaints, their_complaints)

    def test_the_table_of_slots_is_that_of_the_module_in_cpp(self) -> None:
        tables = [support.piped([*command, "--slots-markdown"], "")[0] for command in ([support.program("lamp_module")], support.LAMP)]
        self.assertEqual(tables[0], tables[1])

    def test_slots_have_the_types_of_their_declaration(self) -> None:
        world = InMemory()
        self.assertEqual((world.door.opens_ms, world.door.share, world.door.locked), (200, 0.0, False))
        self.assertEqual(world.say("set#1 Opens = 80"), ["rep#1 Opens = 80"])
        self.assertEqual(world.door.opens_ms, 80)
        self.assertEqual(world.say("set#1 locked = on"), ["rep#1 locked = on"])
        self.assertIs(world.door.locked, True)
        world.door.share = 0.5
        world.door.locked = False
        self.assertEqual(world.said[-1], "rep Share = 0.5")
        self.assertEqual(world.say("inq locked"), ["rep locked = OFF"])

    def test_a_coroutine_lives_on_the_modules_clock_and_answers_when_it_ends(self) -> None:
        world = InMemory()
        self.assertEqual(world.say("set#1 Open = NOW"), [])
        self.assertTrue(world.door.busy())
        world.door.clock.advance(100)
        self.assertEqual(world.said, ["rep Share = 0.25", "rep Share = 0.5"])
        self.assertEqual(world.door.clock_text(), "100 150 BUSY")
        world.door.clock.advance(200)
        self.assertEqual(world.said[-3:], ["rep Share = 1", "tell open", "rep#1 Open = open"])
        self.assertEqual(world.door.clock_text(), "200 - IDLE")

    def test_a_cancelled_coroutine_answers_that_it_was_stopped(self) -> None:
        world = InMemory()
        world.say("set#1 Open = NOW")
        self.assertEqual(world.say("set#2 Open = STOP"),
                         ["rep#1 Open.error = STOPPED stopped on request", "rep#2 Open = stopped"])
        world.door.clock.advance(1000)
        self.assertEqual(world.said[2:], [])

    def test_what_a_handler_refuses_is_told_and_what_it_throws_is_its_own_fault(self) -> None:
        world = InMemory()
        world.door.locked = True
        self.assertEqual(world.say("set#1 Open = NOW"), ["rep#1 Open.error = BUSY it is locked"])
        with unittest.mock.patch("traceback.print_exception"):
            self.assertEqual(world.say("set#1 Fails = x"), ["rep#1 Fails.error = INTERNAL KeyError: 'x'"])

    def test_a_module_asks_another_and_hears_the_answer(self) -> None:
        world = InMemory()
        heard: list[Any] = []

        async def ask() -> None:
            heard.append(await world.door.inq("Speaker", to="SSM"))
            try:
                await world.door.set("Rate", 9000, to="SSM")
            except Refused as refusal:
                heard.append(str(refusal))
        world.door.start(ask())
        self.assertEqual(world.said, ["to @SSM inq#m1 Speaker"])
        self.assertEqual(world.say("From @SSM rep#m1 Speaker = slt"), ["to @SSM set#m2 Rate = 9000"])
        world.say("From @SSM rep#m2 Rate.error = BAD_VALUE column 1: too fast")
        self.assertEqual(heard, ["slt", "BAD_VALUE column 1: too fast"])


class AtTheHubTest(unittest.TestCase):
    LAMP = {"name": "LAMP", "command": support.LAMP}

    def test_on_the_virtual_clock_ten_seconds_take_no_time_and_are_exact(self) -> None:
        with support.hub(self.LAMP, clock="virtual") as (place, *_), Client.connect(place) as hub:
            hub.subscribe("LAMP")
            began = hub.inq("Clock", to="AM")
            hub.set("Lamp", "ON 10000", to="LAMP")
            hub.wait_for("Lamp", "OFF", sender="LAMP", timeout_s=20)
            self.assertEqual(float(hub.inq("Clock", to="LAMP")) - float(began), 10000)

    def test_a_module_may_come_to_the_hub_over_a_socket(self) -> None:
        with support.hub() as (place, *_), Client.connect(place) as hub:
            with Client.start([*support.LAMP, "--connect", place, "--name", "LIGHT"]) as module:
                hub.subscribe("LIGHT")
                hub.wait_for("Run", "LIVE", sender="LIGHT")
                self.assertEqual(hub.set("Lamp", "ON", to="LIGHT"), "ON")
                hub.set("Run", "EXIT", to="LIGHT")
                self.assertEqual(list(module.messages()), [])

    def test_it_ends_with_its_input_once_nothing_is_going_on(self) -> None:
        said, _ = support.piped(support.LAMP, "set Lamp = ON 400")
        self.assertEqual(said, ["rep Run = LIVE", "rep Lamp = ON", "rep Lamp = OFF"])


if __name__ == "__main__":
    unittest.main()
