#!/usr/bin/env bash
# Makes docs/agent.png, the README's picture, anew: stills of three films, each of one person who says something.
#   scripts/readme_picture.sh [PICTURE.png]
set -euo pipefail
cd "$(dirname "$0")/.."
picture=${1:-docs/agent.png}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stills=()
film() { # MASK TURN EMOTION MS TEXT: the still is what is seen so many ms after the text began
  local still=$work/$1.png
  build/bin/agent_manager --config examples/agents/film.json >/dev/null 2>&1 <<END
to @FSM set Mask = $1
to @FSM set Camera = 0.95 0 14 $2
to @FSM set FaceExp.onset = NATURAL
to @AM-MCL set Record = $work/$1.mp4
to @AM-MCL set Emotion = $3
set Wait = 600
to @AM-MCL set Speak = $5
set Wait = IDLE
to @AM-MCL set#film Record = STOP
set Wait = IDLE
END
  ffmpeg -loglevel error -y -ss "$(awk "BEGIN {print (600 + $4) / 1000}")" -i "$work/$1.mp4" -frames:v 1 -vf crop=340:440:150:10,scale=300:-1:flags=lanczos "$still" </dev/null
  stills+=(-i "$still")
}
film galatea -14 "HAPPY 40" 900 "Hello, my name is Galatea."
film pygmalion 0 "SURPRISED 45" 700 "Oh, how do you do?"
film baucis 14 "HAPPY 35" 900 "Good morning. Nice to meet you."
ffmpeg -loglevel error -y "${stills[@]}" -filter_complex hstack=inputs=3 "$picture" </dev/null
