#!/usr/bin/env bash
# Sets up, builds and runs every test:  scripts/test.sh [ctest options...]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
"$root/scripts/setup.sh" --tests
# In a new folder by g++; an agent's first start is by clang.
CC=${CC:-gcc} CXX=${CXX:-g++} "$root/scripts/build.sh" "$root/build" -DGALATEA_WERROR="${GALATEA_WERROR:-OFF}"
# What tests look at and is not in the repository; those that lack it are skipped, and say so.
! command -v npm >/dev/null || "$root/scripts/face_networks.sh" || true
if [ -z "${GALATEA_PHOTOS:-}" ] && [ ! -d "$root/../shared/data/photos" ]; then
  "$root/scripts/test_photos.sh" "$root/build/photos" || true
  export GALATEA_PHOTOS=$root/build/photos
fi
"$root/scripts/run_tests.sh" "$root/build" "$@"
