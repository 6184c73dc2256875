# The checkers of these tests against good and bad input: bash checkers.sh SOURCE_DIR BUILD_WEB
set -u
web=$1/tests/web
bash "$web/install.sh" "$1" "$2" check || exit $?
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$web/checkers.mjs" "$2" "$work"
