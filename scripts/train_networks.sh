#!/usr/bin/env bash
# Makes the networks and the table of emotions anew that vdm carries (vdm/tables), from speech that is made here and recordings of
# people, which it fetches (scripts/people_speech.py): two and three quarter hours on two cores.
#   scripts/train_networks.sh [FOLDER]
# FOLDER (networks_training) keeps speech and courses: ended and called again, it goes on where it was. One machine
# gives the same networks each time; others give some of about the same quality (docs/vdm.md).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$(realpath -m "${1:-networks_training}")
cd "$root"
mkdir -p "$folder"
scripts/setup.sh --training
scripts/people_speech.py "$folder/people"

# NAME OPTION... : one network, unless it was made.
learn() {
  [ ! -e "$folder/$1" ] || return 0
  scripts/build.sh --only "vdm_train ssm_espeak" build >&2
  echo "train_networks: $1" >&2
  build/bin/vdm_train "$folder/$1" --work "$folder" "${@:2}"
}
# Likewise, for vdm.
train() {
  learn "$@"
  cp "$folder/$1" vdm/tables/
}
people=(--people "$folder/people/list")
phones=(--features phones --width 192 --long-past "${people[@]}")
# Each goes on with the network before, other chances and smaller steps.
learn first.net "${phones[@]}" --epochs 20
learn second.net "${phones[@]}" --from "$folder/first.net" --epochs 12 --rate 0.001 --seed 5
learn third.net "${phones[@]}" --from "$folder/second.net" --epochs 16 --rate 0.0008 --seed 6
train phones.net "${phones[@]}" --from "$folder/third.net" --epochs 6 --rate 0.0004 --seed 11
words=(--features words --width 96 "${people[@]}")
learn first_words.net "${words[@]}" --epochs 6
train words.net "${words[@]}" --from "$folder/first_words.net" --epochs 3 --rate 0.0004 --seed 11
train mel.net
train cepstra.net --features cepstra --epochs 12
# Heads hear what mel.net says, which is built in.
train head.net --head SYNTHETIC
train head_prosody.net --head SYNTHETIC --head-prosody
train emotions.txt --emotion SYNTHETIC
