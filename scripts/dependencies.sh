# SPDX-License-Identifier: BSD-3-Clause
# Sourced by scripts/demo and scripts/test: which Debian packages are missing, and their installation.

REPOSITORY="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

die() {
  echo "error: $*" >&2
  exit 1
}

# list_packages GROUP...: packages of the groups.
list_packages() {
  local group
  for group in "$@"; do
    awk -v group="$group" '$1 == group { print $2 }' "$REPOSITORY/scripts/dependencies.txt"
  done
}

# list_missing GROUP...: those that are not installed.
list_missing() {
  local package
  for package in $(list_packages "$@"); do
    dpkg-query --show --showformat '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || echo "$package"
  done
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "installing packages needs root: run as root, or install sudo"
  fi
}

# confirm QUESTION: yes with --yes (ASSUME_YES=1), asks on a terminal, no otherwise.
confirm() {
  [ "${ASSUME_YES:-0}" -eq 1 ] && return 0
  [ -t 0 ] && [ -t 1 ] || return 1
  local answer
  read -r -p "$1 [Y/n] " answer
  [[ -z "$answer" || "$answer" =~ ^[Yy] ]]
}

# install_dependencies GROUP...: installs what is missing, or ends the script with the command that would.
install_dependencies() {
  command -v apt-get >/dev/null ||
    die "this script needs Debian's apt-get; on other systems install the packages of scripts/dependencies.txt by hand and use cmake"
  local missing
  mapfile -t missing < <(list_missing "$@")
  [ "${#missing[@]}" -gt 0 ] || return 0
  echo "missing packages: ${missing[*]}"
  confirm "install them with apt-get?" ||
    die "packages are missing; install them with --yes or by hand: apt-get install ${missing[*]}"
  as_root apt-get update -q || die "apt-get update failed: check the network and /etc/apt/sources.list"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" ||
    die "apt-get could not install the packages above"
}

# use_local_names: everything here runs on this machine. Where its own name cannot be resolved ROS would not find itself.
use_local_names() {
  ensure_localhost
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ] && ! getent hosts "$(uname -n)" >/dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}

# ensure_localhost: ROS asks the system for the address of "localhost", which a freshly made root cannot tell.
ensure_localhost() {
  getent hosts localhost >/dev/null && return 0
  echo "the name localhost cannot be resolved, which ROS needs: /etc/hosts lacks it"
  confirm "add \"127.0.0.1 localhost\" to /etc/hosts?" ||
    die "localhost is unknown; run with --yes or add the line \"127.0.0.1 localhost\" to /etc/hosts"
  echo "127.0.0.1 localhost" | as_root tee -a /etc/hosts >/dev/null || die "/etc/hosts cannot be written"
}

# use_system_python: ROS tools need the python3 that Debian's packages belong to; another one may stand before it.
use_system_python() {
  [ -x /usr/bin/python3 ] && PATH="/usr/bin:$PATH"
  export PATH
}

# source_space SETUP_FILE: catkin's setup files are not made for `set -eu`.
source_space() {
  set +eu
  # shellcheck disable=SC1090
  source "$1"
  local status=$?
  set -eu
  return "$status"
}
