#!/usr/bin/env bash
# A film of a talking face projected onto a mask that moves, on the simulated stage (docs/hypermask.md):
#   scripts/hypermask_film.sh [OUT.mp4 [TEXT [SCENE ...]]]
# Left without, right with prediction; the scenes share the time that the text takes. SCENE: as of build/bin/hypermask --scene.
set -euo pipefail
out=$(realpath -m "${1:-hypermask.mp4}")
text=${2:-"Good evening, and welcome. I have no face of my own: what you see is light. It is thrown onto a white mask, and \
the mask never stands still. A camera follows five small lights on it, a filter foretells where they will be when the \
picture comes out of the projector, and so my eyes stay where eyes should be."}
shift $(($# < 2 ? $# : 2))
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=("sway delay=100" "walk delay=100" "shake delay=100" "turn delay=100")
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scripts/run_agent.sh --say "$text" --size 480x480 --out "$work/face.mp4"
ffmpeg -v error -i "$work/face.mp4" -vn "$work/sound.wav"
seconds=$(ffprobe -v error -show_entries format=duration -of csv=p=0 "$work/face.mp4" |
  awk -v n=${#scenes[@]} '{ s = $1 / n; print s < 2 ? 2 : s }')
build/bin/hypermask --film "$out" --face "$work/face.mp4" --sound "$work/sound.wav" --seconds "$seconds" --scene "${scenes[@]}"
echo "hypermask_film: $out"
