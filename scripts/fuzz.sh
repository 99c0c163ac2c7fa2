#!/usr/bin/env bash
# Runs every fuzz target for a while:  scripts/fuzz.sh [SECONDS EACH, default 60]
# Needs clang-19 and libclang-rt-19-dev. A finding is kept in build-fuzz/ and ends the run.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
cmake --preset fuzz >/dev/null
cmake --build build-fuzz
mkdir -p build-fuzz/corpus
for target in build-fuzz/bin/fuzz_*; do
  name=$(basename "$target")
  mkdir -p "build-fuzz/corpus/$name"
  echo "== $name, $seconds s"
  log=build-fuzz/$name.log
  if ! "$target" -max_total_time="$seconds" -max_len=4096 -timeout=10 -print_final_stats=1 \
      -artifact_prefix=build-fuzz/ "build-fuzz/corpus/$name" >"$log" 2>&1; then
    tail -40 "$log"
    exit 1
  fi
  grep number_of_executed_units "$log"
done
echo "fuzz: nothing found"
