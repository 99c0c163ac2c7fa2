"""OpenAI's own Python client against the gateway's speech and the stand-in for a model:

    python3 openai_client.py http://HOST:PORT TOKEN http://HOST:PORT-OF-THE-STAND-IN
"""
import asyncio
import base64
import sys

import openai

gateway, token, model = sys.argv[1:]
client = openai.OpenAI(base_url=gateway + "/v1", api_key=token, max_retries=0)
INPUT = "Good morning. My name is Galatea."


def speech(**more):
    return client.audio.speech.create(**{"model": "any", "voice": "slt", "input": INPUT} | more)


def refused(kind, words, call):
    try:
        call()
    except kind as error:
        assert words in str(error), error
        return
    raise AssertionError(f"{kind.__name__} with '{words}' expected")


wav = speech(response_format="wav")
assert wav.response.headers["content-type"] == "audio/wav"
assert wav.content[:4] == b"RIFF"
pcm = speech(response_format="pcm").content
assert abs(len(pcm) - (len(wav.content) - 44) * 1.5) <= 4, "24 kHz"
for name, begin in (("mp3", b""), ("opus", b"OggS"), ("flac", b"fLaC"), ("aac", b"")):
    sound = speech(response_format=name).content
    assert len(sound) > 1000 and sound.startswith(begin), name
assert len(speech().content) > 1000
assert len(speech(response_format="wav", speed=2).content) < 0.7 * len(wav.content)

# As a stream, piece by piece.
with client.audio.speech.with_streaming_response.create(model="any", voice="slt", input=INPUT,
                                                        response_format="pcm") as streamed:
    assert sum(map(len, streamed.iter_bytes(4096))) == len(pcm)  # flite's noise goes on from text to text

# Our addition, by the client's way for what it does not know.
seen = client.post("/audio/speech", cast_to=object, body={
    "model": "any", "voice": "slt", "input": INPUT, "response_format": "wav", "visemes": "oculus15", "fps": 25})
assert len(seen["names"]) == 15
assert abs(len(seen["frames"]) - seen["duration"] * 25) <= 2
assert len(base64.b64decode(seen["audio"])) == len(wav.content)

# Mistakes are the client's own classes, with our words.
refused(openai.BadRequestError, "nobody", lambda: speech(voice="nobody"))
refused(openai.APIStatusError, "8192", lambda: speech(input="x" * 9000))
refused(openai.BadRequestError, "response_format", lambda: speech(response_format="ogg"))
stranger = openai.OpenAI(base_url=gateway + "/v1", api_key="wrong-wrong-wrong", max_retries=0)
refused(openai.AuthenticationError, "token", lambda: stranger.audio.speech.create(model="any", voice="slt", input=INPUT))

# The stand-in that tests of chat answer by is read as a model's answer is.
question = {"model": "echo", "stream": True, "messages": [{"role": "user", "content": "hello"}]}
talk = openai.OpenAI(base_url=model + "/v1", api_key="any", max_retries=0)
choices = [chunk.choices[0] for chunk in talk.chat.completions.create(**question) if chunk.choices]
assert "hello" in "".join(choice.delta.content or "" for choice in choices)
assert choices[-1].finish_reason == "stop"


async def eight_at_a_time():
    many = openai.AsyncOpenAI(base_url=gateway + "/v1", api_key=token, max_retries=0)
    sounds = await asyncio.gather(*(many.audio.speech.create(model="any", voice="slt", input=INPUT, response_format="wav")
                                    for _ in range(8)))
    assert all(len(sound.content) == len(wav.content) for sound in sounds)

asyncio.run(eight_at_a_time())
print(f"openai for Python {openai.__version__}: ok")
