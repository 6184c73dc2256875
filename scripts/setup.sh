#!/usr/bin/env bash
# Installs what is missing of packages.txt (Debian; as root or through sudo), configures and builds. The program
# ends up at build/ltcfit. Nothing is done twice: a warm run only asks the build whether it is up to date.
# With --tests also what only the tests need (packages-test.txt).
set -euo pipefail
cd "$(dirname "$0")/.."

lists=(scripts/packages.txt)
[ "${1:-}" = --tests ] && lists+=(scripts/packages-test.txt)
missing=()
while read -r package command _; do
  case $package in '' | '#'*) continue ;; esac
  case $command in '' | '#'*) ;; *) command -v "$command" >/dev/null && continue ;; esac
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done < <(cat "${lists[@]}")

if [ ${#missing[@]} -gt 0 ]; then
  echo "installing: ${missing[*]}"
  command -v apt-get >/dev/null || { echo "no apt-get here: install the packages of ${lists[*]} by hand" >&2; exit 1; }
  asRoot=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "need root or sudo to install: ${missing[*]}" >&2; exit 1; }
    asRoot=(sudo)
  fi
  export DEBIAN_FRONTEND=noninteractive
  "${asRoot[@]}" apt-get update -qq
  "${asRoot[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# configured again after an installation: what the tests can use is looked for then
if [ ${#missing[@]} -gt 0 ] || [ ! -f build/build.ninja ] || [ CMakePresets.json -nt build/build.ninja ]; then cmake --preset release >/dev/null; fi
cmake --build build -- --quiet
