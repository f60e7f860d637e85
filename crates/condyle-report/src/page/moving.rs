//! The part of the page that moves: a program and what it shows, both compressed.

use std::io::Write;

use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::ZlibEncoder};
use serde::Serialize;

use crate::scene::Scene;

/// The program: `web/src/report.ts` as `web/build.mjs` bundles and deflates it.
const PROGRAM: &[u8] = include_bytes!("moving.js.zz");

/// The program and what it shows, as text of a page.
#[derive(Serialize)]
pub(super) struct Moving {
    program: String,
    scene: String,
}

impl Moving {
    /// What a scene has to show; none where that is nothing.
    pub fn of(scene: &Scene) -> Option<Self> {
        (scene.has_surface() || !scene.tables.is_empty()).then(|| Self {
            program: STANDARD.encode(PROGRAM),
            scene: STANDARD.encode(deflated(&scene.to_bytes())),
        })
    }
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
    encoder
        .write_all(bytes)
        .and_then(|()| encoder.finish())
        .expect("writing to memory cannot fail")
}
