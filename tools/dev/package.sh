# Packages for others, in target/packages: crates, a wheel, a tarball of npm, a package of Debian. Each is installed into an
# empty place, and drives one press of a simulated floor there. Read by `dev`.

# It links wheels for systems older than this one.
zig=ziglang==0.15.2
cargo_tools+=(cargo-deb@3.8.0)

packages=${CARGO_TARGET_DIR:-target}/packages
parts=tools/dev/package

# Metadata, links and files of crates; builds none.
crates_could_be_packed() {
    if command -v python3 >/dev/null; then
        step python3 -B "$parts/check.py" >&2
    else
        lacks "python3 is missing, so nothing checks the metadata of crates"
    fi
}

# The tools of packing alone, not those of all tests.
install_package_tools() {
    local python
    mkdir -p "$tools"
    export PATH=$(realpath "$tools")/python/bin:$(realpath "$tools")/bin:$PATH
    install_python
    python=$tools/python/bin/python
    "$python" -c 'import ziglang' 2>/dev/null \
        || install_step "$python" -m pip install --quiet --disable-pip-version-check "$zig"
    command -v npm >/dev/null || install_step apt_install nodejs npm
    [ -d bindings/web/node_modules/ws ] || install_step make_web bindings/web
    has_cargo deb || install_cargo cargo-deb
    hash -r
    "$python" -c 'import maturin, ziglang' || die "maturin and $zig are needed for the wheel"
    has_cargo deb || die "cargo-deb is needed: cargo install cargo-deb --version $(version_of cargo-deb)"
    command -v npm >/dev/null || die "npm is needed"
}

# Makes and tries all of them.
package() {
    local start=$SECONDS empty release=${CARGO_TARGET_DIR:-target}/release
    [ "$(uname -m)" = x86_64 ] || die "packages are made on Linux on x86_64"
    install_package_tools
    crates_could_be_packed
    rm -rf "$packages/made"
    mkdir -p "$packages/made"
    packages=$(realpath "$packages")
    empty=$(mktemp -d)
    package_crates "$empty/crates"
    package_web "$empty/web"
    package_wheel "$empty/wheel"
    package_deb "$empty/deb"
    try_web "$empty/web" "$empty/deb/usr/bin/underfoot"
    rm -rf "$empty"
    say "packages, each tried in an empty place, in $((SECONDS - start)) s:"
    (cd "$packages/made" && du --apparent-size --bytes -- *)
}

# Runs a command that prints the events of `home`: exactly one press and one click are right.
one_press() {
    local printed
    say "one press: $*"
    printed=$("$@") || die "failed: $*"
    [ "$(sort <<<"$printed")" = $'home clicked\nhome pressed\nhome released' ] || die "not one press of home: $printed"
    printf '   home was pressed and clicked, once\n' >&2
}

# The files of crates, and a project that has nothing but them and the crates of others.
package_crates() {
    local empty=$1 crate crates dirty=() version
    git diff --quiet HEAD || { say "with changes that are not committed"; dirty=(--allow-dirty); }
    # Outside of the folder of other builds: the profiles differ.
    local cargo=(env CARGO_TARGET_DIR="$packages/cargo" CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=false)
    # A floor in real time needs a little optimisation; code that is only compiled needs none.
    local running=("${cargo[@]}" CARGO_PROFILE_DEV_OPT_LEVEL=1 cargo)
    cargo+=(CARGO_PROFILE_DEV_OPT_LEVEL=0 cargo)
    mapfile -t crates < <(python3 -B "$parts/check.py" --order)
    rm -rf "$packages/cargo/package"
    step "${cargo[@]}" package "${crates[@]/#/--package=}" --locked --quiet --no-verify "${dirty[@]}"
    mkdir -p "$empty/crates" "$empty/app/src"
    version=$(workspace_version)
    # The files take the place of the registry, which does not have them yet.
    cat >"$empty/app/Cargo.toml" <<END
[package]
name = "press"
edition = "2024"

[dependencies]
underfoot = { version = "$version", default-features = false, features = ["net"] }
underfoot-sim = "$version"

[patch.crates-io]
END
    for crate in "${crates[@]}"; do
        cp "$packages/cargo/package/$crate-$version.crate" "$packages/made/"
        tar --extract --gzip --file "$packages/made/$crate-$version.crate" --directory "$empty/crates"
        printf '%s = { path = "../crates/%s-%s" }\n' "$crate" "$crate" "$version" >>"$empty/app/Cargo.toml"
        folders_of "$empty/crates/$crate-$version"
    done
    cp "$parts/press.rs" "$empty/app/src/main.rs"
    cp Cargo.lock "$empty/app/"
    one_press "${running[@]}" run --quiet --offline --manifest-path "$empty/app/Cargo.toml" -- "$(realpath "$parts/press.ron")"
    # Each is compiled as the registry would get it, with its dependencies as they would be there.
    step "${cargo[@]}" publish --workspace --dry-run --locked --quiet "${dirty[@]}"
}

workspace_version() { sed -n '/^\[workspace.package\]/,/^$/s/^version = "\(.*\)"/\1/p' Cargo.toml; }

# How many files and bytes each folder of a folder has.
folders_of() {
    printf '%s:' "$(basename "$1")"
    (cd "$1" && find . -type f -printf '%P %s\n') | awk '
        { split($1, part, "/"); at = index($1, "/") ? part[1] "/" : $1; files[at]++; bytes[at] += $2 }
        END { for (at in files) if (at ~ /\/$/) printf " %s %d files, %d kB;", at, files[at], bytes[at] / 1000
              for (at in files) if (at !~ /\/$/) printf " %s", at
              print "" }'
}

# A tarball of npm, in an empty folder; `try_web` presses once the program is there.
package_web() {
    local empty=$1 archive
    mkdir -p "$empty"
    archive=$packages/made/$(npm pack ./bindings/web --silent --pack-destination "$packages/made")
    tar --list --verbose --gzip --file "$archive"
    echo '{ "private": true, "type": "module" }' >"$empty/package.json"
    step npm install --prefix "$empty" --offline --silent --no-audit --no-fund "$archive"
    cp "$parts/press.mjs" "$empty/"
}

try_web() { one_press node "$parts/web.mjs" "$2" "$1"; }

# A wheel for systems with glibc 2.17 and newer, in an empty environment.
package_wheel() {
    local empty=$1 python=$tools/python/bin/python wheel
    step "$python" -m maturin build --release --locked --quiet --zig --compatibility manylinux2014 \
        --manifest-path bindings/python/Cargo.toml --out "$packages/made"
    wheel=$(echo "$packages"/made/underfoot-*.whl)
    "$python" -m zipfile --list "$wheel"
    step python3 -m venv "$empty"
    step "$empty/bin/pip" install --quiet --disable-pip-version-check --no-index "$wheel"
    one_press "$empty/bin/python" "$parts/press.py" layouts/map.ron "$parts/press.ron"
}

# A package of Debian, in an empty root.
package_deb() {
    local root=$1 made archive
    build_web
    made=$release/packaged
    UNDERFOOT_WEB_PACKED=$(packed_web) step cargo build --release --locked --quiet -p underfoot-cli --features web-edition
    rm -rf "$made"
    mkdir -p "$made"
    "$release/underfoot" man --out "$made/man"
    # Debian's rules want them so; cargo-deb leaves them as they are.
    gzip -9n "$made"/man/*.1
    "$release/underfoot" completions bash >"$made/underfoot.bash"
    "$release/underfoot" completions fish >"$made/underfoot.fish"
    "$release/underfoot" completions zsh >"$made/_underfoot"
    step cargo deb --package underfoot-cli --no-build --locked --quiet --output "$packages/made/"
    archive=$(echo "$packages"/made/underfoot_*.deb)
    dpkg-deb --info "$archive"
    dpkg-deb --contents "$archive"
    step dpkg-deb --extract "$archive" "$root"
    step desktop_files "$root"
    one_press session_in "$root" "$(realpath "$parts/press.ron")"
}

# The tools that read these files read them.
desktop_files() {
    local root=$1 page
    if command -v desktop-file-validate >/dev/null; then
        desktop-file-validate "$root/usr/share/applications/underfoot.desktop" || return
    fi
    for page in "$root"/usr/share/man/man1/*.gz; do
        gzip --decompress --stdout "$page" | grep -q '^\.SH NAME' || return
    done
    bash -n "$root/usr/share/bash-completion/completions/underfoot"
}

# The events of `home` in a session of the installed program, with nothing else of it on the path.
session_in() (
    cd "$1"
    PATH=$1/usr/bin:/usr/bin:/bin underfoot session map --scenario "$2" --out "$1/session" >&2 || return
    sed -n 's/.*"event":"\(pressed\|released\|cancelled\|clicked\)".*"id":"home".*/home \1/p' "$1/session/events.jsonl"
)
