#!/usr/bin/env bash
# Installs, where they are missing, the outside programs that some tests start for themselves:
# Mosquitto, PostgreSQL, Node, Chromium, and an emulator of 64-bit ARM (Debian's packages).
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin

have() { command -v "$1" >/dev/null; }
missing=()
have mosquitto || missing+=(mosquitto)
have postgres || compgen -G '/usr/lib/postgresql/*/bin/postgres' >/dev/null || missing+=(postgresql)
have node || missing+=(nodejs)
have chromium || have chromium-browser || have google-chrome || missing+=(chromium)
have qemu-aarch64-static || missing+=(qemu-user-static)
[ -d /usr/aarch64-linux-gnu ] || missing+=(libc6-arm64-cross)
((${#missing[@]})) || exit 0

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }
echo "Installing ${missing[*]} …"
as_root apt-get update -qq </dev/null
as_root env DEBIAN_FRONTEND=noninteractive \
  apt-get install -qq -y --no-install-recommends "${missing[@]}" </dev/null
