#!/bin/sh
# Stands for Rhubarb Lip Sync: looks at how it was called, and answers as it would.
if [ "$#" -ne 10 ]; then echo "found $# arguments, expected 10" >&2; exit 1; fi
[ "$1 $2 $3 $4 $5 $6 $7 $8" = "-q -f json -r pocketSphinx --extendedShapes GHX -d" ] || exit 2
[ -r "$9" ] || exit 3
[ -r "${10}" ] || exit 4
cat <<'ANSWER'
{"metadata": {"soundFile": "a.wav", "duration": 1.0},
 "mouthCues": [{"start": 0.00, "end": 0.10, "value": "X"},
               {"start": 0.10, "end": 0.20, "value": "A"},
               {"start": 0.20, "end": 0.50, "value": "C"},
               {"start": 0.50, "end": 0.60, "value": "A"},
               {"start": 0.60, "end": 1.00, "value": "X"}]}
ANSWER
