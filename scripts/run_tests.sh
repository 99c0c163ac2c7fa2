#!/usr/bin/env bash
# Runs the tests of a build and says at the end how many were skipped, what they need, and what those that failed said last;
# ends as ctest does:  scripts/run_tests.sh BUILD_FOLDER [ctest options...]
set -euo pipefail
build=$(cd "$1" && pwd)
shift
report=$build/Testing/report.xml
rm -f "$report"
status=0
# One more at a time than there are processors, since many tests wait for clocks.
ctest --test-dir "$build" --output-on-failure --parallel "$(($(nproc) + 1))" --output-junit "$report" \
  --test-output-size-passed 100000 "$@" || status=$?
[ ! -f "$report" ] || python3 - "$report" <<'PY'
import collections, re, sys
import xml.etree.ElementTree as xml

needs = collections.Counter()
failed = []
for test in xml.parse(sys.argv[1]).iter("testcase"):
    said = test.findtext("system-out") or ""
    if test.get("status") == "fail":
        failed.append((test.get("name"), said.strip().splitlines()[-20:]))
    # A GoogleTest says why after "FILE:LINE: Skipped", a script is skipped by its exit status.
    reasons = re.findall(r"^\S+:\d+: Skipped\n(.*)", said, re.MULTILINE)
    if not reasons and test.find("skipped") is not None:
        reasons = said.strip().splitlines()[-1:] or ["no reason given"]
    needs.update(reason.strip() or "no reason given" for reason in reasons)
if needs:
    listed = "; ".join(f"{count}: {reason}" for reason, count in needs.most_common())
    print(f"tests: {sum(needs.values())} skipped: {listed}", file=sys.stderr)
# Once more at the end, since a log may be cut before it.
for name, lines in failed[:10]:
    print(f"tests: {name} failed; its last lines:", *lines, sep="\n  ", file=sys.stderr)
PY
exit "$status"
