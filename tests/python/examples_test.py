"""The examples, run as they say."""
import os
import shutil
import subprocess
import sys
import unittest

import support


def run(*command: str) -> tuple[list[str], list[str]]:
    """What an example prints, and the files it wrote."""
    with support.workspace() as root:
        environment = {**os.environ, "PYTHONPATH": "python"}
        done = subprocess.run([sys.executable, *command], cwd=root, env=environment, capture_output=True, text=True,
                              timeout=120, check=False)
        if done.returncode:
            raise AssertionError(done.stderr)
        return done.stdout.splitlines(), [path.name for path in root.glob("*.mp4") if path.stat().st_size > 10_000]


class ExamplesTest(unittest.TestCase):
    def setUp(self) -> None:
        for name in ("agent_manager", "ssm", "ssm_stub", "fsm", "srm_stub"):
            support.program(name)

    def test_an_agent_says_something_into_a_film(self) -> None:
        if not shutil.which("ffmpeg"):
            self.skipTest("ffmpeg is not installed")
        said, films = run("examples/python/say.py", "Hello from Python.", "hello.mp4")
        self.assertRegex(said[0], r"^phonemes: pau\[\d+\] hh\[\d+\] ")
        self.assertRegex(said[1], r"^it took 1\d\d\d ms$")
        self.assertEqual(films, ["hello.mp4"])

    def test_the_face_is_followed(self) -> None:
        said, _ = run("examples/python/follow_face.py")
        self.assertEqual(said, ["rep Run = LIVE", "rep FaceExp = HAPPY 1 100 1500", "rep Speak.stat = PROCESSING",
                                "rep Speak.stat = READY", "rep Speak.stat = SPEAKING", "rep Speak.stat = IDLE"])

    def test_the_face_alone_makes_a_film(self) -> None:
        if not shutil.which("ffmpeg"):
            self.skipTest("ffmpeg is not installed")
        said, films = run("examples/python/film.py", "film.mp4")
        self.assertEqual((said, films), (["film: STOP"], ["film.mp4"]))

    def test_the_tutorial_prints_what_it_shows(self) -> None:
        if not shutil.which("ffmpeg"):
            self.skipTest("ffmpeg is not installed")
        said, films = run("examples/python/tutorial.py")
        shown = [line.removeprefix("#> ") for line in (support.ROOT / "examples/python/tutorial.py").read_text().splitlines()
                 if line.startswith("#> ")]
        self.assertGreater(len(shown), 20)
        self.assertEqual((said, films), (shown, ["tutorial.mp4"]))

    def test_the_ear_is_heard(self) -> None:
        said, _ = run("examples/python/listen.py", "good morning", "what is that")
        self.assertEqual([line for line in said if "Result = " in line or "NoMatch" in line],
                         ["rep Result = good morning", "rep NoMatch = what is that"])


if __name__ == "__main__":
    unittest.main()
