# Sourced by tools/demo and tools/check: finds the repository, installs what is missing, configures, builds.
# Usage: prepare_packages "run test" ; prepare_build "-DX=Y ..." target...

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
allow_install=yes

say() { printf '==> %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

missing_packages() {  # $1: kinds, for example "run test"
  local kind package
  while read -r kind package; do
    case " $1 " in *" $kind "*) ;; *) continue ;; esac
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || echo "$package"
  done < <(grep -v "^#" "$root/tools/packages.txt") | sort -u
}

prepare_packages() {
  command -v dpkg-query >/dev/null || { say "not a Debian system: nothing is installed, see tools/packages.txt"; return; }
  local missing
  missing=$(missing_packages "$1" | tr '\n' ' ')
  [ -n "${missing// /}" ] || return 0
  [ "$allow_install" = yes ] || die "missing Debian packages: $missing(run without --no-install, or: apt-get install $missing)"
  say "installing from Debian: $missing"
  local sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "not root and no sudo: ask your administrator to apt-get install $missing"
    sudo=sudo
  fi
  $sudo apt-get update -qq || die "apt-get update failed: is this machine connected to a Debian mirror?"
  # shellcheck disable=SC2086
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
    die "apt-get could not install: $missing"
}

# prepare_build PRESET "cmake arguments" TARGET...: incremental, at most as many jobs as cores.
prepare_build() {
  local preset=$1 arguments=$2
  shift 2
  say "configuring ($preset)"
  # shellcheck disable=SC2086
  (cd "$root" && cmake --preset "$preset" $arguments >"$root/build/configure-$preset.log" 2>&1) ||
    { tail -20 "$root/build/configure-$preset.log" >&2; die "cmake failed, see build/configure-$preset.log"; }
  say "building ($preset)"
  cmake --build "$root/build/$preset" --parallel "$(nproc)" ${1:+--target "$@"} | tail -n 3
  [ "${PIPESTATUS[0]}" -eq 0 ] || die "the build failed: cmake --build build/$preset shows why"
}
