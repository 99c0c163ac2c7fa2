#!/usr/bin/env bash
# Our hub beside Mosquitto on this machine, in alternating runs:  scripts/bench_hub.sh [RUNS]
# Needs the Debian package mosquitto. Prints each run and the medians.
set -euo pipefail
cd "$(dirname "$0")/.."
runs=${1:-5}
command -v mosquitto >/dev/null || { echo "bench: install the package mosquitto" >&2; exit 1; }
cmake --preset bench >/dev/null
cmake --build build-bench --target hub_bench agent_manager >/dev/null

work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$work"' EXIT
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
am_port=$(free_port)
mqtt_port=$(free_port)

printf '{"listen": ["tcp:127.0.0.1:%s"], "modules": []}\n' "$am_port" >"$work/am.json"
build-bench/bin/agent_manager --config "$work/am.json" --no-console >"$work/am.log" 2>&1 &
printf 'listener %s 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\nlog_type error\n' "$mqtt_port" >"$work/m.conf"
mosquitto -c "$work/m.conf" >"$work/m.log" 2>&1 &
for port in "$am_port" "$mqtt_port"; do
  for _ in $(seq 100); do (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null && break; sleep 0.05; done
done

for _ in $(seq "$runs"); do
  build-bench/bin/hub_bench galatea "$am_port"
  build-bench/bin/hub_bench mqtt "$mqtt_port"
done | tee "$work/results"
python3 - "$work/results" <<'PY'
import json, statistics, sys
rows = [json.loads(line) for line in open(sys.argv[1])]
for hub in ("galatea", "mqtt"):
    mine = [row for row in rows if row["hub"] == hub]
    print(f"median {hub:8}", ", ".join(f"{key} {statistics.median(row[key] for row in mine):.1f}"
                                       for key in ("p50_us", "p99_us", "messages_per_s")))
PY
