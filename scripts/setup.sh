#!/usr/bin/env bash
# Installs what is missing of packages.txt (Debian; as root or through sudo), configures and builds the program,
# build/ltcfit. With --tests it also installs what only the tests need (packages-test.txt), and builds tests and benchmarks.
# Nothing is done twice: a warm run only asks the build whether it is up to date. Killed at any moment, the next run
# goes on. LTCFIT_PRESET names another preset of CMakePresets.json that builds in build/ (ci). A package that cannot be installed ends nothing here: configuration says whether the build can do without.
set -euo pipefail
cd "$(dirname "$0")/.."

lists=(scripts/packages.txt)
target=ltcfit
case ${1:-} in
  '') ;;
  --tests) lists+=(scripts/packages-test.txt) target=all ;;
  *) echo "usage: scripts/setup.sh [--tests]" >&2; exit 2 ;;
esac

missing=()
while read -r package command _; do
  case $package in '' | '#'*) continue ;; esac
  case $command in '' | '#'*) ;; *) command -v "$command" >/dev/null && continue ;; esac
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done < <(cat "${lists[@]}")

# Of apt-get's lines those that tell how much it is, and one in fifty of those that tell how far it is.
showApt() {
  local line fetched=0 unpacked=0 ready=0
  while IFS= read -r line; do
    case $line in
      *' newly installed, '* | 'Need to get '*) echo "  $line" ;;
      Get:*) ((++fetched % 50)) || echo "  fetched $fetched" ;;
      'Unpacking '*) ((++unpacked % 50)) || echo "  unpacked $unpacked" ;;
      'Setting up '*) ((++ready % 50)) || echo "  set up $ready" ;;
    esac
  done
}
installMissing() {
  command -v apt-get >/dev/null || { echo "no apt-get here: install by hand what is missing" >&2; return 1; }
  local asRoot=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "need root or sudo to install" >&2; return 1; }
    asRoot=(sudo)
  fi
  asRoot+=(env DEBIAN_FRONTEND=noninteractive)
  "${asRoot[@]}" dpkg --configure -a || true  # what an installation that was killed has left
  "${asRoot[@]}" apt-get update -qq || echo "apt-get update failed: going on with the lists that are there" >&2
  "${asRoot[@]}" apt-get install -y --fix-broken --no-install-recommends "${missing[@]}" | showApt
}
if [ ${#missing[@]} -gt 0 ]; then
  echo "installing, with what they depend on (one to five minutes): ${missing[*]}"
  installMissing || echo "NOT INSTALLED: ${missing[*]}; going on without" >&2
fi

# Configured again after an installation, as what the tests can use is looked for then, and where the page's charting
# library is missing, as npm may reach its registry by now.
if ! [ build/build.ninja -nt /var/lib/dpkg/status ] || [ CMakePresets.json -nt build/build.ninja ] ||
  [ -e build/report/charts/missing.txt ]; then
  echo "configuring"
  mkdir -p build
  # what pkg-config does not find is named on stdout
  cmake --preset "${LTCFIT_PRESET:-release}" >build/configure.log || { tail -n 5 build/configure.log >&2; exit 1; }
fi

# Of ninja's lines one in twenty, and whatever else it says.
showNinja() {
  local line shown=0
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\  ]]; then
      ((20 * BASH_REMATCH[1] / BASH_REMATCH[2] > shown)) || continue
      shown=$((20 * BASH_REMATCH[1] / BASH_REMATCH[2]))
    fi
    echo "$line"
  done
}
if [ -t 1 ]; then
  cmake --build build --target "$target"
else
  cmake --build build --target "$target" | showNinja
fi
