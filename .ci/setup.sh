# Sourced by quickstart and check: installs the Debian packages that are not there yet.
packages_build="cmake ninja-build ccache g++ pkg-config libopenvdb-dev libboost-dev libglm-dev libembree-dev libgrpc++-dev
  protobuf-compiler protobuf-compiler-grpc libprotobuf-dev libopenimageio-dev libtbb-dev libtomlplusplus-dev
  libcli11-dev libspdlog-dev nlohmann-json3-dev libnetcdf-dev libssl-dev libnova-dev zlib1g-dev gnuplot-nox"
# The second line: programs that open what Sunfleck writes (a browser, GDAL, xarray); tests without them skip aloud.
packages_test="libgtest-dev libbenchmark-dev libopenvdb-tools netcdf-bin
  chromium gdal-bin python3-netcdf4 python3-xarray"

say() { printf '\n== %s\n' "$*"; }

install_packages() {
  local missing=()
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "These packages are missing and need root or sudo to install: ${missing[*]}" >&2; exit 1; }
    root=(sudo)
  fi
  say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  "${root[@]}" apt-get update -q
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}
