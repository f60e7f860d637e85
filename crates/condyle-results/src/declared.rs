//! The catalogue as a JSON schema.

use serde_json::{Value, json};

use super::{
    CycleQuantity, KNEE,
    catalogue::{self, Scalar},
    insert_fields::NODE_FIELDS,
    summary::{PARTS, PartKind, json_text},
    tables::WEAR_COLUMNS,
};

/// Returns a JSON schema of `summary.json`, with the columns of `wear.csv` and `kinematics.csv` and the fields of
/// `insert_*.vtu` under `tables` and `node_fields`.
pub fn results_schema() -> String {
    let mut properties = serde_json::Map::new();
    let mut required = Vec::new();
    for scalar in catalogue::scalars() {
        properties.insert(scalar.key.to_owned(), schema_of(scalar));
        let is_required = scalar.is_always_there() && scalar.joints.is_empty();
        required.extend(is_required.then_some(scalar.key));
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
    json_text(&schema)
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

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(
            required.contains(&json!("plausibility"))
                && !required.contains(&json!("max_penetration_mm"))
                && !required.contains(&json!("ap_range_mm"))
        );
    }
}
