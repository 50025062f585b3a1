# Programs that the tests of `./dev test` use, beyond what a build needs. Each is installed only if it is missing: Debian's
# packages by apt, all others into target/tools, which `rm -r target/tools` takes away again. Read by `dev`.

tools=${CARGO_TARGET_DIR:-target}/tools

# Programs of the registry, each at the newest version that Rust 1.95 builds.
cargo_tools=(cargo-nextest@0.9.143 cargo-deny@0.20.2 cargo-c@0.10.21+cargo-0.95.0)

# Debian's packages for the tests, and how each is found: by a command, or by a file.
tool_packages() {
    local found
    found=$(ldconfig -p 2>/dev/null || /sbin/ldconfig -p 2>/dev/null || true)
    has() { command -v "$1" >/dev/null || [ -x "/usr/sbin/$1" ]; }
    # Saves killed at each of their system calls; a clock of one process set; a network that comes later.
    has strace || echo strace
    compgen -G '/usr/lib/*/faketime/libfaketimeMT.so.1' >/dev/null || echo libfaketime
    has ip || echo iproute2
    # The units are read, judged and started by systemd itself.
    has systemd-analyze || echo systemd
    # A sound card that keeps time, without hardware.
    has jackd || echo jackd2
    # MIDI through it.
    is_left_out jack || pkg-config --exists jack 2>/dev/null || echo libjack-jackd2-dev
    compgen -G '/usr/lib/*/alsa-lib/libasound_module_pcm_jack.so' >/dev/null || echo libasound2-plugins
    # Real windows with real input, on a display of their own.
    has Xvfb || echo xvfb
    has openbox || echo openbox
    has xdotool || echo xdotool
    has xclip || echo xclip
    grep -q 'libGL\.so\.1' <<<"$found" || echo libgl1
    compgen -G '/usr/lib/*/dri/swrast_dri.so' >/dev/null || echo libgl1-mesa-dri
    grep -q 'libxkbcommon-x11\.so\.0' <<<"$found" || echo libxkbcommon-x11-0
    grep -q 'libXcursor\.so\.1' <<<"$found" || echo libxcursor1
    grep -q 'libXi\.so\.6' <<<"$found" || echo libxi6
    # The floor's page in a browser.
    has chromium || has chromium-browser || has google-chrome || echo chromium
    has node || echo nodejs
    has npm || echo npm
    # It scrapes the floor's metrics.
    has prometheus || echo prometheus
    # A broker of MQTT, and its client.
    has mosquitto || echo mosquitto
    has mosquitto_sub || echo mosquitto-clients
    # The cluster's assembler, compiled for other systems.
    is_left_out other-systems || has clang || echo clang
    has python3 || echo python3
    python3 -c 'import ensurepip, venv' 2>/dev/null || echo python3-venv
}

# Debian's packages that build firmware and run it in an emulator.
emulator_packages() {
    ! is_left_out emulators || return 0
    command -v avr-g++ >/dev/null || echo gcc-avr
    [ -e /usr/lib/avr/include/avr/io.h ] || echo avr-libc
    [ -d /usr/share/arduino/hardware/arduino/avr/cores ] || echo arduino-core-avr
    [ -e /usr/include/simavr/sim_avr.h ] || echo libsimavr-dev
    [ -e /usr/include/libelf.h ] || echo libelf-dev
    command -v make >/dev/null || echo make
}

# Debian's packages of the programs that are worked by feet.
app_packages() {
    ! is_left_out apps || return 0
    command -v aeskulap >/dev/null || echo aeskulap
    command -v marble >/dev/null || echo marble
    command -v import >/dev/null || echo imagemagick
}

# Whether LEAVE_OUT, words with blanks between them, has this one.
is_left_out() { [[ " ${LEAVE_OUT:-} " == *" $1 "* ]]; }

# Reports a missing tool and the checks left out for it; the run goes on.
lacks() { say "NOT RUN: $*"; }

# Runs an installation and says how long it took; a failed one is reported, and costs the run only its own checks.
install_step() {
    local start=$SECONDS
    say "installing: $*"
    if "$@" >&2; then
        printf '   installed in %d s\n' $((SECONDS - start)) >&2
    else
        lacks "could not be installed: $*"
    fi
}

# Each list by itself: a package that cannot be had costs only the others of its list.
install_tool_packages() {
    local list packages
    for list in tool_packages emulator_packages app_packages; do
        mapfile -t packages < <("$list" | sort -u)
        [ ${#packages[@]} -gt 0 ] || continue
        if ! command -v apt-get >/dev/null; then
            lacks "tests skip what needs the equivalents of these Debian packages: ${packages[*]}"
        elif ! as_root true 2>/dev/null; then
            lacks "tests skip what needs these packages, which take root: apt-get install ${packages[*]}"
        else
            install_step apt_install "${packages[@]}"
        fi
    done
}

apt_install() {
    as_root apt-get update -qq || return
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"
}

# A Python of the tests' own, with tools/dev/python.txt; made anew when that changes.
install_python() {
    local wanted=tools/dev/python.txt made=$tools/python/made_from.txt
    cmp -s "$wanted" "$made" && return
    command -v python3 >/dev/null || { lacks "there is no python3, so nothing reads what we send"; return; }
    install_step make_python "$wanted" "$made"
}

make_python() {
    rm -rf "$tools/python"
    python3 -m venv "$tools/python" || return
    "$tools/python/bin/pip" install --quiet --disable-pip-version-check --requirement "$1" || return
    cp "$1" "$2"
}

# Packages of npm in place, in each folder of `npm_folders`; made anew when its package.json changes.
install_web() {
    local folder
    for folder in $(npm_folders); do
        cmp -s "$folder/package.json" "$folder/node_modules/made_from.json" && continue
        command -v npm >/dev/null || { lacks "there is no npm, so nothing opens the floor's page"; return; }
        install_step make_web "$folder"
    done
}

# The packages that lead the browser and read the floor; and the libraries of the example pages.
npm_folders() {
    { is_left_out bindings && is_left_out web; } || echo bindings/web
    is_left_out apps || echo bindings/web/examples
}

# The emulator of the Pico; installed again when package.json changes.
install_pico() {
    local wanted=firmware/emulate/package.json made=$tools/pico/made_from.json
    ! is_left_out emulators || return 0
    cmp -s "$wanted" "$made" && return
    command -v npm >/dev/null || { lacks "there is no npm, so no firmware of a Pico runs"; return; }
    install_step make_pico "$wanted" "$made"
}

make_pico() {
    mkdir -p "$tools/pico" && cp "$1" "$tools/pico/package.json" || return
    npm install --silent --no-audit --no-fund --no-package-lock --prefix "$tools/pico" || return
    cp "$1" "$2"
}

make_web() {
    npm install --silent --no-audit --no-fund --no-package-lock --prefix "$1" || return
    cp "$1/package.json" "$1/node_modules/made_from.json"
}

# Whether a program of cargo's works, such as `nextest`.
has_cargo() { cargo "$1" --version >/dev/null 2>&1; }

# The version of a program of `cargo_tools`.
version_of() {
    local tool
    for tool in "${cargo_tools[@]}"; do
        [ "${tool%%@*}" != "$1" ] || echo "${tool#*@}"
    done
}

install_cargo_tools() {
    has_cargo nextest || install_cargo cargo-nextest
    # To build these two takes minutes.
    ! is_left_out cargo-tools || return 0
    [[ $(cargo deny --version 2>/dev/null) == cargo-deny\ 0.20.* ]] || install_cargo cargo-deny
    has_cargo cinstall || install_cargo cargo-c
}

# Optimised little: these programs run for seconds, and building them takes minutes.
install_cargo() {
    CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
        install_step cargo install --quiet --locked --root "$tools" --version "=$(version_of "$1")" "$1"
}

# Says which tests pass without having tried anything, since a program of others is missing or this user may too little.
tools_note() {
    [ "$(uname)" = Linux ] || return 0
    local missing
    mapfile -t missing < <(tool_packages | sort -u)
    [ ${#missing[@]} = 0 ] || lacks "tests skip what needs these Debian packages: ${missing[*]}"
    python3 -c 'import pythonosc, pythontuio' 2>/dev/null \
        || lacks "python-osc and python-tuio are missing, so they read nothing that we send"
    python3 -c 'import zeroconf' 2>/dev/null || lacks "zeroconf is missing, so no other program looks for a floor by mDNS"
    python3 -c 'import sacn, stupidArtnet' 2>/dev/null \
        || lacks "sacn and stupidArtnet are missing, so no program of others receives our DMX"
    unshare --net true 2>/dev/null || unshare --user --map-root-user --net true 2>/dev/null \
        || lacks "no network namespace can be made here, so no network card comes late"
    as_root_quietly unshare --mount --pid --fork --cgroup true 2>/dev/null \
        || lacks "this user is neither root nor may use sudo without a password, so no systemd starts the unit"
}

# As a test does it, which asks nobody for a password.
as_root_quietly() {
    if [ "$(id -u)" = 0 ]; then "$@"
    else sudo -n "$@"; fi
}

# Installs all of them.
install_tools() {
    local start=$SECONDS
    mkdir -p "$tools"
    export PATH=$(realpath "$tools")/python/bin:$(realpath "$tools")/bin:$PATH
    [ "$(uname)" != Linux ] || install_tool_packages
    install_python
    install_web
    install_pico
    install_cargo_tools
    is_left_out web || [ -n "$(missing_for_web_edition)" ] || (install_web_tools) || lacks "the web edition cannot be built"
    # The shell forgets where it has found a python3 before.
    hash -r
    [ $((SECONDS - start)) -lt 2 ] || say "the tools of the tests were installed in $((SECONDS - start)) s"
}
