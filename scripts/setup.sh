#!/usr/bin/env bash
# Installs what is missing of packages.txt (Debian; as root or through sudo), configures and builds. The program
# ends up at build/ltcfit. Nothing is done twice: a warm run only asks the build whether it is up to date.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=()
while read -r package _; do
  case $package in '' | '#'*) continue ;; esac
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done < scripts/packages.txt

if [ ${#missing[@]} -gt 0 ]; then
  echo "installing: ${missing[*]}"
  command -v apt-get >/dev/null || { echo "no apt-get here: install the packages of scripts/packages.txt by hand" >&2; exit 1; }
  asRoot=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "need root or sudo to install: ${missing[*]}" >&2; exit 1; }
    asRoot=(sudo)
  fi
  export DEBIAN_FRONTEND=noninteractive
  "${asRoot[@]}" apt-get update -qq
  "${asRoot[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

if [ ! -f build/build.ninja ] || [ CMakePresets.json -nt build/build.ninja ]; then cmake --preset release >/dev/null; fi
cmake --build build -- --quiet
