#!/usr/bin/env bash
# Draws the kept pictures of tests/fsm/data/golden anew, after a change of how the face looks that
# is meant. Look at them (git diff shows old and new) before committing:
#   scripts/renew_goldens.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}
cmake --build "$build" --target fsm_render_test >/dev/null
GALATEA_RENEW_GOLDENS=1 "$build/bin/fsm_render_test" --gtest_filter='*GoldenTest*' >/dev/null
git status --short tests/fsm/data/golden
