//! `condyle plot`.

use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use condyle_report::{Picture, Results, pictures};
use condyle_results::PLOTTED;

use crate::{
    arguments::{PictureFormat, Plot},
    exit,
    output::{self, Lines},
    report::note_unfinished,
    standard_error::tell,
};

const MAKES_PNG: bool = cfg!(feature = "png");

pub fn plot(arguments: &Plot) -> ExitCode {
    if !MAKES_PNG && arguments.format.contains(&PictureFormat::Png) {
        let said = "this condyle was built without PNG; build it with: \
                    cargo install --path crates/condyle-cli --features png, or take SVG";
        return exit::fail(said, exit::BAD_INPUT);
    }
    let results = match Results::read_readable(&arguments.results) {
        Ok(results) => results,
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    };
    for why in &results.left_out {
        tell(format_args!("warning: not drawn: {why}"));
    }
    note_unfinished(&arguments.results);
    let default = || arguments.results.join(PLOTTED.folder);
    let folder = arguments.out.clone().unwrap_or_else(default);
    let mut lines = Lines::default();
    for (path, bytes) in files(arguments, &pictures(&results)) {
        let path = folder.join(path);
        let written = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, bytes));
        if let Err(error) = written {
            let said = format!("{}: {error}; choose another folder", path.display());
            return exit::fail(said, exit::BAD_INPUT);
        }
        lines.line(format_args!("wrote {}", path.display()));
    }
    if lines.text().is_empty() {
        let said = format!("{} holds nothing to draw", arguments.results.display());
        return exit::fail(said, exit::BAD_INPUT);
    }
    output::print(lines.text())
}

fn files(arguments: &Plot, pictures: &[Picture]) -> Vec<(PathBuf, Vec<u8>)> {
    let is_asked = |format| arguments.format.is_empty() || arguments.format.contains(&format);
    let mut files = Vec::new();
    for picture in pictures {
        let name = Path::new(picture.name);
        if is_asked(PictureFormat::Svg) {
            files.push((name.with_extension("svg"), picture.svg.clone().into_bytes()));
        }
        if is_asked(PictureFormat::Png) {
            let png = png(&picture.svg, arguments.dots);
            files.extend(png.map(|bytes| (name.with_extension("png"), bytes)));
        }
    }
    files
}

#[cfg(feature = "png")]
fn png(svg: &str, dots: u8) -> Option<Vec<u8>> {
    let bytes = condyle_report::png(svg, f32::from(dots));
    Some(bytes.expect("our own pictures are pictures"))
}

#[cfg(not(feature = "png"))]
fn png(_: &str, _: u8) -> Option<Vec<u8>> {
    None
}
