# Sourced by ./etendue and ./test, with $root set: brings .venv up to date where it is not.
#
#   set_up run     what `etendue` needs: system packages, .venv, the package with its compiled core
#   set_up compare the same, and what reports need
#   set_up view    the same as run, and what a window needs
#   set_up test    all of these, and the tools of the tests
#   set_up slow    the same, and what the slow tests need besides
#
# A failure is one message on stderr and exit code 2; all that the steps print goes to $log.

packages="python3 python3-venv python3-dev g++ cmake ninja-build libembree-dev libtbb-dev libglm-dev"
# A window, and for its tests a screen where there is none.
window="libgl1 libgl1-mesa-dri libx11-6 libxext6 libxcursor1 libxrandr2 libxinerama1 libxi6"
screen=xvfb
venv=$root/.venv
log=$root/build/set-up.log

# A Python that is active in the caller's shell must not reach into ours.
unset PYTHONHOME PYTHONPATH VIRTUAL_ENV

set_up() {
    sources=$(fingerprint)
    up_to_date "$1" || (build_up "$1") || exit
}

# One hash over everything that asks for a new build when it changes. By content, not by time: a checkout of another
# branch and back costs nothing, and neither does a fresh copy of the tree. The build uses all instructions of its
# processor, and would die on one that lacks some: of a container's image, say, that is run elsewhere.
fingerprint() {
    cd "$root" && {
        echo "$root"
        grep -m 1 -E '^(flags|Features)' /proc/cpuinfo 2>/dev/null
        find src CMakeLists.txt pyproject.toml tools/setup.sh -type f -print0 | sort -z | xargs -0 sha256sum
    } | sha256sum
}

# Is .venv made of these sources, by the Python that would run it?
up_to_date() {
    [ -x "$venv/bin/python" ] && [ -r "$venv/.set-up-$1" ] && read -r made <"$venv/.set-up-$1" &&
        [ "$made" = "$sources $(readlink -f "$venv/bin/python")" ]
}

# Runs in a subshell, so that its PATH, its folder and its lock end with it.
build_up() {
    mkdir -p "$root/build" 2>/dev/null && [ -w "$root" ] || fail "cannot write in $root, where .venv and build belong"
    exec 9<"$root/tools/setup.sh"
    if ! flock -n 9; then
        say "waiting for another set-up of $root"
        flock 9
        sources=$(fingerprint)
        up_to_date "$1" && return
    fi
    : >"$log" || fail "cannot write $log"
    cd "$root" || fail "cannot enter $root"

    # The system's compiler and libraries, never those of an active conda or pyenv, where CMake looks because of PATH.
    PATH=$venv/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
    [ -z "${CONDA_PREFIX-}" ] || unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS CMAKE_ARGS CMAKE_PREFIX_PATH

    case $1 in
        run) extras="" levels=run ;;
        compare) extras="" levels="run compare" ;;
        view) extras="[viewer]" levels="run view" packages="$packages $window" ;;
        test) extras="[viewer,dev]" levels="run compare view test" packages="$packages $window $screen" ;;
        slow)
            extras="[viewer,dev,judge,browser]" levels="run compare view test slow"
            packages="$packages $window $screen valgrind $(browser)"
            ;;
    esac
    install_packages
    make_venv
    step "building Étendue (minutes the first time)" build ".$extras"
    # Apart from the build, because what is compiled here brings build tools of its own.
    case $levels in
        *compare*) step "installing what reports need" pip_install "etendue[compare]" ;;
    esac
    for level in $levels; do
        echo "$sources $(readlink -f "$venv/bin/python")" >"$venv/.set-up-$level"
    done
}

# The browser in which reports are tested, where there is a package of it.
browser() {
    apt-cache show chromium-headless-shell >/dev/null 2>&1 && echo chromium-headless-shell
}

install_packages() {
    command -v dpkg-query >/dev/null || return 0 # neither Debian nor Ubuntu: CMake names what it misses
    missing=
    for package in $packages; do
        dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null | grep -q '^.i' || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" = 0 ]; then
        sudo=
    elif sudo -n true 2>/dev/null; then
        sudo="sudo -n"
    else
        fail "system packages are missing; install them with: sudo apt-get install$missing"
    fi
    step "installing$missing" apt_install
}

# The package lists may be missing or too old to name a file that still exists; then they are fetched.
apt_install() {
    for attempt in "as it is" "with new lists"; do
        [ "$attempt" = "as it is" ] || $sudo apt-get update || return
        $sudo env DEBIAN_FRONTEND=noninteractive \
            apt-get install --yes --no-install-recommends -o DPkg::Lock::Timeout=300 $missing && return
    done
}

# A .venv that works is kept, whichever Python it was made with. One that was copied here with its folder runs the
# programs of its first home, and is made anew.
make_venv() {
    "$venv/bin/pip" --version 2>/dev/null | grep -qF "$venv/" && return
    for python in /usr/bin/python3 python3; do
        "$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null || continue
        step "making .venv with $("$python" --version)" "$python" -m venv --clear "$venv"
        return
    done
    fail "Python 3.10 or newer is needed, and neither /usr/bin/python3 nor python3 is one"
}

# The build tools of pyproject.toml are installed to stay: builds are then incremental and need no network.
build() {
    "$venv/bin/python" -c '
try:
    import tomllib
except ModuleNotFoundError:
    from pip._vendor import tomli as tomllib
with open("pyproject.toml", "rb") as file:
    print(*tomllib.load(file)["build-system"]["requires"], sep="\n")
' >build/requirements.txt &&
        pip_install --requirement build/requirements.txt &&
        pip_install --no-build-isolation --editable "$1"
}

pip_install() {
    "$venv/bin/python" -m pip --disable-pip-version-check --no-input install "$@"
}

# step WHAT COMMAND...: runs the command with its output in the log; a failure shows what looks like its cause.
step() {
    what=$1
    shift
    say "$what ..."
    printf '=== %s\n' "$what" >>"$log"
    "$@" >>"$log" 2>&1 </dev/null && return
    awk '/^=== / {n = 0}
         /subprocess|with status|Failed building/ {next} # what pip adds about itself
         tolower($0) ~ /error|^e: / && n < 5 {line[n++] = $0}
         END {for (i = 0; i < n; i++) print line[i]}' "$log" >&2
    fail "$what failed; all of its output is in $log"
}

say() { printf 'etendue: %s\n' "$1" >&2; }

fail() {
    say "$1"
    exit 2
}
