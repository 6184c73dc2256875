# Two runs of the same process number, as in two containers, write into one folder: each file is whole and its own.
. "$(dirname "$0")/common.sh" "$@"

unshare --pid --fork true 2>/dev/null || { echo "SKIPPED: no process namespaces here (unshare --pid needs root)"; exit 77; }
"${CC:-cc}" -shared -fPIC -o slow.so "$source_dir/tests/app/slow_rename.c" -ldl ||
  { echo "SKIPPED: no C compiler for the library that slows renames down"; exit 77; }
export ASAN_OPTIONS=verify_asan_link_order=0
isotropic=$source_dir/data/ltc_iso.json
anisotropic=$source_dir/data/ltc_aniso.json
mkdir alone
"$ltcfit" export -q "$isotropic" -o alone/one.h && "$ltcfit" export -q "$anisotropic" -o alone/two.h || fail "the exports alone"

# slowly TABLE OUTPUT: number 1 of a process namespace of its own
slowly() { unshare --pid --fork env LD_PRELOAD="$work/slow.so" "$ltcfit" export -q "$1" -o "$2"; }
for without in "" 1; do
  [ -z "$without" ] || export NO_TMPFILE=1
  rm -rf shared; mkdir shared
  for round in new replaced; do
    slowly "$isotropic" shared/one.h & first=$!
    slowly "$anisotropic" shared/two.h & second=$!
    wait $first && wait $second || fail "$round: a run failed"
    for file in one two; do
      cmp alone/$file.h shared/$file.h || fail "$round, NO_TMPFILE='$without': $file.h is not its own"
    done
    [ "$(find shared -type f | wc -l)" -eq 2 ] || fail "$round: left behind: $(ls -A shared)"
  done
done
unset NO_TMPFILE

# the folder is flushed, also where nothing is replaced
for round in new replaced; do
  rm -f synced
  SYNCED=$work/synced LD_PRELOAD=$work/slow.so "$ltcfit" export -q "$isotropic" -o flushed.h || fail "export, $round"
  [ -s synced ] || fail "the folder of a $round file was not flushed"
done
finish
