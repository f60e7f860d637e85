//! Pictures as PNG, without a browser.

use std::sync::Arc;

use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{Options, Tree, fontdb::Database},
};

/// Fonts of the pictures, independent of the fonts of the machine: the same picture has the same bytes everywhere.
const FONTS: [&[u8]; 2] = [
    include_bytes!("../fonts/Inter-Regular-subset.otf"),
    include_bytes!("../fonts/Inter-SemiBold-subset.otf"),
];

/// Returns the bytes of a PNG file of a picture with `dots` dots per point; `None` if `svg` is not a picture or has
/// no size.
pub fn png(svg: &str, dots: f32) -> Option<Vec<u8>> {
    let mut fonts = Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family("Inter");
    let options = Options {
        fontdb: Arc::new(fonts),
        font_family: "Inter".to_owned(),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).ok()?;
    let size = tree.size().to_int_size().scale_by(dots)?;
    let mut dots_of = Pixmap::new(size.width(), size.height())?;
    resvg::render(
        &tree,
        Transform::from_scale(dots, dots),
        &mut dots_of.as_mut(),
    );
    dots_of.encode_png().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::svg_file;

    const WHITE: [u8; 4] = [255; 4];

    /// Dots of a picture that are not white.
    fn inked(svg: &str) -> usize {
        let bytes = png(svg, 1.0).expect("is a picture");
        let dots = Pixmap::decode_png(&bytes).expect("is a PNG");
        let inked = dots.data().chunks(4).filter(|dot| *dot != WHITE);
        inked.count()
    }

    #[test]
    fn a_picture_has_its_shapes_and_its_letters() {
        let square = r#"<path class="last" d="M10 10H60V60"/>"#;
        let letters = "Wear \u{2212}0.4 mm\u{b2}";
        let lettered = format!(r#"{square}<text x="10" y="80">{letters}</text>"#);
        let [bare, shape, both] =
            ["", square, &lettered].map(|body| inked(&svg_file("a", "b", (200.0, 100.0), body)));
        assert_eq!(bare, 0);
        assert!(shape > 100 && both > shape + 100, "{shape} {both}");
        assert!(png("no picture", 1.0).is_none());
    }
}
