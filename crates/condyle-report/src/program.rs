//! The interactive part of a page: the program, the scenes that it shows, and the policy that permits no other script.

use std::{borrow::Cow, io::Write};

use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::ZlibEncoder};

use crate::scene::Scene;

/// Returns the program: `web/src/report.ts`, bundled and deflated by `web/build.mjs`.
///
/// In a browser it is a file, which the web page loads only when a report is saved; `None` if that is missing.
fn program() -> Option<Cow<'static, [u8]>> {
    if cfg!(target_family = "wasm") {
        std::fs::read("moving.js.zz").ok().map(Cow::Owned)
    } else {
        Some(Cow::Borrowed(include_bytes!("page/moving.js.zz")))
    }
}

/// The licences of the packages in the program.
const LICENCES: &str = include_str!("page/moving.licences.txt");
/// The script that starts the program.
const LOADER: &str = include_str!("page/loader.js");
/// The hashes of the program and of its loader, as a content security policy lists them.
const SCRIPT_HASHES: &str = include_str!("page/moving.hashes.txt");

/// Returns the content security policy of a page: nothing from a network, and no script; the program of [`moving`] if the
/// page has it.
pub(crate) fn policy(has_program: bool) -> String {
    let scripts = if has_program {
        SCRIPT_HASHES.trim()
    } else {
        "'none'"
    };
    format!(
        "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; \
         form-action 'none'"
    )
}

/// Returns the program and the scenes that it shows as HTML: scene 0 in the element with `data-scene="scene-0"`, and so on.
/// `None` if a scene is empty or there is no program.
pub(crate) fn moving(scenes: &[&Scene]) -> Option<String> {
    let mut html = String::new();
    for (number, scene) in scenes.iter().enumerate() {
        html += &data(&format!("scene-{number}"), &packed(scene)?);
    }
    html += &data("program", &STANDARD.encode(program()?));
    html += &data("licences", LICENCES);
    html += &format!("<script>{LOADER}</script>\n");
    Some(html)
}

/// Returns an element whose text the browser does not run.
fn data(id: &str, text: &str) -> String {
    format!("<script type=\"text/plain\" id=\"{id}\">{text}</script>\n")
}

fn packed(scene: &Scene) -> Option<String> {
    if scene.is_empty() {
        return None;
    }
    let mut deflated = ZlibEncoder::new(Vec::new(), Compression::new(6));
    let written = deflated.write_all(&scene.to_bytes());
    let scene = written.and_then(|()| deflated.finish());
    Some(STANDARD.encode(scene.expect("writing to memory cannot fail")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_permit_no_script_but_the_program_and_its_loader() {
        assert!(policy(false).contains("script-src 'none'"));
        let policy = policy(true);
        assert_eq!(policy.matches("'sha256-").count(), 2);
        assert!(policy.starts_with("default-src 'none'") && !policy.contains("http"));
        // An attribute of HTML in double quotes holds it.
        assert!(!policy.contains('"') && !policy.contains('\n'));
    }

    #[test]
    fn the_licences_of_the_packages_accompany_their_code() {
        for package in ["three 0.", "uplot 1."] {
            assert!(LICENCES.contains(package), "{package}");
        }
        assert!(!LICENCES.contains("</script"));
        assert_eq!(moving(&[&Scene::default()]), None);
    }
}
