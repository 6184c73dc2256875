# One mechanism for one thing: parallel loops are base/parallel_for.h's, whose loop lets no exception out of an
# OpenMP region, and what goes to stderr is base/diagnostics.h's, where no failing write can end a run.
set -u
source_dir=$1
failures=0

# Lines of a folder's C++ files that break a rule.
violations() {
  (cd "$1" && find app base export fit ggx ltc render report scene tailor \( -name '*.cpp' -o -name '*.h' \) -print0 2>/dev/null |
    LC_ALL=C sort -z | xargs -0 -r awk '
      {
        line = $0
        # without strings and comments, which may speak of it
        gsub(/"([^"\\]|\\.)*"/, "", line)
        sub(/\/\/.*/, "", line)
        loop = line ~ /#[ \t]*pragma[ \t]+omp[ \t]+(parallel|for|critical|task|sections|single|master|atomic|barrier|ordered)|<omp\.h>|(^|[^a-zA-Z0-9_])omp_[a-z_]+\(/
        said = line ~ /(^|[^a-zA-Z0-9_])(stderr|cerr|clog|perror)([^a-zA-Z0-9_]|$)/
        if ((loop && FILENAME != "base/parallel_for.h") || (said && FILENAME != "base/diagnostics.h"))
          print FILENAME ":" FNR ":" $0
      }')
}

bad=$(mktemp -d)
trap 'rm -rf "$bad"' EXIT
found=$(violations "$source_dir")
[ -z "$found" ] || { echo "FAILED: not by base/parallel_for.h, base/diagnostics.h:"; echo "$found"; failures=1; }
[ "$(find "$source_dir"/{app,base,export,fit,ggx,ltc,render,report,scene,tailor} -name '*.cpp' | wc -l)" -gt 100 ] ||
  { echo "FAILED: the sources are elsewhere"; failures=1; }

# each kind is found
mkdir "$bad/fit"
for line in '#pragma omp parallel for' '  #pragma omp critical(x)' '#include <omp.h>' 'int t = omp_get_thread_num();' \
  'fmt::print(stderr, "x");' 'std::cerr << 1;' 'std::fputs(text, stderr);  // "why"'; do
  echo "$line" > "$bad/fit/a.cpp"
  [ -n "$(violations "$bad")" ] || { echo "FAILED: does not see: $line"; failures=1; }
done
for line in '#pragma omp simd' '// on stderr' 'help("a \" on stderr");'; do
  echo "$line" > "$bad/fit/a.cpp"
  [ -z "$(violations "$bad")" ] || { echo "FAILED: takes offence at: $line"; failures=1; }
done
[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
