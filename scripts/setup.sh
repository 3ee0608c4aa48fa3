# Sourced by ./run, ./test and ./check: installs packages, makes sure that LCM can multicast, builds. Prints what it does.

say() { printf '==> %s\n' "$*"; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 2
}

# Runs a command as root: directly, or with sudo.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null 2>&1; then
    sudo "$@"
  else
    die "needs root for: $* (run as root, or install sudo)"
  fi
}

# Installs the packages of packages.txt, and of further lists, that are missing.
# install_packages [LIST ...]
install_packages() {
  local wanted missing=() package
  command -v dpkg-query >/dev/null 2>&1 ||
    die "packages are installed with apt (Debian, Ubuntu); on other systems install the equivalents of packages*.txt and call with PLANBENCH_SKIP_INSTALL=1"
  wanted=$(grep -hvE '^[[:space:]]*(#|$)' packages.txt "$@")
  for package in $wanted; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "installing: ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# LCM talks by UDP multicast, also within one machine; without any route for it, the loopback device gets one.
ensure_multicast() {
  command -v ip >/dev/null || {
    say "there is no program ip (package iproute2) to tell whether there is a multicast route: going on as if there were"
    return
  }
  ip route get 239.255.76.67 >/dev/null 2>&1 && return
  say "no multicast route: giving the loopback device one (ip route add 224.0.0.0/4 dev lo)"
  as_root ip link set lo up multicast on
  as_root ip route add 224.0.0.0/4 dev lo
}

# Large messages need a receive buffer that many kernels cap too low.
ensure_receive_buffer() {
  local wanted=4194304 cap
  cap=$(cat /proc/sys/net/core/rmem_max 2>/dev/null || echo $wanted)
  [ "$cap" -ge $wanted ] && return
  say "raising net.core.rmem_max from $cap to $wanted, so that large messages are not lost"
  # In a shell of its own, which die may leave.
  (as_root sysctl -q -w net.core.rmem_max=$wanted) ||
    say "could not raise it: messages that get lost will be sent again"
}

# prepare [LIST ...]: further lists of packages
prepare() {
  if [ "${PLANBENCH_SKIP_INSTALL:-0}" != 1 ]; then install_packages "$@"; fi
  ensure_multicast
  ensure_receive_buffer
}

# How many compilers to run at once: the largest files need about 2 GiB of memory each.
num_jobs() {
  local jobs memory_gib
  memory_gib=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
  jobs=$(nproc)
  [ $((memory_gib / 2)) -lt "$jobs" ] && jobs=$((memory_gib / 2))
  [ "$jobs" -lt 1 ] && jobs=1
  echo "$jobs"
}

# build PRESET TARGET
build() {
  local preset=$1 target=$2 jobs
  jobs=$(num_jobs)
  say "building the preset '$preset' with $jobs jobs"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" --target "$target" -j "$jobs"
}
