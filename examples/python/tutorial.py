# %% [markdown]
# # An agent, from Python
#
# Cells begin with `# %%`: editors (VS Code, Spyder, PyCharm, Jupyter by jupytext) run them one by one. Run whole, in the root of
# the toolkit after `scripts/build.sh --programs`:
#
#     PYTHONPATH=python python3 examples/python/tutorial.py
#
# What a cell prints stands behind it, after `#>`; a test compares.

# %% One program alone
# Every program of the toolkit is a set of slots. `set` gives one a value, `inq` asks for it. ssm_stub is the voice without sound.
from galatea import Client, Clock, Module, Refused, Slot, parse, parse_phonemes, set_

with Client.start(["build/bin/ssm_stub"]) as voice:
    print(voice.inq("Speaker"))
    voice.set("Text", "Good morning.")
    phonemes = parse_phonemes(voice.inq("Text.pho"))
    print(phonemes[:3])
    print(sum(phoneme.ms for phoneme in phonemes), "ms")
#> slt
#> [Phoneme(name='pau', ms=100), Phoneme(name='g', ms=50), Phoneme(name='uh', ms=80)]
#> 1180 ms

# %% What does not fit is refused
# with a code, the place in the value, and what was expected.
with Client.start(["build/bin/ssm_stub"]) as voice:
    for slot, value in (("Volume", "loud"), ("Volumn", "50")):
        try:
            voice.set(slot, value)
        except Refused as refusal:
            print(refusal)
    print(voice.inq("Volume.help"))
#> BAD_VALUE column 1: found 'loud', expected <number 0..4>
#> UNKNOWN_SLOT module SSM has no slot 'Volumn', did you mean 'Volume'?
#> Loudness from the next Text on, as a factor of the amplitude; samples beyond 16 bit are cut. Value: <number 0..4>

# %% A face
# On the virtual clock `Wait` is exact, and takes no longer than drawing does.
with Client.start(["build/bin/fsm", "--headless", "--clock", "virtual"]) as face:
    face.set("FaceExp", "HAPPY 1 100 0")
    face.set("Wait", 1000)
    print(face.set("SaveImage", "happy.png"))
    face.auto_output("Mask")
    face.set("Mask", "pygmalion")
    print(face.wait_for("Mask"))
#> happy.png
#> rep Mask = pygmalion

# %% An agent
# The hub starts voice, ear and face and carries lines between them; `to` says whose slot it is. `@AM-MCL` is a part of the hub that
# keeps voice and face together. Its answer to `Speak` comes when all has been said.
with Client.start(["build/bin/agent_manager", "--config", "examples/agents/film.json"]) as agent:
    agent.subscribe("SSM")
    agent.set("Record", "tutorial.mp4", to="AM-MCL")
    agent.set("Emotion", "HAPPY 80", to="AM-MCL")
    agent.set("FaceMot", "NOD 1", to="FSM")
    print(agent.set("Speak", "Hello from Python.", to="AM-MCL"))
    print(agent.set("Record", "STOP", to="AM-MCL"))
    for message in agent.messages(0):
        if message.slot.startswith("Speak.stat"):
            print(message)
#> Hello from Python.
#> STOP
#> From @SSM rep Speak.stat = PROCESSING
#> From @SSM rep Speak.stat = READY
#> From @SSM rep Speak.stat = SPEAKING
#> From @SSM rep Speak.stat = IDLE


# %% A module of your own
# A class with slots. Here it lives in this process on a clock that we move, which is how modules are tested; `Timer.main()` makes a
# program of it (docs/tutorial/python_module.md).
class Timer(Module):
    """A kitchen timer."""

    name = "TIMER"
    seconds = Slot(int, "<int 0..3600>", name="Timer", initial=0, auto_output=True, help="Seconds until it rings.")

    @seconds.on_set
    def start(self, seconds: int) -> None:
        if seconds:
            self.after(1000, self.tick)

    def tick(self) -> None:
        self.seconds -= 1
        if self.seconds:
            self.after(1000, self.tick)
        else:
            self.say(set_("Speak", "Your tea is ready."), to="AM-MCL")


timer = Timer(Clock("VIRTUAL"))
timer.output = print  # what it says
timer.slots.handle_line("set#1 Timer = 2")
timer.clock.advance(2000)
timer.slots.handle_line("set#2 Timer = never")
#> rep Timer = 2
#> rep#1 Timer = 2
#> rep Timer = 1
#> rep Timer = 0
#> to @AM-MCL set Speak = Your tea is ready.
#> rep#2 Timer.error = BAD_VALUE column 1: found 'never', expected <int 0..3600>

# %% Lines
# What goes over the wire is text; `parse` takes a line apart, `str` writes it.
message = parse("From @SSM rep#1 Speak.stat = READY")
print(message.sender, message.slot, message.value)
print(set_("Speak", "Hello.").addressed("AM-MCL"))
#> SSM Speak.stat READY
#> to @AM-MCL set Speak = Hello.
