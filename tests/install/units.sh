#!/usr/bin/env bash
# units.sh UNITS_FOLDER PROGRAMS_FOLDER: what systemd says of the example units. 77: no systemd here.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "needs systemd-analyze (Debian: systemd)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for unit in "$1"/*.service; do
  sed "s,/usr/bin/,$2/," "$unit" >"$work/${unit##*/}"
done
systemd-analyze verify "$work"/*.service 2>&1 | tee "$work/said"
[ ! -s "$work/said" ]
