#!/usr/bin/env bash
# Tests of the package, each for one run of CTest (tests/CMakeLists.txt):
#
#   package.sh install | symbols | header | find_package | mpi | pkg_config | subdirectory | whole_subdirectory | static |
#              without_opencl
#
# In the environment: SOURCE, BUILD and VERSION of flaunay, WORK (a folder to work in), CMAKE, CC and CXX.
# WORK/prefix is what install installs, the only thing that find_package and pkg_config know of flaunay; static tests
# the installation that whole_subdirectory leaves in WORK/static.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
prefix="$WORK/prefix"
# What programs ask for: before 1.0.0, a library of the same minor version.
soname="libflaunay.so.$(sed -E 's/^(0\.[0-9]+|[1-9][0-9]*)\..*/\1/' <<<"$VERSION")"
static="$WORK/static"
has_c=false
[[ ! -e $SOURCE/src/include/flaunay/flaunay.h ]] || has_c=true

fail() {
  echo "package.sh: $*" >&2
  exit 1
}

# consumers_of FOLDER: the consumers that are built there.
consumers_of() {
  echo "$1/consumer"
  ! $has_c || echo "$1/consumer_c"
}

# run_consumers FOLDER: runs them; they need none of the libraries that flaunay is built from.
run_consumers() {
  local program
  for program in $(consumers_of "$1"); do
    "$program"
    if ldd "$program" | grep -iE 'boost|fmt|not found'; then
      fail "$program needs these"
    fi
  done
}

# uses_installed FOLDER: they load the library of the prefix.
uses_installed() {
  local program needed loaded
  for program in $(consumers_of "$1"); do
    # Into variables first: grep -q would end the pipe, and with pipefail the test, before they are through.
    needed="$(readelf -d "$program")"
    [[ $needed == *"[$soname]"* ]] || fail "$program does not ask for $soname"
    loaded="$(ldd "$program" | grep libflaunay)"
    [[ $loaded == *"=> $prefix/"*"/$soname "* ]] || fail "$program loads another library: $loaded"
  done
}

# configure FOLDER ARGUMENTS...: the project beside this script, without optimisation and debug information, which compiles
# fastest.
configure() {
  local folder=$1
  shift
  "$CMAKE" -S "$here" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_C_COMPILER="$CC" \
    -DCMAKE_CXX_COMPILER="$CXX" -DFLAUNAY_HAS_C=$has_c "$@"
}

# with_pkg_config FOLDER PREFIX [--static]: builds them without CMake.
with_pkg_config() {
  local folder=$1 flags libraries
  PKG_CONFIG_PATH="$(dirname "$(find "$2" -name flaunay.pc)")"
  export PKG_CONFIG_PATH
  pkg-config --exact-version="$VERSION" flaunay
  read -ra flags <<<"$(pkg-config --cflags flaunay)"
  read -ra libraries <<<"$(pkg-config --libs "${@:3}" flaunay)"
  mkdir -p "$folder"
  "$CXX" -std=c++17 -Wall -Wextra -Werror "${flags[@]}" "$here/main.cpp" -o "$folder/consumer" "${libraries[@]}"
  if $has_c; then
    "$CC" -std=c99 -Wall -Wextra -Werror "${flags[@]}" "$here/main.c" -o "$folder/consumer_c" "${libraries[@]}"
  fi
}

case "$1" in
  install)
    # And moved, which it is to withstand.
    rm -rf "$prefix" "$prefix.first"
    "$CMAKE" --install "$BUILD" --prefix "$prefix.first"
    mv "$prefix.first" "$prefix"
    [[ -x $prefix/bin/flaunay ]] || fail 'the command is not installed'
    for file in bash-completion/completions/flaunay fish/vendor_completions.d/flaunay.fish man/man1/flaunay.1 \
      zsh/site-functions/_flaunay; do
      [[ -s $prefix/share/$file ]] || fail "share/$file is not installed"
    done
    if grep -rIlF -e "$SOURCE" -e "$BUILD" -e "$prefix" "$prefix"; then
      fail 'these name the folder of the source, of the build or of the installation'
    fi
    for binary in "$prefix"/bin/flaunay* "$prefix"/lib*/libflaunay*.so; do
      if readelf -d "$binary" | grep -E 'R(UN)?PATH' | grep -vF '[$ORIGIN]'; then
        fail "$binary has a path"
      fi
    done
    ;;

  find_package)
    rm -rf "$WORK/find_package"
    # What only flaunay itself is built from might as well not be there.
    configure "$WORK/find_package" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_DISABLE_FIND_PACKAGE_OpenCL=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON
    "$CMAKE" --build "$WORK/find_package"
    run_consumers "$WORK/find_package"
    uses_installed "$WORK/find_package"
    ;;

  mpi)
    rm -rf "$WORK/mpi"
    "$CMAKE" -S "$here/mpi" -B "$WORK/mpi" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER="$CXX" \
      -DCMAKE_PREFIX_PATH="$prefix"
    "$CMAKE" --build "$WORK/mpi"
    printed="$(mpirun --allow-run-as-root --oversubscribe -n 3 "$WORK/mpi/consumer_mpi")"
    [[ $printed == '9 points, 8 triangles, 8 hull vertices' ]] || fail "it printed $printed"
    loaded="$(ldd "$WORK/mpi/consumer_mpi" | grep libflaunay)"
    [[ $loaded == *"=> $prefix/"*"/${soname/flaunay/flaunay_mpi} "* ]] || fail "it loads another library: $loaded"
    # The header alone, strictly.
    echo '#include <flaunay/mpi.hpp>' >"$WORK/mpi/header.cpp"
    read -ra flags <<<"$(pkg-config --cflags ompi-c)"
    "$CXX" -std=c++17 -Wall -Wextra -Wpedantic -Werror -I "$prefix/include" "${flags[@]/#-I/-isystem}" \
      -DOMPI_SKIP_MPICXX -c "$WORK/mpi/header.cpp" -o "$WORK/mpi/header.o"
    ;;

  pkg_config)
    with_pkg_config "$WORK/pkg_config" "$prefix"
    export LD_LIBRARY_PATH="${PKG_CONFIG_PATH%/pkgconfig}"
    run_consumers "$WORK/pkg_config"
    uses_installed "$WORK/pkg_config"
    ;;

  subdirectory | whole_subdirectory)
    # As a part of another project, without what this does not call: configured, with some of it compiled; or all of it,
    # which takes minutes.
    configure "$WORK/subdirectory" -DFLAUNAY_SOURCE="$SOURCE" -DFLAUNAY_RESEARCH=OFF -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON
    if [[ $1 == subdirectory ]]; then
      exec "$CMAKE" --build "$WORK/subdirectory" --target flaunay_kernels flaunay_system flaunay_format
    fi
    "$CMAKE" --build "$WORK/subdirectory" --parallel 1
    run_consumers "$WORK/subdirectory"
    rm -rf "$static"
    "$CMAKE" --install "$WORK/subdirectory" --prefix "$static"
    ;;

  without_opencl)
    # Without the headers of OpenCL, flaunay is configured, and two files that use them compile: the macro makes the real
    # ones empty, if they are installed. The build for JavaScript compiles all of the library in this way.
    "$CMAKE" -S "$SOURCE" -B "$WORK/without_opencl" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER="$CXX" \
      -DFLAUNAY_OPENCL=OFF -DCMAKE_DISABLE_FIND_PACKAGE_OpenCL=ON -DCMAKE_UNITY_BUILD=OFF \
      -DCMAKE_CXX_FLAGS="-D__OPENCL_CL_H"
    "$CMAKE" --build "$WORK/without_opencl" --target host/CMakeFiles/flaunay_host.dir/{memory/arena,opencl/device}.cpp.o
    ;;

  static)
    rm -rf "$WORK/static_find_package"
    configure "$WORK/static_find_package" -DCMAKE_PREFIX_PATH="$static" -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON
    "$CMAKE" --build "$WORK/static_find_package"
    run_consumers "$WORK/static_find_package"
    with_pkg_config "$WORK/static_pkg_config" "$static" --static
    run_consumers "$WORK/static_pkg_config"
    library="$(stat -c %s "$(find "$static" -name libflaunay.a)")"
    for program in $(consumers_of "$WORK/static_find_package") $(consumers_of "$WORK/static_pkg_config"); do
      (($(stat -c %s "$program") < library / 2)) || fail "$program contains what it does not call"
    done
    ;;

  symbols)
    # Exported is what a header marks, and all of it.
    headers="$prefix/include/flaunay"
    find "$prefix" -name 'libflaunay*.so' -exec nm -D --defined-only -C {} + | sed '/^$/d; /:$/d' | cut -d ' ' -f 3- | sed -E 's/^(typeinfo name|typeinfo|vtable) for //; s/\[abi:cxx11\]//' |
      sort -u >"$WORK/exported"
    # A function's name may be on the line below its type.
    marked="$(sed -E '/FLAUNAY_API [^(;{]*$/{N; s/\n */ /}' "$headers"/*.h* | sed -nE '/^#/d; s/^ *(class|struct) FLAUNAY_API ([A-Za-z_]+).*/\2/p; t
      s/^ *FLAUNAY_API [^(]*[ *&]([A-Za-z_]+|operator[^(]+)\(.*/\1/p' | sort -u)"
    [[ -n $marked ]] || fail 'no header marks anything'
    failed=false
    # flaunay::NAME(...), flaunay::CLASS::NAME(...), the same in flaunay::research and flaunay::mpi or, in C, flaunay_NAME.
    while read -r symbol; do
      name="${symbol%%(*}"
      name="${name#flaunay::}"
      name="${name#research::}"
      name="${name#mpi::}"
      owner="${name%%::*}" member="${name#*::}"
      # A marked class or function, or a marked member of a class of the headers.
      if [[ $symbol == flaunay[:_]* && $member != *::* ]] && { grep -qxF -e "$owner" <<<"$marked" ||
        { grep -qhE "^ *(class|struct) $owner\b" "$headers"/*.hpp && grep -qxF -e "$member" <<<"$marked"; }; }; then
        continue
      fi
      echo "exported, but not marked in a header: $symbol"
      failed=true
    done <"$WORK/exported"
    while read -r name; do
      if ! grep -qE "(^|::)${name//+/\\+}(\$|\(|::)" "$WORK/exported"; then
        echo "marked in a header, but not exported: $name"
        failed=true
      fi
    done <<<"$marked"
    ! $failed || fail 'the library exports other symbols than its headers mark'
    echo "$(wc -l <"$WORK/exported") symbols, all of them public"
    ;;

  header)
    # Each header alone, strictly, and without what flaunay itself is built from.
    rm -rf "$WORK/header"
    mkdir -p "$WORK/header"
    cd "$WORK/header"
    warnings=(-Wall -Wextra -Wpedantic -Werror -I "$prefix/include")
    for header in flaunay device_memory research chunks; do
      echo "#include <flaunay/$header.hpp>" >"$header.cpp"
      "$CXX" -std=c++17 "${warnings[@]}" -c "$header.cpp" -MD -MF "$header.d"
      "$CXX" -std=c++17 "${warnings[@]}" -c "$header.cpp" -DFLAUNAY_STATIC
    done
    if $has_c; then
      echo '#include <flaunay/flaunay.h>' >flaunay.c
      "$CC" -std=c99 "${warnings[@]}" -c flaunay.c -MD -MF flaunay_c.d
    fi
    if grep -E '/(CL|boost|fmt)/' ./*.d; then
      fail 'the public headers include these'
    fi
    for _ in 1 2 3 4 5; do
      begin="$(date +%s%N)"
      "$CXX" -std=c++17 "${warnings[@]}" -c flaunay.cpp
      echo $((($(date +%s%N) - begin) / 1000000))
    done | sort -n | sed -n '3s/.*/flaunay.hpp alone compiles in & ms, median of 5/p'
    ;;

  *) fail "unknown test $1" ;;
esac
