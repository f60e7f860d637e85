# Date, commit and output of stored evidence. Sourced by the parts of scripts/evidence.

date=$(date -u +%Y-%m-%d)
commit=$(git rev-parse --short HEAD)
# A change of pages and stored results, which studies write, does not change the program.
if ! git diff --quiet HEAD -- crates cases Cargo.toml Cargo.lock; then
    commit="$commit, with changes"
fi

# Puts a file between the lines `<!-- results -->` and `<!-- end of results -->` of a page.
put_into_page() {
    local page=$1 file=$2 whole
    whole=$(mktemp)
    awk -v file="$file" '
        /<!-- end of results -->/ { skip = 0 }
        !skip { print }
        /<!-- results -->/ { print ""; while ((getline line < file) > 0) print line; print ""; skip = 1 }
    ' "$page" > "$whole"
    cat "$whole" > "$page"
    rm "$whole"
}
