//! The catalogue in other languages: a JSON schema, and types for Python and TypeScript.

use serde_json::{Value, json};

use super::{
    CycleQuantity, KNEE,
    catalogue::{self, PARTS, PartKind, Scalar},
    insert_fields::NODE_FIELDS,
    tables::WEAR_COLUMNS,
};

/// Returns a JSON schema of `summary.json`, with the columns of `wear.csv` and `kinematics.csv` and the fields of
/// `insert_*.vtu` under `tables` and `node_fields`.
pub fn results_schema() -> String {
    let mut properties = serde_json::Map::new();
    let mut required = Vec::new();
    for scalar in catalogue::scalars() {
        properties.insert(scalar.key.to_owned(), schema_of(scalar));
        required.extend(scalar.is_always_there().then_some(scalar.key));
    }
    for part in PARTS {
        let mut schema = match part.kind {
            PartKind::Text => json!({"type": "string"}),
            PartKind::Texts => json!({"type": "array", "items": {"type": "string"}}),
            PartKind::Object => json!({"type": "object"}),
            PartKind::ObjectOrNull => json!({"type": ["object", "null"]}),
            PartKind::Objects => json!({"type": "array", "items": {"type": "object"}}),
        };
        schema["description"] = part.about.into();
        properties.insert(part.key.to_owned(), schema);
        required.extend(part.is_always_there.then_some(part.key));
    }
    let column = |name: &str, about: &str| json!({"name": name, "description": about.trim()});
    let wear = WEAR_COLUMNS.iter().map(|one| column(one.name, one.about));
    let of_knee = KNEE.columns.iter();
    let of_knee = of_knee.map(|&quantity| column(KNEE.column(quantity), &description(quantity)));
    let kinematics = [
        column("cycles", "Cycles done before the cycle."),
        column("percent", "End of the increment, % of the cycle."),
    ];
    let fields = NODE_FIELDS.iter().map(|one| column(one.name, one.about));
    let schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "summary.json of condyle",
        "type": "object",
        "properties": properties,
        "required": required,
        "tables": {
            "wear.csv": wear.collect::<Vec<_>>(),
            "kinematics.csv": kinematics.into_iter().chain(of_knee).collect::<Vec<_>>(),
        },
        "node_fields": fields.collect::<Vec<_>>(),
    });
    serde_json::to_string_pretty(&schema).expect("text and numbers always serialise") + "\n"
}

/// Returns a description of a column of `kinematics.csv`.
fn description(quantity: CycleQuantity) -> String {
    match quantity {
        CycleQuantity::Position(joint) => {
            let joint = KNEE.joint(joint);
            format!("{}; {} is positive.", joint.title, joint.positive)
        }
        CycleQuantity::AxialForce => "Load that presses the bodies together.".to_owned(),
        CycleQuantity::ContactArea => "Area in contact.".to_owned(),
        CycleQuantity::PeakPressure => "Highest pressure anywhere on the surface.".to_owned(),
        CycleQuantity::RegionForce(region) => {
            format!(
                "Part of the axial force on the {} side.",
                KNEE.regions[region].name
            )
        }
    }
}

fn schema_of(scalar: &Scalar) -> Value {
    let joints: Vec<&str> = scalar.joints.iter().map(|joint| joint.name()).collect();
    let mut schema = json!({
        "type": if scalar.is_count { "integer" } else { "number" },
        "title": scalar.label,
        "description": scalar.documentation(),
        "unit": scalar.unit(),
        "error": scalar.error.description(),
    });
    if !joints.is_empty() {
        schema["joints"] = joints.into();
    }
    schema
}

/// `python/condyle/_summary.py`: the attributes of a result that come from `summary.json`.
pub fn python_types() -> String {
    let mut text = String::from(
        "\"\"\"The entries of ``summary.json``; written by ``cargo run -p condyle-results --example result_types``.\"\"\"\n\n\
         from __future__ import annotations\n\nfrom typing import Any\n\n__all__ = [\"Summary\"]\n\n\n\
         class Summary:\n    \"\"\"The entries of ``summary.json`` as attributes; a run does not have all of them.\"\"\"\n\n",
    );
    let mut add = |key: &str, kind: &str, about: &str| {
        text += &format!("    {key}: {kind}\n    \"\"\"{about}\"\"\"\n");
    };
    for scalar in catalogue::scalars() {
        let kind = if scalar.is_count { "int" } else { "float" };
        let unit = match scalar.unit() {
            "" => String::new(),
            unit => format!(" In {unit}."),
        };
        add(scalar.key, kind, &(scalar.description().to_owned() + &unit));
    }
    for part in PARTS {
        let kind = match part.kind {
            PartKind::Text => "str",
            PartKind::Texts => "list[str]",
            PartKind::Object => "dict[str, Any]",
            PartKind::ObjectOrNull => "dict[str, Any] | None",
            PartKind::Objects => "list[dict[str, Any]]",
        };
        add(part.key, kind, &part.about.replace('`', "``"));
    }
    text
}

/// `web/src/page/catalogue.ts`: the entries of `summary.json`, and those that the page shows in large type.
pub fn typescript_types() -> String {
    let mut text = String::from(
        "// The entries of summary.json; written by `cargo run -p condyle-results --example result_types`.\n\n\
         export interface Numbers {\n",
    );
    for scalar in catalogue::scalars() {
        let mark = if scalar.is_always_there() { "" } else { "?" };
        text += &format!("  {}{mark}: number;\n", scalar.key);
    }
    text += "}\n\nexport interface Headline {\n  key: keyof Numbers;\n  label: string;\n  unit: string;\n  isShare: boolean;\n}\n\n\
             export const HEADLINES: Headline[] = [\n";
    for scalar in catalogue::headlines() {
        let (key, label, is_share) = (scalar.key, scalar.label, scalar.is_share);
        let unit = scalar.shown_unit();
        text += &format!(
            "  {{ key: \"{key}\", label: \"{label}\", unit: \"{unit}\", isShare: {is_share} }},\n"
        );
    }
    text + "];\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn python_and_typescript_have_the_catalogue() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        for (file, declared) in [
            ("python/condyle/_summary.py", python_types()),
            ("web/src/page/catalogue.ts", typescript_types()),
        ] {
            // A crate that was unpacked alone has neither.
            let Ok(text) = std::fs::read_to_string(format!("{root}/{file}")) else {
                continue;
            };
            assert!(
                text == declared,
                "{file} is out of date; run: cargo run -q -p condyle-results --example result_types"
            );
        }
    }

    #[test]
    fn the_schema_describes_every_number() {
        let schema: Value = serde_json::from_str(&results_schema()).expect("is JSON");
        let mass = &schema["properties"]["mass_loss_mg"];
        assert_eq!(
            (&mass["type"], &mass["unit"]),
            (&json!("number"), &json!("mg"))
        );
        assert_eq!(
            schema["properties"]["ap_range_mm"]["joints"],
            json!(["knee"])
        );
        assert_eq!(schema["properties"]["updates"]["type"], "integer");
        assert_eq!(schema["tables"]["wear.csv"][1]["name"], "mass_loss_mg");
        let required = schema["required"].as_array().expect("is a list");
        assert!(required.contains(&json!("plausibility")) && !required.contains(&json!("creep")));
    }
}
