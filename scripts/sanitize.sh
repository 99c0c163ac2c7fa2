#!/usr/bin/env bash
# Builds and runs all tests under the sanitizers:  scripts/sanitize.sh [asan|tsan|all]
# Needs the packages clang-19 and libclang-rt-19-dev.
set -euo pipefail
cd "$(dirname "$0")/.."
which=${1:-all}
case $which in
  asan | tsan | all) ;;
  *) echo "sanitize: '$which' is not asan, tsan or all" >&2; exit 2 ;;
esac
# Mesa and ffmpeg keep memory to the end by design; only our own leaks count.
export LSAN_OPTIONS="suppressions=$PWD/cmake/lsan.supp:print_suppressions=0"
# Mesa holds more locks at once than the detector of lock cycles can count.
export TSAN_OPTIONS="suppressions=$PWD/cmake/tsan.supp:detect_deadlocks=0"
for preset in asan tsan; do
  [ "$which" = all ] || [ "$which" = "$preset" ] || continue
  cmake --preset "$preset" >/dev/null
  cmake --build "build-$preset"
  scripts/run_tests.sh "build-$preset"
done
