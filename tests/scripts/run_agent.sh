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
import os, signal, socket, sys, re, time
if "--version" in sys.argv:
    print("agent_manager (Galatea) 1.2.3")
    sys.exit()
text = open(sys.argv[sys.argv.index("--config") + 1]).read()
socket.socket(socket.AF_UNIX).bind(re.search('unix:([^"]*)', text)[1])
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

# ---- any other step that fails is named
! timeout 20 "$bin/galatea-agent" --say hello --mask galatea --out film.mp4 >"$work/said" 2>&1 || wrong "a face that fails is no error"
grep -q 'run_agent: .*masks=' "$work/said" || wrong "it ended silently"
