#!/usr/bin/env bash
# Makes the photos of faces that tests look at, out of pictures in Debian packages, in a folder:
#
#     scripts/test_photos.sh FOLDER
#
#     hopper_usnavy.jpg  Grace Hopper, US Navy photograph, public domain (python-matplotlib-data)
#     collins_nasa.png   Eileen Collins, NASA photograph, public domain (python3-skimage)
#
# The packages are fetched and unpacked, not installed. Does nothing if the photos are there. Needs
# apt-get and ffmpeg.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '2,10s/^# \?//p' "$0" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
photo() { # NAME PACKAGE FILE CROP PIXELS
  [ -s "$folder/$1" ] && return 0
  local work
  work=$(mktemp -d)
  chmod 755 "$work"
  echo "test_photos: fetching $2" >&2
  if (cd "$work" && apt-get download -qq "$2" >/dev/null 2>&1 && dpkg-deb -x ./*.deb . &&
      ffmpeg -loglevel error -i "$3" -vf "crop=$4" -q:v 1 -pix_fmt "$5" "./$1" </dev/null); then
    install -m 644 "$work/$1" "$folder/$1"
    rm -rf "$work"
  else
    rm -rf "$work"
    echo "test_photos: the package $2 could not be fetched and unpacked" >&2
    return 1
  fi
}
photo hopper_usnavy.jpg python-matplotlib-data \
  usr/share/matplotlib/mpl-data/sample_data/grace_hopper.jpg 370:470:80:20 yuvj444p
photo collins_nasa.png python3-skimage \
  usr/lib/python3/dist-packages/skimage/data/astronaut.png 240:290:112:0 rgb24
