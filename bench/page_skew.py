#!/usr/bin/env python3
"""How far sound and picture of the hub's page are apart, in a headless Chromium:  bench/page_skew.py URL [UTTERANCES]

URL is the address a running hub prints, with its token. Both streams bear the session's time. Of each picture the page
notes when it was put on the canvas; the sound is tapped beside the loudspeaker, and the first loud sample of each
utterance is found in it and in what the voice sent. Its place in the tap is known by a click at a known time of the audio
clock, which the browser relates to the page's clock (getOutputTimestamp, the latency of its output included). The skew of
an utterance is how much later than its session's time it was heard, less the same of the pictures within a second around
it; positive: the sound is late. What a screen and a loudspeaker add beyond the browser is not in it.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
url, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 10
with tempfile.TemporaryDirectory() as profile, tempfile.NamedTemporaryFile("w", suffix=".js") as script:
    script.write(f"window.kUtterances = {count};\n" + (here / "page_skew.js").read_text())
    script.flush()
    said = subprocess.run(
        ["python3", str(here.parent / "tests/support/browse.py"), "chromium", profile, url,
         "--autoplay-policy=no-user-gesture-required", "limit:" + str(60 + 6 * count), "wait:document.querySelector('#link.on')",
         "wait:galatea.clock.known && document.querySelector('#face').width > 16", f"script:{script.name}", "wait:window.skew",
         "print:JSON.stringify(window.skew)"], stdout=subprocess.PIPE, text=True, check=True).stdout
skew = json.loads(said)
if "error" in skew:
    sys.exit(skew["error"])
median = lambda numbers: sorted(numbers)[len(numbers) // 2]
skews, sounds, lates = [], [], []
for begin in skew["begins"]:
    heard = [onset for onset in skew["onsets"] if abs(onset - begin - skew["delay"]) < 500]
    shown = [drawn - at for at, drawn in skew["pictures"] if abs(at - begin) < 1000]
    if not heard or not shown:
        print(f"an utterance was not found (heard {len(heard)}, pictures {len(shown)})")
        continue
    sounds.append(heard[0] - begin)
    lates.append(median(shown))
    skews.append(heard[0] - begin - median(shown))
print(f"{len(skews)} utterances, {skew['per_second']:.1f} pictures a second, delay {skew['delay']:.0f} ms")
print(f"sound {median(sounds):.1f} ms after its time, pictures {median(lates):.1f} ms")
print("skew: median %.1f ms, from %.1f to %.1f ms" % (median(skews), min(skews), max(skews)))
