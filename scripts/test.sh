#!/usr/bin/env bash
# Sets up, builds and runs every test:  scripts/test.sh [ctest options...]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
"$root/scripts/setup.sh" --tests
"$root/scripts/build.sh" "$root/build" -DGALATEA_WERROR="${GALATEA_WERROR:-OFF}"
"$root/scripts/run_tests.sh" "$root/build" "$@"
