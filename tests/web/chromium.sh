# Sets `chromium` to the browser of the tests, or ends the test as skipped: to be sourced.
chromium=
for name in chromium chromium-browser google-chrome; do
  if [ -z "$chromium" ]; then chromium=$(command -v "$name" || true); fi
done
if [ -z "$chromium" ]; then
  echo "SKIPPED: chromium is not installed; the tests in a browser need it"
  exit 77
fi
