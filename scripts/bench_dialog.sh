#!/usr/bin/env bash
# Measures task_manager on the text platform:  scripts/bench_dialog.sh [BIN FOLDER, default build/bin]
# Cold start to the first prompt, turns per second, sessions at once and memory per session.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=${1:-build/bin}
turns=20000
sessions=200
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/hello.vxml" <<'XML'
<vxml version="2.1" xmlns="http://www.w3.org/2001/vxml"><form><block>hello</block></form></vxml>
XML
cat >"$work/turns.vxml" <<'XML'
<vxml version="2.1" xmlns="http://www.w3.org/2001/vxml" xml:lang="en-US">
<form><field name="place"><prompt>Tokyo or Kyoto?</prompt>
<grammar root="r"><rule id="r"><item repeat="0-1">to</item><one-of><item>tokyo</item><item>kyoto</item></one-of></rule></grammar>
<filled><prompt><value expr="place"/></prompt><clear namelist="place"/></filled></field></form></vxml>
XML
printf "say to kyoto\n%.0s" $(seq $turns) >"$work/turns.txt"
printf "say tokyo\n%.0s" $(seq 50) >"$work/few.txt"

now() { date +%s%N; }
best=999999
for _ in 1 2 3 4 5 6 7 8 9 10; do
  begin=$(now)
  "$bin/task_manager" "$work/hello.vxml" --script /dev/null --transcript text >/dev/null || true
  took=$((($(now) - begin) / 1000))
  if [ "$took" -lt "$best" ]; then best=$took; fi
done
echo "cold start to the end of a one-prompt dialogue: $((best / 1000)).$(printf %03d $((best % 1000))) ms"

begin=$(now)
"$bin/task_manager" "$work/turns.vxml" --script "$work/turns.txt" --transcript none || true
took=$((($(now) - begin) / 1000000))
echo "turns per second, one session: $((turns * 1000 / took))"

begin=$(now)
"$bin/task_manager" "$work/turns.vxml" --script "$work/few.txt" --sessions $sessions --transcript none || true
took=$((($(now) - begin) / 1000000))
echo "turns per second, $sessions sessions: $((sessions * 50 * 1000 / took))"

# What sessions that wait for their users take, a process each; pages they share count in parts.
memory_kib() {  # of a process and its children
  local all=0 each kib
  for each in "$1" $(cat "/proc/$1/task/$1/children"); do
    kib=$(awk '/^Pss:/ {print $2}' "/proc/$each/smaps_rollup")
    all=$((all + kib))
  done
  echo "$all"
}
mkfifo "$work/typed"
"$bin/task_manager" "$work/turns.vxml" <"$work/typed" >"$work/said" &
process=$!
exec 3>"$work/typed"
echo "to kyoto" >&3
read -r -t 2 <> <(:) || true
echo "memory of one session and the process that watches it: $(memory_kib "$process") KiB"
exec 3>&-
wait "$process" || true

cat >"$work/hub.json" <<JSON
{"listen": [{"role": "owner", "at": "unix:$work/hub"}],
 "modules": [{"name": "SSM", "command": ["$bin/ssm_stub"]}, {"name": "SRM", "command": ["$bin/srm_stub"]}]}
JSON
"$bin/agent_manager" --config "$work/hub.json" </dev/zero >"$work/hub.log" 2>&1 &
hub=$!
trap 'kill "$hub" 2>/dev/null; rm -rf "$work"' EXIT
for _ in $(seq 100); do [ -S "$work/hub" ] && break; read -r -t 0.1 <> <(:) || true; done
few=0
for count in 11 51; do
  "$bin/task_manager" "$work/turns.vxml" --connect "unix:$work/hub" --sessions $count </dev/null >/dev/null 2>&1 &
  process=$!
  read -r -t 15 <> <(:) || true
  many=$(memory_kib "$process")
  kill "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null || true
  [ "$few" -eq 0 ] || echo "memory of each further session at a hub: $(((many - few) / 40)) KiB"
  few=$many
done
