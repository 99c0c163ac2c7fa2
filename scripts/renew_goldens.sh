#!/usr/bin/env bash
# Draws the kept pictures of tests/fsm/data/golden and tests/face_fit/data/golden anew, after a change
# of how the face looks that is meant. Look at them (git diff shows old and new) before committing:
#   scripts/renew_goldens.sh [BUILD_FOLDER]
# The one of a photo that is fitted needs the networks of tests/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}
cmake --build "$build" --target fsm_render_test face_fit_test >/dev/null
for test in fsm_render_test face_fit_test; do
  # A test that has renewed its picture is skipped: exit code 77.
  GALATEA_RENEW_GOLDENS=1 "$build/bin/$test" --gtest_filter='*GoldenTest*' >/dev/null || [ $? = 77 ]
done
git status --short tests/fsm/data/golden tests/face_fit/data/golden
