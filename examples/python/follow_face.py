"""Follows what the face does, in asyncio:  python3 examples/python/follow_face.py

What it prints are the lines that arrive: reports of the slots that were asked for, and what the face tells.
"""
import asyncio

from galatea import AsyncClient


async def follow(face: AsyncClient) -> None:
    async for message in face.messages():
        print(message)


async def main() -> None:
    # --clock virtual: what takes two seconds is over at once.
    async with await AsyncClient.start(["build/bin/fsm", "--headless", "--clock", "virtual"]) as face:
        following = asyncio.create_task(follow(face))
        for slot in ("FaceExp", "Speak.stat"):
            await face.auto_output(slot)
        await face.set("FaceExp", "HAPPY 1 100 1500")
        await face.set("LipSync.pho", "pau 100 hh 60 ax 60 l 70 ow 240 pau 200")
        await face.set("Speak", "NOW")
        await face.set("Wait", "IDLE")  # until expression and speech are over
    await following


asyncio.run(main())
