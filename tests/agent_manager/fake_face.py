# A face of 16 x 16 pixels, all red: answers what the page's video asks, and writes raw frames; after
# `set Frames = OFF` it only says so.
import sys
import threading

WIDTH, HEIGHT = 16, 16
FRAME = bytes([255, 0, 0, 255]) * (WIDTH * HEIGHT)
recording = threading.Event()


def write_frames(path):
    try:
        with open(path, "wb", buffering=0) as pipe:
            while recording.is_set():
                if values["Frames"] == "ON":
                    pipe.write(FRAME)
                recording_changed.wait(0.02)
    except BrokenPipeError:
        pass


recording_changed = threading.Event()
values = {"Window": f"{WIDTH} {HEIGHT}", "Record": "STOP", "Record.fps": "30", "Run": "LIVE", "Frames": "ON",
          "MaskSet": "galatea,pygmalion", "NowMask": "galatea"}
for line in sys.stdin:
    words = line.rstrip("\n").split(" ", 3)
    command, _, tag = words[0].partition("#")
    slot = words[1] if len(words) > 1 else ""
    value = words[3] if len(words) > 3 else ""
    if command == "set" and slot == "Run":
        recording.clear()
        recording_changed.set()
        break
    if command == "set":
        values[slot] = value
        if slot == "Mask":
            values["NowMask"] = value
            print("tell wears " + value, flush=True)
        if slot == "Record" and value != "STOP":
            recording.set()
            threading.Thread(target=write_frames, args=(value,), daemon=True).start()
        elif slot == "Record":
            recording.clear()
            print("tell recording stopped", flush=True)
    if tag and slot in values:
        print(f"rep#{tag} {slot} = {values[slot]}", flush=True)
    elif tag:
        print(f"rep#{tag} {slot}.error = UNKNOWN_SLOT no such slot", flush=True)
