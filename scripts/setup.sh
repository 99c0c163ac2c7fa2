#!/usr/bin/env bash
# Installs the Debian 12 packages that building and running the toolkit needs, with --tests also those
# that only tests use, with --hub only those that building the hub and the conversation needs. Does nothing
# (and asks for no password) if all of them are there.
set -euo pipefail

packages=(
  clang-19 cmake ninja-build pkg-config ccache
  libboost1.81-dev libcli11-dev nlohmann-json3-dev
  libssl-dev zlib1g-dev libmosquitto-dev libexpat1-dev libcurl4-openssl-dev
)
[ "${1:-}" = --hub ] || packages+=(
  g++
  libfmt-dev libglm-dev libmozjs-102-dev libutf8proc-dev
  libeigen3-dev libopencv-imgproc-dev
  libosmesa6-dev libegl-dev libglfw3-dev libimgui-dev libgl-dev libpng-dev libjpeg-dev
  flite1-dev portaudio19-dev libsndfile1-dev
  libespeak-ng-dev libmecab-dev libhtsengine-dev
  libpocketsphinx-dev libspeexdsp-dev
  liboscpack-dev
)
# What only running needs: a third of it all.
[ "${1:-}" = --hub ] || packages+=(
  python3 ffmpeg fonts-dejavu-core fonts-vlgothic
  espeak-ng-data open-jtalk open-jtalk-mecab-naist-jdic mecab-naist-jdic
  pocketsphinx-en-us
)
# The framework, servers, screens, a browser and recordings for the tests.
[ "${1:-}" != --tests ] || packages+=(
  libgtest-dev openssl mosquitto mosquitto-clients iproute2 xvfb xdotool chromium-headless-shell pocketsphinx-testdata liblo-tools
)
# Voices made of recordings of people, which festival (a program of its own) speaks with.
[ "${1:-}" != --training ] || packages+=(
  festival festvox-kdlpc16k festvox-italp16k festvox-itapc16k festvox-suopuhe-lj festvox-suopuhe-mv
  festvox-czech-ph festvox-czech-dita festvox-czech-krb festvox-czech-machac festvox-ru
)

# One question for all: each of its own takes long at every start of an agent.
installed=" $(dpkg-query -W -f='${db:Status-Status}=${Package} ' "${packages[@]}" 2>/dev/null || true)"
missing=()
for package in "${packages[@]}"; do
  [[ $installed == *" installed=$package "* ]] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "setup: installing ${missing[*]}" >&2
echo "setup: with what they need; on a bare machine that is some minutes" >&2
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: run as root once, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq >&2
# How far it is: at a terminal in one line that changes, else every 50 packages. What apt-get says is shown if it fails.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get install -y -q --no-install-recommends "${missing[@]}" 2>&1 |
  tee "$log" | {
    total=0 fetched=0 ready=0
    while IFS= read -r line; do
      case $line in
        *" newly installed, "*) total=${line%% newly installed*} total=${total##* } ;;
        Get:*) fetched=$((fetched + 1)) ;;
        "Setting up "*) ready=$((ready + 1)) ;;
        *) continue ;;
      esac
      if [ -t 2 ]; then
        printf '\r\033[Ksetup: %d of %d packages fetched, %d set up' "$fetched" "$total" "$ready" >&2
      elif [ $(((fetched + ready) % 50)) -eq 0 ]; then
        echo "setup: $fetched of $total packages fetched, $ready set up" >&2
      fi
    done
    [ ! -t 2 ] || printf '\r\033[K' >&2
  } || { cat "$log" >&2; exit 1; }
