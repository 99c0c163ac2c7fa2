#!/usr/bin/env python3
"""Drives a headless Chromium: browse.py BROWSER PROFILE URL STEP...

A step is  wait:EXPRESSION  (until it is true in the page, at most 30 s, or what  limit:SECONDS  said before),  do:EXPRESSION,
print:EXPRESSION,  picture:FILE.png,  size:WIDTHxHEIGHT,  scheme:light or dark,  script:FILE.js,  press:KEY  or
--FLAG  for the browser.  Ends with 1 and a sentence if a wait runs out.
Speaks the DevTools protocol over the browser's pipe: JSON texts ended by a zero byte.
"""
import base64
import json
import os
import subprocess
import sys
import time

LIMIT_S = 30


class Browser:
    def __init__(self, program, profile, flags):
        to_read, self.out = os.pipe()
        self.inp, to_write = os.pipe()
        # The browser reads descriptor 3 and writes descriptor 4, whatever ours are called.
        script = f'exec 3<&{to_read} 4>&{to_write}; exec "$0" "$@"'
        self.process = subprocess.Popen(
            ["bash", "-c", script, program, "--headless", "--no-sandbox", "--disable-gpu",
             "--remote-debugging-pipe", "--window-size=1280,1100", f"--user-data-dir={profile}", *flags],
            pass_fds=(to_read, to_write), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.buffer, self.last, self.session = b"", 0, None

    def call(self, method, **params):
        answer = self.ask(method, **params)
        if "error" in answer:
            sys.exit(f"browse: {method}: {answer['error']['message']}")
        return answer["result"]

    def ask(self, method, **params):
        self.last += 1
        message = {"id": self.last, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.buffer:
                more = os.read(self.inp, 1 << 16)
                if not more:
                    sys.exit("browse: the browser has gone")
                self.buffer += more
            text, self.buffer = self.buffer.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("id") == self.last:
                return answer

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            return None
        return result["result"].get("value")

    def is_true(self, expression):
        """False, too, while the page that was asked makes way for the next one."""
        answer = self.ask("Runtime.evaluate", expression=f"Boolean({expression})", returnByValue=True,
                          awaitPromise=True)
        return answer.get("result", {}).get("result", {}).get("value") is True


def main():
    program, profile, url, *steps = sys.argv[1:]
    limit_s = LIMIT_S
    browser = Browser(program, profile, [step for step in steps if step.startswith("--")])
    try:
        target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        browser.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        browser.call("Page.enable")
        browser.call("Page.navigate", url=url)
        for step in steps:
            kind, _, text = step.partition(":")
            if kind == "wait":
                limit = time.monotonic() + limit_s
                while not browser.is_true(text):
                    if time.monotonic() > limit:
                        sys.exit(f"browse: never true: {text}\n" +
                                 str(browser.evaluate("document.body && document.body.innerText"))[:3000])
                    time.sleep(0.05)
            elif kind == "limit":
                limit_s = float(text)
            elif kind == "do":
                browser.evaluate(text)
            elif kind == "print":
                print(browser.evaluate(text))
            elif kind == "size":
                width, height = map(int, text.split("x"))
                browser.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                             mobile=width < 600)
            elif kind == "scheme":
                browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": text}])
            elif kind == "script":
                with open(text, encoding="utf-8") as file:
                    browser.evaluate(file.read())
            elif kind == "press":
                for type in ("keyDown", "keyUp"):
                    browser.call("Input.dispatchKeyEvent", type=type, key=text, code=text)
            elif kind == "picture":
                shot = browser.call("Page.captureScreenshot", format="png")
                with open(text, "wb") as file:
                    file.write(base64.b64decode(shot["data"]))
    finally:
        browser.process.kill()
        browser.process.wait()


main()
