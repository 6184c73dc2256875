#!/usr/bin/env bash
# Both commands of the README on a machine that has nothing: bash bare.sh SOURCE_DIR FOLDER
# Makes a minimal Debian 12 root in FOLDER, puts a clone of SOURCE_DIR's HEAD into it (what is not committed does not
# count), and runs scripts/fit.sh and a few tests of scripts/test.sh there. From this machine come its apt sources as far
# as they are Debian's, its certificates, its DNS, and npm's registry; and, for speed alone, the compiler cache and the
# packages that apt fetched for an earlier run. The root is removed at the end, and by the next run where this one is killed.
#   BARE_WITHOUT=PACKAGE  leaves that line out of the package lists, for which the test must fail
#   BARE_TESTS=REGEX      the tests to run there
set -euo pipefail
source_dir=$1
folder=$2
root=$folder/root
tests=${BARE_TESTS:-'^(GlRendererDeathTest\.DrawsByEs|Npy\..*|ChebyshevSource\..*|app\.(charts|install|readers|readme|report|scripts)|render\.(shaders|window)|fuzz\.npy|web\.(packages|checkers))$'}

skip() { echo "SKIPPED: the README's commands were NOT tried on a bare machine: $*"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "it takes root to make one"
for program in mmdebstrap unshare setpriv git flock; do
  command -v $program >/dev/null || skip "$program is not installed (scripts/packages-test.txt)"
done
unshare --mount --pid --fork true 2>/dev/null || skip "no namespaces for mounts and processes are to be had here"
git -c safe.directory="$source_dir" -C "$source_dir" rev-parse -q --verify HEAD >/dev/null || skip "$source_dir is no git repository"

mkdir -p "$folder/archives"
exec 9>"$folder/lock"
flock -n 9 || { echo "FAILED: another run is at work in $folder"; exit 1; }
# nothing is mounted there outside of the namespace
child=
remove() {
  if [ -n "$child" ]; then kill -KILL "$child" 2>/dev/null && wait "$child" 2>/dev/null || true; fi
  # what still ends in there may write
  for _ in 1 2 3; do rm -rf --one-file-system "$root" && return; sleep 1; done
}
trap remove EXIT
trap 'exit 1' INT TERM HUP
remove

# what the machine's apt is told about Debian's mirrors, and how to get there
apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
  awk '$2 ~ /^bookworm(-updates|-security)?$/ && $3 == "main" { print "deb", $0 }' | sort -u > "$folder/sources.list"
[ -s "$folder/sources.list" ] || echo "deb http://deb.debian.org/debian bookworm main" > "$folder/sources.list"
apt-config dump | grep -E '^Acquire::(https?::Proxy|https::CA|Check-)' > "$folder/apt.conf" || true

# Everything else happens in namespaces that end with this process, even if it is killed: mounts and processes with them.
# The clone lies where SOURCE_DIR lies, so that the compiler cache knows its files.
setpriv --pdeathsig KILL unshare --mount --propagation private --pid --fork --kill-child --mount-proc \
  bash "$(dirname "$0")/root.sh" "$source_dir" "$folder" "$tests" 9>&- &
child=$!
status=0
wait "$child" || status=$?
child=
exit $status
