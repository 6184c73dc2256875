#!/usr/bin/env bash
# The part of bare.sh that runs in namespaces of its own: bash root.sh SOURCE_DIR FOLDER TESTS
set -euo pipefail
source_dir=$1
folder=$2
tests=$3
root=$folder/root
step() { echo "== $SECONDS s: $*"; }

step "making a root of Debian 12"
optional=()
if command -v ccache >/dev/null; then optional=(--include=ccache); fi
# dpkg need not wait for the disk: the root does not outlive the test
mmdebstrap --quiet --mode=root --variant=minbase "${optional[@]}" --skip=essential/unlink \
  --aptopt="$folder/apt.conf" --dpkgopt=force-unsafe-io \
  --setup-hook="mkdir -p \"\$1/var/cache/apt/archives\"; cp -n '$folder'/archives/*.deb \"\$1/var/cache/apt/archives\" || true" \
  --customize-hook="cp -n \"\$1\"/var/cache/apt/archives/*.deb '$folder/archives' || true" \
  bookworm "$root" - < "$folder/sources.list"
echo "127.0.0.1 localhost" > "$root/etc/hosts"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount --bind "$folder/archives" "$root/var/cache/apt/archives"

environment=(HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8)
for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
  if [ -n "${!name:-}" ]; then environment+=("$name=${!name}"); fi
done
certificates=${NODE_EXTRA_CA_CERTS:-/etc/ssl/certs/ca-certificates.crt}
if [ -f "$certificates" ]; then
  # a name that no package of the root's writes to
  cp -L "$certificates" "$root/etc/machine-certificates.crt"
  environment+=(NODE_EXTRA_CA_CERTS=/etc/machine-certificates.crt npm_config_cafile=/etc/machine-certificates.crt)
fi
if command -v npm >/dev/null; then environment+=("npm_config_registry=$(npm config get registry)"); fi
if [ ${#optional[@]} -gt 0 ]; then
  cache=$(ccache -k cache_dir)
  mkdir -p "$cache" "$root/var/cache/ccache"
  mount --bind "$cache" "$root/var/cache/ccache"
  environment+=(CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=/var/cache/ccache "CCACHE_BASEDIR=$(ccache -k base_dir)"
    "CCACHE_SLOPPINESS=$(ccache -k sloppiness)" "CCACHE_MAXSIZE=$(ccache -k max_size)")
  [ "$(ccache -k hash_dir)" = true ] || environment+=(CCACHE_NOHASHDIR=1)
  [ "$(ccache -k depend_mode)" = false ] || environment+=(CCACHE_DEPEND=1)
  # other flags would be other objects
  if [ -n "${LTCFIT_PRESET:-}" ]; then environment+=("LTCFIT_PRESET=$LTCFIT_PRESET"); fi
fi

mkdir -p "$root$(dirname "$source_dir")"
GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0='*' git clone -q "file://$source_dir" "$root$source_dir"
if [ -n "${BARE_WITHOUT:-}" ]; then
  grep -qE "^$BARE_WITHOUT( |$)" "$root$source_dir"/scripts/packages*.txt || { echo "FAILED: no list names $BARE_WITHOUT"; exit 1; }
  sed -i -E "/^$BARE_WITHOUT( |$)/d" "$root$source_dir"/scripts/packages*.txt
fi
inside() { chroot "$root" env -i "${environment[@]}" bash -c "cd '$source_dir' && $1"; }
timed() { while IFS= read -r line; do printf '[%4d s] %s\n' $SECONDS "$line"; done; }
failed() { echo "FAILED after $SECONDS s: $*"; exit 1; }

step "scripts/fit.sh"
inside scripts/fit.sh 2>&1 | tee "$folder/fit.txt" | timed || failed "scripts/fit.sh"
made=(ltc_iso.json ltc_iso.h ltc_iso.ktx2 ltc_iso.csv ltc_aniso.json ltc_aniso.h ltc_aniso.ktx2 ltc_aniso.csv)
charts=1
if grep -q '^left out: the page' "$folder/fit.txt"; then charts=; else made+=(report.html report.json); fi
for file in "${made[@]}"; do [ -s "$root$source_dir/out/$file" ] || failed "scripts/fit.sh has not made out/$file"; done
for file in ltc_iso.json ltc_aniso.json; do
  cmp "$root$source_dir/out/$file" "$root$source_dir/data/$file" || failed "out/$file is not data/$file"
done

step "scripts/test.sh -R '$tests'"
inside "scripts/test.sh -R '$tests'" 2>&1 | tee "$folder/test.txt" | timed || failed "scripts/test.sh"
grep -q '100% tests passed' "$folder/test.txt" || failed "no test was run"
# every program that a test needs is in the lists; only npm's registry may be out of reach
if [ -n "$charts" ] && grep -E '\(Skipped\)|SKIPPED|\*\*\*(Skipped|Not Run)|_NOT_BUILT' "$folder/test.txt"; then
  failed "tests were skipped for lack of a package"
fi
step "all passed"
