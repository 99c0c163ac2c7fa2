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

# One session, two seconds after its first answer: what its process has used at the most.
mkfifo "$work/typed"
"$bin/task_manager" "$work/turns.vxml" <"$work/typed" >"$work/said" &
process=$!
exec 3>"$work/typed"
echo "to kyoto" >&3
read -r -t 2 <> <(:) || true
echo "memory of a process with one session: $(awk '/VmHWM/ {print $2}' "/proc/$process/status") KiB"
exec 3>&-
wait "$process" || true
