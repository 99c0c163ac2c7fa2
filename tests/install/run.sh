#!/usr/bin/env bash
# run.sh BUILD_FOLDER COMPILER PROJECT SANITIZERS
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --component dev --prefix "$work/prefix" >/dev/null
flags=${4:+-fsanitize=$4}
cmake -S "$3" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$2" \
  -DCMAKE_CXX_FLAGS="$flags" >/dev/null
cmake --build "$work/build" >/dev/null
"$work/build/asks"
