#!/usr/bin/env bash
# Builds everything into build/ (or the folder given), with --programs all but the tests, with --only what is named.
# Programs end up in build/bin/.
#   scripts/build.sh [--programs | --only "TARGET..."] [FOLDER] [cmake options...]
# A new folder is for the compiler that CXX and CC name, else for clang 19 where it is installed.
set -euo pipefail
targets=(all)
case ${1:-} in
  --programs) targets=(programs); shift ;;
  --only) read -ra targets <<<"${2:?--only needs the names of targets}"; shift 2 ;;
esac
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:-$root/build}
[ $# -gt 0 ] && shift
# clang takes half the time of g++.
if [ -z "${CXX:-}" ] && [ ! -e "$folder/CMakeCache.txt" ] && command -v clang++-19 >/dev/null; then
  export CC=clang-19 CXX=clang++-19
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# All parts, unless the options say otherwise: the first start of an agent configures this folder for the hub alone.
if ! cmake -S "$root" -B "$folder" -G Ninja -DGALATEA_PARTS= "$@" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
# The compiler cache takes what a source depends on from the compiler and does not run the preprocessor by itself first.
export CCACHE_DEPEND=1
# Two compilers at once need about 2 GiB; more cores are used only where there is memory for them.
jobs=$(nproc)
memory_gib=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
[ "$memory_gib" -lt "$jobs" ] && jobs=$((memory_gib > 1 ? memory_gib : 1))
cmake --build "$folder" --target "${targets[@]}" --parallel "$jobs"
