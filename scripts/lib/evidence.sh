# Date, commit and output of stored evidence. Sourced by the parts of scripts/evidence.

date=$(date -u +%Y-%m-%d)
commit=$(git rev-parse --short HEAD)
# A change of pages and stored results, which studies write, does not change the program.
if ! git diff --quiet HEAD -- crates cases Cargo.toml Cargo.lock; then
    commit="$commit, with changes"
fi

# Puts a file between the lines `<!-- results -->` and `<!-- end of results -->` of a page; a page with several such parts has
# another name in place of `results`.
put_into_page() {
    local page=$1 file=$2 name=${3:-results} whole
    whole=$(mktemp)
    awk -v file="$file" -v name="$name" '
        $0 == "<!-- end of " name " -->" { skip = 0 }
        !skip { print }
        $0 == "<!-- " name " -->" { print ""; while ((getline line < file) > 0) print line; print ""; skip = 1 }
    ' "$page" > "$whole"
    cat "$whole" > "$page"
    rm "$whole"
}
