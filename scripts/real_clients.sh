#!/usr/bin/env bash
# Clients of other makers against our doors: OpenAI's and the Model Context Protocol's own (with its inspector), and two
# parsers of OSC.
#     scripts/real_clients.sh FOLDER [BIN]
# installs them by npm into FOLDER, which must lie outside of the repository, and runs scripts/real_clients/*.mjs.
# The two for Python, which Debian 12 does not have, are tried where CLIENTS_PYTHON is the command of a Python that has
# them (later Debians: packages python3-openai and python3-mcp).
set -euo pipefail
. "$(dirname "$0")/npm_folder.sh"
npm install --no-fund --no-audit openai @modelcontextprotocol/sdk @modelcontextprotocol/inspector osc osc-min
cp "$root"/scripts/real_clients/*.mjs .
for package in openai @modelcontextprotocol/sdk @modelcontextprotocol/inspector osc osc-min; do
  echo "$package $(node -p "require('./node_modules/$package/package.json').version")"
done

work=$(mktemp -d)
started=()
finish() {
  for process in "${started[@]}"; do kill "$process" 2>/dev/null || true; done
  wait || true
  rm -rf "$work"
}
trap finish EXIT
# first_line FILE: the first line of what a program started in the background says.
first_line() {
  for _ in $(seq 200); do
    if [ -s "$1" ]; then
      head -n 1 "$1"
      return
    fi
    sleep 0.1
  done
  echo "real_clients: a program did not start" >&2
  return 1
}

umask 077
echo "a-token-of-sixteen-bytes" >"$work/token"
"$bin/gateway" --at tcp:127.0.0.1:0 --token-file "$work/token" >"$work/gateway" &
started+=($!)
python3 "$root/tests/chat/stub_model.py" >"$work/model" &
started+=($!)
url=$(first_line "$work/gateway")
url=${url%%/v1*}
doors=("http${url#ws}" "$(cat "$work/token")" "http://127.0.0.1:$(first_line "$work/model")")
node openai.mjs "${doors[@]}"
# python_client NAME WORDS...: tries scripts/real_clients/NAME.py by that Python, if one is named.
python_client() {
  local python
  read -ra python <<<"${CLIENTS_PYTHON:-}"
  [ ${#python[@]} -eq 0 ] || "${python[@]}" - "${@:2}" <"$root/scripts/real_clients/$1.py"
}
python_client openai_client "${doors[@]}"

cat >"$work/hub.json" <<END
{"listen": ["unix:$work/hub"], "modules": [{"name": "SSM", "command": ["$bin/ssm_stub"]}]}
END
"$bin/agent_manager" --config "$work/hub.json" --no-console &
started+=($!)
until [ -S "$work/hub" ]; do sleep 0.1; done
mcp=("$bin/mcp" --connect "unix:$work/hub" --allow "@SSM Rate" --allow "@SSM Text*")
node mcp.mjs "${mcp[@]}"
"${mcp[@]}" --http tcp:127.0.0.1:0 >"$work/mcp" &
started+=($!)
url=$(first_line "$work/mcp")
node mcp.mjs "$url"
python_client mcp_client "$url"
inspector=(npx --no-install mcp-inspector --cli)
"${inspector[@]}" "${mcp[@]}" --method tools/list | grep -q '"SSM_Rate"'
"${inspector[@]}" "${mcp[@]}" --method tools/call --tool-name SSM_Rate --tool-arg value=2 | grep -q '"text": "2"'
"${inspector[@]}" "$url" --transport http --method tools/list | grep -q '"SSM_Rate"'
echo "inspector: ok"

node osc.mjs 30 >"$work/osc" &
listener=$!
cat >"$work/face.json" <<END
{"clock": "virtual", "modules": [{"name": "FSM", "command": ["$bin/fsm", "--headless"]},
 {"name": "VMC", "after": ["FSM"], "command": ["$bin/vmc", "--to", "127.0.0.1:$(first_line "$work/osc")"]}]}
END
printf '%s\n' 'set Wait = 100' 'to @FSM set HeadRotAbs.1 = 5 20 3' 'to @FSM set LipSync.pho = pau 100 m 100 aa 900 pau 100' \
  'to @FSM set Speak = NOW' 'set Wait = 2000' | "$bin/agent_manager" --config "$work/face.json" >/dev/null
wait "$listener"
tail -n 1 "$work/osc"
