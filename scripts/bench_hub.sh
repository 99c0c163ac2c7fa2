#!/usr/bin/env bash
# Our hub beside Mosquitto, ZeroMQ and Redis on this machine, in alternating runs:
#     scripts/bench_hub.sh [RUNS] [FOLDER OF PROGRAMS]
# Without a folder the programs are built first. Peers that are not installed (Debian packages
# mosquitto, redis-server; libzmq3-dev and libhiredis-dev when building) print n/a.
# "spin" is our hub with "spin_us": 300; "relay" copies bytes between two Unix sockets and looks at
# none of them, so it shows what the machine itself costs. Prints each run and the medians.
set -euo pipefail
cd "$(dirname "$0")/.."
PATH=$PATH:/usr/sbin
runs=${1:-5}
bin=${2:-}
if [ -z "$bin" ]; then
  cmake --preset bench >/dev/null
  cmake --build build-bench --target hub_bench agent_manager >/dev/null
  bin=build-bench/bin
fi

work=$(mktemp -d)
started=()
trap 'kill "${started[@]}" 2>/dev/null || true; rm -rf "$work"' EXIT
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
in_background() { "$@" >"$work/said.${#started[@]}" 2>&1 & started+=($!); }
wait_for() { for _ in $(seq 100); do (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null && return; sleep 0.05; done; }

kinds=$("$bin/hub_bench" 2>&1 || true)  # it names those it was built with
declare -A at
for hub in galatea spin; do
  port=$(free_port)
  spin=$([ $hub = spin ] && echo 300 || echo 0)
  printf '{"listen": ["tcp:127.0.0.1:%s", "unix:%s"], "modules": [], "spin_us": %s}\n' \
    "$port" "$work/$hub" "$spin" >"$work/$hub.json"
  in_background "$bin/agent_manager" --config "$work/$hub.json" --no-console
  wait_for "$port"
  at[$hub-tcp]="galatea tcp:$port"
  at[$hub-unix]="galatea unix:$work/$hub"
done
in_background "$bin/hub_bench" relay-run "$work/relay"
at[relay]="relay $work/relay"
if command -v mosquitto >/dev/null; then
  port=$(free_port)
  printf 'listener %s 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\nlog_type error\n' "$port" >"$work/m.conf"
  in_background mosquitto -c "$work/m.conf"
  wait_for "$port"
  at[mosquitto]="mqtt $port"
fi
if command -v redis-server >/dev/null && [[ $kinds == *" redis"* ]]; then
  port=$(free_port)
  in_background redis-server --port "$port" --bind 127.0.0.1 --save '' --appendonly no
  wait_for "$port"
  at[redis]="redis $port"
fi
if [[ $kinds == *" zmq"* ]]; then
  port=$(free_port)
  in_background "$bin/hub_bench" zmq-forward "$port"
  wait_for "$port"
  at[zeromq]="zmq $port"
fi

order=(relay galatea-tcp galatea-unix spin-tcp spin-unix mosquitto zeromq redis)
for _ in $(seq "$runs"); do
  for name in "${order[@]}"; do
    [ -n "${at[$name]:-}" ] || continue
    # shellcheck disable=SC2086 # two words
    "$bin/hub_bench" ${at[$name]} | sed "s/\"hub\": \"[a-z]*\"/\"hub\": \"$name\"/"
  done
done | tee "$work/results"
python3 - "$work/results" "${order[@]}" <<'PY'
import json, os, statistics, sys
rows = [json.loads(line) for line in open(sys.argv[1])]
print(f"medians, load {os.getloadavg()[0]:.1f}:")
for hub in sys.argv[2:]:
    mine = [row for row in rows if row["hub"] == hub]
    median = lambda key: statistics.median(row[key] for row in mine)
    print(f"{hub:13}", f"p50 {median('p50_us'):6.1f} us  p99 {median('p99_us'):7.1f} us  "
          f"{median('messages_per_s') / 1000:6.0f} thousand messages/s" if mine else "n/a")
PY
