# The web edition: the window as WebAssembly, in a folder of static files. Read by `dev`.

# The proposals that the compiler uses; every browser since March 2023 has them. Without simd128, the painter of letters
# computes each of its vectors number by number, in a megabyte of code.
wasm_features=(bulk-memory mutable-globals multivalue nontrapping-float-to-int reference-types sign-ext simd)

# Flags of the compiler for the page, in cargo's encoding: that proposal, and panics without the paths of this computer.
page_flags() {
    printf -- '-Ctarget-feature=+simd128\x1f--remap-path-prefix=%s=' "${CARGO_HOME:-$HOME/.cargo}/registry/src/"
}

# The version of wasm-bindgen in Cargo.lock; its program must be of the very same one.
bindgen_version() { sed -n '/^name = "wasm-bindgen"$/{n;s/version = "\(.*\)"/\1/p}' Cargo.lock; }

# Needs of the web edition's build beyond the program's.
install_web_tools() {
    local version; version=$(bindgen_version)
    rustup target add wasm32-unknown-unknown 2>/dev/null \
        || die "the target wasm32-unknown-unknown is needed: rustup target add wasm32-unknown-unknown"
    bindgen=$tools/wasm-bindgen-$version/bin/wasm-bindgen
    [ -x "$bindgen" ] || CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_LTO=off \
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 install_step cargo install --quiet --root "$tools/wasm-bindgen-$version" \
        --version "=$version" wasm-bindgen-cli --bin wasm-bindgen
    [ -x "$bindgen" ] || die "wasm-bindgen $version could not be installed: cargo install wasm-bindgen-cli --version $version"
    local wanted=crates/underfoot-web/package.json
    if command -v npm >/dev/null && ! cmp -s "$wanted" crates/underfoot-web/node_modules/made_from.json; then
        install_step npm install --silent --no-audit --no-fund --no-package-lock --prefix crates/underfoot-web
        cp "$wanted" crates/underfoot-web/node_modules/made_from.json || true
    fi
}

# The folder of the page, and that of the compressed page. Pages for tests lie apart from those that `./dev run` builds in.
web_folder() { echo "${CARGO_TARGET_DIR:-target}/${page_of_tests:+tests/}web"; }
packed_web() { echo "$(realpath "${CARGO_TARGET_DIR:-target}")/${page_of_tests:+tests/}web-packed"; }

# Compresses the files of the page for programs that serve it with a floor: the feature web-edition of underfoot-cli takes
# them in. `served.js` is the program's own.
pack_web() {
    local made=$1 packed file
    packed=$(packed_web)
    rm -rf "$packed"
    mkdir -p "$packed"
    for file in index.html page.css page.js files.js underfoot.js underfoot.wasm; do
        gzip -9nc "$made/$file" >"$packed/$file.gz"
    done
    cat "$packed"/*.gz | sha256sum | cut -c 1-16 >"$packed/version"
}

# Makes the folders target/web and target/web-packed. With `page_of_tests`, those for tests: without the minutes that the
# last tenths of its size take.
build_web() {
    local target=${CARGO_TARGET_DIR:-target} bindgen built optimiser=crates/underfoot-web/node_modules/.bin/wasm-opt
    local made profile=page${page_of_tests:+-of-tests}; made=$(web_folder)
    install_web_tools
    CARGO_ENCODED_RUSTFLAGS=$(page_flags) step cargo rustc --locked --profile "$profile" --target wasm32-unknown-unknown -p underfoot-web --lib --crate-type cdylib
    built=$target/wasm32-unknown-unknown/$profile/underfoot_web.wasm
    rm -rf "$made"
    mkdir -p "$(dirname "$made")"
    local flags=(--target web --no-typescript --remove-producers-section --out-name underfoot --out-dir "$made")
    if [ -x "$optimiser" ]; then
        step "$bindgen" "${flags[@]}" "$built"
        # In the order of their names, functions that are alike lie beside each other: gzip saves a twentieth. The names
        # themselves are left out. -Oz takes two minutes, and what it makes is smaller only before gzip.
        step "$optimiser" --reorder-functions-by-name "${wasm_features[@]/#/--enable-}" "$made/underfoot_bg.wasm" -o "$made/underfoot.wasm"
        rm "$made/underfoot_bg.wasm"
    else
        lacks "npm is missing, so wasm-opt does not make the page smaller"
        step "$bindgen" "${flags[@]}" --remove-name-section "$built"
        mv "$made/underfoot_bg.wasm" "$made/underfoot.wasm"
    fi
    cp crates/underfoot-web/page/* "$made"
    # Browsers that have an older version stored take this one when the text of offline.js differs.
    sed -i.old "s/VERSION/$(cat "$made"/* | sha256sum | cut -c 1-16)/" "$made/offline.js"
    rm "$made/offline.js.old"
    pack_web "$made"
    say "$made: $(wc -c <"$made/underfoot.wasm") bytes of WebAssembly, $(gzip -9c "$made/underfoot.wasm" | wc -c) with gzip"
    [ -z "${page_of_tests:-}" ] || return 0
    say "try it: python3 -m http.server --bind 127.0.0.1 --directory $made 8000, then http://127.0.0.1:8000"
    say "or with a floor, since \`./dev run\` builds it in from now on: ./dev run run map --web 127.0.0.1:9002"
}
