# Every command of the README's block on fits is one that the program takes: run with a small table in place of its own.
. "$(dirname "$0")/common.sh" "$@"
grep -E '^ltcfit fit (iso|aniso|entry) ' "$source_dir/README.md" | sed 's/ *#.*//' > commands
[ "$(wc -l < commands)" -ge 6 ] || fail "the README's commands were not found"
while read -r command; do
  arguments=$(echo "$command" | sed -E 's/^ltcfit //; s/--size [0-9x]+//; s/--preset fine/--preset fast/; s/--refine/--refine --refine-points 50 --refine-iterations 1/')
  case $arguments in
    *iso\ *-o*like2017*) size="--size 3x3" ;;
    fit\ iso*) size="--size 4x4" ;;
    fit\ aniso*) size="--size 2x2x2x2" ;;
    *) size= ;;
  esac
  # shellcheck disable=SC2086
  "$ltcfit" $arguments $size > /dev/null 2>message.txt || fail "$command: $(cat message.txt)"
done < commands
finish
