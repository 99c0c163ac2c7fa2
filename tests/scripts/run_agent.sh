#!/usr/bin/env bash
# run_agent.sh as it is installed, beside programs that play their part: what it refuses, and that it never ends silently.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/prefix/bin" "$work/prefix/share/galatea"
bin=$work/prefix/bin
cp "$root/scripts/run_agent.sh" "$bin/galatea-agent"
cp -r "$root/examples" "$root/scripts" "$root/python" "$work/prefix/share/galatea/"
cd "$work"
unset DISPLAY WAYLAND_DISPLAY
wrong() {
  echo "$1; it said:" >&2
  cat "$work/said" >&2
  exit 1
}
program() { cat >"$bin/$1" && chmod +x "$bin/$1"; }

# The hub: its socket is there a second before it tells the address of its page, if it tells it.
program agent_manager <<'HUB'
#!/usr/bin/env python3
import os, signal, socket, sys, time
if "--version" in sys.argv:
    print("agent_manager (Galatea) 1.2.3")
    sys.exit()
def after(option): return sys.argv[sys.argv.index(option) + 1]
open("config_read", "w").write(after("--config"))
socket.socket(socket.AF_UNIX).bind(after("--listen").removeprefix("unix:"))
time.sleep(1)
if os.environ.get("HUB") == "dies":
    sys.exit("agent_manager: the port is taken")
print("agent_manager: the page is at http://127.0.0.1:1/?token=x", file=sys.stderr, flush=True)
if os.environ.get("HUB") != "ends":
    signal.pause()
HUB
printf '#!/bin/sh\nexit 1\n' | program srm
printf '#!/bin/sh\nexit 3\n' | program fsm

# ---- it waits for the address
timeout 20 "$bin/galatea-agent" --web >"$work/said" 2>&1 &
agent=$!
for _ in $(seq 100); do grep -q 'talk with it at http://127.0.0.1:1/?token=x' "$work/said" && break; sleep 0.1; done
grep -q 'talk with it at' "$work/said" || wrong "the address of a hub that tells it late is not waited for"
kill "$agent"
wait "$agent" 2>/dev/null || true
! HUB=dies timeout 20 "$bin/galatea-agent" --web >"$work/said" 2>&1 || wrong "a dead hub is no error"
grep -q 'the port is taken' "$work/said" || wrong "why the hub has ended is not said"
grep -q 'run_agent: the hub has not told the address of its page' "$work/said" || wrong "there is no error of its own"

# ---- a configuration of one's own is read where it lies, so that files it names are found
echo '{"modules": []}' >mine.json
HUB=dies timeout 20 "$bin/galatea-agent" --config mine.json --web >"$work/said" 2>&1 || true
[ "$(cat config_read)" = "$work/mine.json" ] || wrong "the hub read '$(cat config_read)' for mine.json"

# ---- any other step that fails is named
! timeout 20 "$bin/galatea-agent" --say hello --mask galatea --out film.mp4 >"$work/said" 2>&1 || wrong "a face that fails is no error"
grep -q 'run_agent: .*masks=' "$work/said" || wrong "it ended silently"

# ---- what cannot be done is refused at the start, in one line
refuses() { # LINE ARGUMENT...
  local ended=0
  timeout 20 "$bin/galatea-agent" "${@:2}" >"$work/said" 2>&1 || ended=$?
  [ "$ended" = 2 ] || wrong "${*:2}: ended with $ended"
  [ "$(cat "$work/said")" = "run_agent: $1" ] || wrong "${*:2}: expected one line, '$1'"
}
refuses "--say: the text is empty" --say ''
refuses "--say: the text is empty" --say '   '
mkdir folder.mp4
refuses "--out: '$work/folder.mp4' is a folder or a device; expected the name of a file" --say hello --out folder.mp4
refuses "--out: there is no folder '$work/nowhere'" --say hello --out nowhere/film.mp4
sides=$(sed -n 's/^inline constexpr int kMaxImageSide = \([0-9]*\);/\1/p' "$root/fsm/image/image.h")
for size in 9999x9999 15x480 640x$((sides + 1)) 99999999999999999999x480; do
  refuses "--size '$size': the face (fsm) is 16 to $sides pixels wide and high" --say hello --size "$size"
done
refuses "--size 'large': expected WIDTHxHEIGHT, such as 640x480" --say hello --size large
refuses "--model-url http://localhost:8080/v1: this agent's own page is at that port; --web PORT takes another" \
  --web --chat --model-url http://localhost:8080/v1 --model any
printf '\211PNG\0\1\2' >me.jpg
refuses "--dialog: '$work/me.jpg' is no VoiceXML document: it has no element <vxml>" --dialog me.jpg
refuses "--dialog: cannot read '$work/folder.mp4'" --dialog folder.mp4
refuses "unknown option '--keep'; --help lists them" --keep
program vdm <<'VDM'
#!/bin/sh
echo "vdm: error: UNAVAILABLE there is no microphone (in: set Input = portaudio)" >&2
VDM
refuses "--voice mic: there is no microphone" --voice mic

# ---- a dialogue that cannot be loaded says so itself; what the hub says is no part of it
printf '#!/bin/sh\necho "(error.badfetch: broken)"\nexit 2\n' | program task_manager
! timeout 20 "$bin/galatea-agent" --dialog "$root/examples/dialogs/food_en.vxml" >"$work/said" 2>&1 || wrong "no error"
! grep -q 'the page is at' "$work/said" || wrong "the hub's log is shown"

# ---- as every program
"$bin/galatea-agent" --help | grep -q '^usage: ' || wrong "--help fails"
[ "$("$bin/galatea-agent" --version)" = "galatea-agent (Galatea) 1.2.3" ] || wrong "--version fails"
version=$(sed -n 's/^project(galatea VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
[ "$("$root/scripts/run_agent.sh" --version)" = "run_agent (Galatea) $version" ] || wrong "--version fails in the source tree"

# ---- a dialogue in the browser waits for the page, which can start it again
timeout 20 "$bin/galatea-agent" --web --dialog "$root/examples/dialogs/food_en.vxml" </dev/null >"$work/said" 2>&1 &
agent=$!
for _ in $(seq 100); do grep -q '\^C ends it' "$work/said" && break; sleep 0.1; done
grep -q 'the dialogue begins when the page is open' "$work/said" || wrong "a dialogue in the browser does not wait for the page"
! grep -q 'badfetch' "$work/said" || wrong "the dialogue has begun before a page was open"
kill "$agent"
wait "$agent" 2>/dev/null || true
