//! The heading of a case, and the frames and units of the files that it names.

use condyle::{Mat3, Vec3};
use toml::Spanned;
use toml::de::DeValue;

use crate::config::*;

pub use condyle_results::Side;

words! {
    Side {
        Right = "right",
        Left = "left",
    }
}

settings! {
    /// The keys above the first table of a case.
    Heading {
        /// Title of the case, one line.
        title: String = "Untitled".to_owned();
        /// Side of the body. Left knees are mirrored on input and output, as are right hips and ankles, which stand upside down in their machines; a disc has no side.
        side: Side = Side::Right;
    }
}

settings! {
    /// The frame of a file and its place on the body.
    FileFrame {
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Anatomical directions of x, y and z of the file.
        axes: Axes = Axes::ISB;
        /// Rotation of the body after `axes`, about z, then x, then y of the frame; given as [x, y, z].
        rotation_deg: Option<[f64; 3]> = None, in within(-180.0, 180.0);
    }
}

/// Directions of x, y and z of a file, in anatomical words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    words: [&'static str; 3],
}

/// Words for the directions x, -x, y, -y, z and -z of the frame, and two that depend on the side.
const WORDS: &[&str] = &[
    "anterior",
    "posterior",
    "superior",
    "inferior",
    "right",
    "left",
    "medial",
    "lateral",
];

impl Axes {
    /// x anterior, y superior, z right: the frame of the insert.
    pub const ISB: Self = Self {
        words: ["anterior", "superior", "right"],
    };

    /// Creates the axes with the rotation `rotation` (see [`Axes::rotation`]), in words that do not depend on the
    /// side.
    pub fn of(rotation: &Mat3) -> Self {
        // Each column is the direction of an axis of the file; the nearest axis of the frame names it.
        let words = [0, 1, 2].map(|column| {
            let toward = rotation.column(column);
            let axis = toward.iamax();
            WORDS[2 * axis + usize::from(toward[axis] <= 0.0)]
        });
        Self { words }
    }

    /// Returns the words for x, y and z.
    pub fn words(&self) -> [&'static str; 3] {
        self.words
    }

    /// Returns the rotation from the file's frame to x anterior, y superior, z right of a `side` knee, before a left
    /// knee is mirrored.
    ///
    /// # Errors
    /// In words: two axes along one line, or a left-handed frame.
    pub fn rotation(&self, side: Side) -> Result<Mat3, &'static str> {
        let direction = |word| {
            let word = match (word, side) {
                ("lateral", Side::Right) | ("medial", Side::Left) => "right",
                ("lateral", Side::Left) | ("medial", Side::Right) => "left",
                (word, _) => word,
            };
            let place = WORDS.iter().position(|known| *known == word).unwrap_or(0);
            let axis: Vec3 = Vec3::ith(place / 2, 1.0);
            if place % 2 == 0 { axis } else { -axis }
        };
        let rotation = Mat3::from_columns(&self.words.map(direction));
        let determinant = rotation.determinant();
        // The determinant of three directions of the frame is 0, 1 or -1.
        if determinant.abs() < 0.5 {
            Err("two of the axes are parallel; give three perpendicular axes")
        } else if determinant < 0.0 {
            Err("these axes are left-handed, which would mirror the shape")
        } else {
            Ok(rotation)
        }
    }
}

impl Setting for Axes {
    fn kind() -> Kind {
        Kind::ThreeWords(WORDS)
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let Some(list) = value.get_ref().as_array().filter(|list| list.len() == 3) else {
            return wrong_type(value, key, log);
        };
        let words: Vec<Option<&str>> = list
            .iter()
            .map(|word| read_word(word, key, WORDS, log))
            .collect();
        let words: Vec<&str> = words.into_iter().collect::<Option<_>>()?;
        Some(Self {
            words: words.try_into().ok()?,
        })
    }

    fn text(&self) -> Option<String> {
        Some(format!("{:?}", self.words))
    }
}

/// Reports axes that do not form a right-handed frame on a `side` knee.
pub(crate) fn check_axes(axes: &Axes, side: Side, span: std::ops::Range<usize>, log: &mut Log<'_>) {
    if let Err(error) = axes.rotation(side) {
        let advice = "name where x, y and z of the file point; the third is the cross product of the first two, such as \
            [\"anterior\", \"superior\", \"right\"]";
        log.problem(span, Fault::new(format!("`axes`: {error}"), advice));
    }
}

choice! {
    /// Unit of length of a mesh file.
    LengthUnit {
        /// Millimetre.
        Millimetre = "mm",
        /// Centimetre.
        Centimetre = "cm",
        /// Metre.
        Metre = "m",
        /// Inch.
        Inch = "in",
    }
}

impl LengthUnit {
    /// Returns its length in mm.
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_axes_of_the_dm_meshes_turn_half_round_about_superior() {
        let axes = Axes {
            words: ["posterior", "superior", "left"],
        };
        let turned = axes.rotation(Side::Right).unwrap() * Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(turned, Vec3::new(-1.0, 2.0, -3.0));
    }

    #[test]
    fn verify_words_of_a_rotation_are_those_it_comes_from() {
        for words in [
            ["posterior", "superior", "left"],
            ["right", "anterior", "superior"],
        ] {
            let axes = Axes { words };
            assert_eq!(Axes::of(&axes.rotation(Side::Left).unwrap()), axes);
        }
    }

    #[test]
    fn lateral_depends_on_the_side() {
        let axes = Axes {
            words: ["anterior", "superior", "lateral"],
        };
        assert!(axes.rotation(Side::Right).is_ok());
        assert!(
            axes.rotation(Side::Left)
                .unwrap_err()
                .contains("left-handed")
        );
        let axes = Axes {
            words: ["left", "right", "superior"],
        };
        assert!(axes.rotation(Side::Right).unwrap_err().contains("parallel"));
    }
}
