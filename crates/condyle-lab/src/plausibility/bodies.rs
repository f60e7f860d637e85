//! Checks of the places where an insert wears and of the pressures that it bears.

use condyle::{
    geometry::{ArticulatingSurface, Dishes},
    machine::{Chain, TestedJoint},
    spatial::Pose,
};
use condyle_case::case::BuildWarning;
use condyle_results::{
    PlausibilityWarning,
    catalogue::{
        BACKSIDE_LIFT_MM, MAX_DEPTH_MM, MAX_PLASTIC_STRAIN, PEAK_CONTACT_AREA_MM2,
        PEAK_PRESSURE_CYCLE, PEAK_PRESSURE_MPA,
    },
    point_on_side, with_digits,
};

use super::finished::{Finished, SolvedCycle, percent_of, warning};

/// Distance from the rim, mm, within which a foundation over-estimates pressure and the pressure of an elastic body
/// is unbounded: about the reach of the neighbours that are missing there.
const NEAR_RIM_MM: f64 = 1.5;
const MAX_AT_RIM_PERCENT: f64 = 1.0;
/// Yield stress of UHMWPE, MPa (approximate: quoted from memory).
const YIELD_MPA: f64 = 14.0;
/// Ratio of the peak pressure under a ball to the yield stress at which the material first yields, below the middle
/// of the contact [johnson1985].
const FIRST_YIELD: f64 = 1.6;
/// Ratio of the peak pressure to the yield stress at full plasticity: the mean pressure is then 2.8 times the yield
/// stress, and the peak of an elastic contact is 1.5 times its mean [johnson1985].
const FULL_FLOW: f64 = 1.5 * 2.8;
/// Lift off the tray beyond which an insert rocks, mm: twice the deflection of the polyethylene under a knee's load.
const MAX_LIFT_MM: f64 = 0.3;
/// Thickness below which the stresses in polyethylene rise steeply, mm [bartel1986]; approximate.
const MIN_THICKNESS_MM: f64 = 6.0;
/// Depth of the scar's edge, as a part of the deepest wear.
const SCAR: f64 = 0.1;

/// Number of faces below which the contact of a deformable insert is too coarse: below 20, areas were up to 70 % and stresses up to
/// 130 % from those of finer meshes, and the stated errors a tenth.
const MIN_FACES: f64 = 20.0;

/// Part of a specimen's surface in contact in the first cycle from which it is the end of a pin.
const WHOLE_END: f64 = 0.95;

/// Largest part of the contact on the eminence between the dishes, %; our choice: sound knees have none.
const MAX_ON_EMINENCE_PERCENT: f64 = 5.0;

fn tests(finished: &Finished<'_>) -> TestedJoint {
    finished.march.test().machine().mechanism.tests
}

pub(crate) fn wear_at_rim(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    // A worn cup embraces its head up to the rim: there only a high pressure at the rim is a reason to doubt.
    if tests(finished) == TestedJoint::Hip || is_end_of_pin(finished) {
        return None;
    }
    let depth_mm = &finished.march.fields().wear_depth_mm;
    let (mut whole, mut at_rim) = (0.0, 0.0);
    for (node, share) in finished.surface.shares.iter().enumerate() {
        let volume_mm3 = depth_mm[node] * share.area_mm2;
        whole += volume_mm3;
        if volume_mm3 > 0.0 && finished.distance_to_rim_mm(node) < NEAR_RIM_MM {
            at_rim += volume_mm3;
        }
    }
    let percent = percent_of(at_rim, whole);
    let message = format!(
        "{percent:.2} % of the worn volume lies within {NEAR_RIM_MM} mm of the rim of the articulating surface; up to \
             {MAX_AT_RIM_PERCENT:.0} % is acceptable"
    );
    let advice = "The counterface bears on an edge, where the pressure of an elastic model is unreliable: check the placement \
                 of the bodies, their axes and sides, and the place where the outline of the insert was cut.";
    let value = (percent, MAX_AT_RIM_PERCENT, "%");
    (percent > MAX_AT_RIM_PERCENT).then(|| warning("wear_at_rim", value, message, advice))
}

/// Returns whether the surface is the end of a pin, which is pressed and worn up to its rim.
fn is_end_of_pin(finished: &Finished<'_>) -> bool {
    let pressures_mpa = &finished.march.state().first_pressure_mpa;
    let shares = finished.unworn.shares.iter().zip(pressures_mpa);
    let (mut whole_mm2, mut pressed_mm2) = (0.0, 0.0);
    for (share, pressure_mpa) in shares {
        whole_mm2 += share.area_mm2;
        if *pressure_mpa > 0.0 {
            pressed_mm2 += share.area_mm2;
        }
    }
    tests(finished) == TestedJoint::Specimen && pressed_mm2 > WHOLE_END * whole_mm2
}

/// Warns if the node with the highest pressure, in the first or the last cycle, lies within 1.5 mm of the rim.
pub(crate) fn pressure_at_rim(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    if is_end_of_pin(finished) {
        return None;
    }
    let at_rim = pressures(finished)
        .into_iter()
        .filter_map(|(cycle, pressures, _)| {
            let pressed = pressures.iter().copied().enumerate();
            let (node, highest) = pressed.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let from_rim_mm = finished.distance_to_rim_mm(node);
            let is_at_rim = highest > 0.0 && from_rim_mm < NEAR_RIM_MM;
            is_at_rim.then_some((from_rim_mm, highest, node, cycle))
        });
    let (from_rim_mm, highest, node, cycle) = at_rim.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let place = point_on_side(&finished.surface.positions[node], finished.side);
    let message = format!(
        "the {cycle} cycle's highest pressure of a node, {highest:.1} MPa, is {from_rim_mm:.2} mm from the rim, at x {:.1} mm, z \
             {:.1} mm",
        place.x, place.z
    );
    let advice =
        "The counterface bears on an edge: check the placement, axes and sides of the bodies.";
    let value = (from_rim_mm, NEAR_RIM_MM, "mm");
    Some(warning("pressure_at_rim", value, message, advice))
}

/// The name of a cycle, the highest pressure at every surface node, MPa, and the surface on which it was solved.
type Pressures<'a> = (&'static str, &'a [f64], &'a ArticulatingSurface);

/// Returns the pressures in the first and in the last cycle.
fn pressures<'a>(finished: &'a Finished<'_>) -> Vec<Pressures<'a>> {
    let state = finished.march.state();
    let first = ("first", &state.first_pressure_mpa[..], &finished.unworn);
    // After a single update, too, the final cycle is solved on the worn surface.
    let last = state.fields.as_ref();
    let last = last.map(|fields| ("last", &fields.peak_pressure_mpa[..], &finished.surface));
    [first].into_iter().chain(last).collect()
}

/// Warns of pressure above that at which polyethylene flows.
pub(crate) fn pressure_beyond_flow(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let limit = FULL_FLOW * YIELD_MPA;
    let peak = finished.summary[&PEAK_PRESSURE_MPA];
    let message = format!(
        "the highest pressure is {peak:.1} MPa, after {:.0} cycles; polyethylene flows from about {limit:.0} MPa, so this \
             pressure is not physical",
        finished.summary[&PEAK_PRESSURE_CYCLE]
    );
    let of_joint = match tests(finished) {
        TestedJoint::Knee => "that of a knee",
        _ => "this load needs",
    };
    let advice = format!(
        "Check the sizes, units, axes, sides and placement of both bodies, and the load: the contact is far smaller than {of_joint}."
    );
    let value = (peak, limit, "MPa");
    (peak > limit).then(|| warning("pressure_beyond_flow", value, message, &advice))
}

/// The effect of local yield in three knees, and the error of the pressure of a foundation by the linear law
/// (`docs/src/three-models.md`).
const IN_KNEES: [&str; 2] = [
    "which occurs in ordinary knees and changes the mass of three of them by less than 0.1 % and their depth by at most 2 %",
    " By the linear law, a foundation overestimates the pressure, by 18 to 40 % in three unworn knees; --set contact.model=deformable avoids this.",
];
/// The same where neither was computed.
const NOT_KNOWN: [&str; 2] = [
    "whose effect on the wear is not known here",
    " A foundation neglects the support by the polyethylene around the contact; --set contact.model=deformable includes it.",
];

/// Warns of pressure at which polyethylene would yield below the surface, for an insert that is modelled without
/// yield.
pub(crate) fn pressure_beyond_yield(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let limit = FIRST_YIELD * YIELD_MPA;
    let peak = finished.summary[&PEAK_PRESSURE_MPA];
    let extents = || {
        let cycles = pressures(finished).into_iter();
        let extents = cycles.map(|cycle| extent(finished, cycle, limit));
        extents.collect::<Vec<_>>().join("; ")
    };
    let yields = finished.summary.get(&MAX_PLASTIC_STRAIN).is_some();
    let message = format!(
        "the highest pressure is {peak:.1} MPa, and polyethylene yields below the surface from about {limit:.1} MPa; {}",
        extents()
    );
    let is_solid = finished.march.state().under_surface.is_some();
    let [effect, of_foundation] = match tests(finished) {
        TestedJoint::Knee if peak <= FULL_FLOW * YIELD_MPA => IN_KNEES,
        _ => NOT_KNOWN,
    };
    // Yield lowers the peak of a solid; the error of a foundation has either sign.
    let of_model = if is_solid {
        " The pressure is an upper bound."
    } else {
        of_foundation
    };
    let advice = format!("The model does not include local yield, {effect}.{of_model}");
    let value = (peak, limit, "MPa");
    (peak > limit && !yields).then(|| warning("pressure_beyond_yield", value, message, &advice))
}

/// Returns the area above a limit of pressure at any instant of a cycle, and the time of the peak above it, in words.
fn extent(
    finished: &Finished<'_>,
    (cycle, pressures, surface): Pressures<'_>,
    limit_mpa: f64,
) -> String {
    let shares = pressures.iter().zip(&surface.shares);
    let above = shares.filter(|(pressure_mpa, _)| **pressure_mpa > limit_mpa);
    let area_mm2: f64 = above.map(|(_, share)| share.area_mm2).sum();
    let area = match area_mm2 {
        // The mean over a node's share is below the peak.
        0.0 => "no node exceeds this pressure".to_owned(),
        _ => format!(
            "an area of {} mm2 exceeds this pressure at some instant",
            with_digits(area_mm2, 0)
        ),
    };
    let solved = finished.cycles().filter(|solved| solved.name == cycle);
    let times = solved.map(|one| {
        let percent = one.percent_of_rows(|row| row.peak_pressure_mpa > limit_mpa);
        let of_activity = finished.activity_in_words(&one);
        format!("{percent:.0} % of the cycle{of_activity}")
    });
    let times = times.collect::<Vec<_>>().join(" and ");
    format!("in the {cycle} cycle, {area}; the peak exceeds it for {times}")
}

/// Warns of a contact of a deformable insert on so few faces that its errors are larger than stated.
pub(crate) fn contact_coarse(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let state = finished.march.state();
    let shares = finished.unworn.shares.iter().zip(&state.first_pressure_mpa);
    let pressed = shares.filter(|(_, pressure_mpa)| **pressure_mpa > 0.0);
    let (count, sum_mm2) = pressed.fold((0.0, 0.0), |(count, sum), (share, _)| {
        (count + 1.0, sum + share.area_mm2)
    });
    let faces = finished.summary[&PEAK_CONTACT_AREA_MM2] * count / sum_mm2;
    let message = format!(
        "the largest contact covers {faces:.0} faces of the surface: its pressure, area and stress are unreliable, and their stated \
         errors too small, below {MIN_FACES:.0}"
    );
    let advice = "Take a smaller edge_mm.";
    (state.under_surface.is_some() && faces < MIN_FACES && !is_end_of_pin(finished)).then(|| {
        warning(
            "contact_coarse",
            (faces, MIN_FACES, "faces"),
            message,
            advice,
        )
    })
}

/// Warns of a deformable insert with one layer, whose stress varies too little through its thickness.
pub(crate) fn single_layer(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let insert = finished.march.insert();
    let layers = insert.mesh().hexes.len() as f64 / insert.surface_faces().len() as f64;
    let message = "the insert has a single layer of hexahedra: its contact is too stiff, stress below the surface is not resolved, \
                   and the stated errors do not include this";
    let advice =
        "Take more layers: by default, their number follows from edge_mm and the thickness.";
    (finished.march.state().under_surface.is_some() && layers < 1.5).then(|| {
        warning(
            "single_layer",
            (layers, 2.0, "layers"),
            message.to_owned(),
            advice,
        )
    })
}

/// Warns of an insert that rocks on its tray; the lock of the model does not hold it down.
pub(crate) fn insert_rocks(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let lift_mm = finished.summary.get(&BACKSIDE_LIFT_MM)?;
    let message = format!(
        "the insert lifts off its tray by {lift_mm:.2} mm: it rocks, as under a load outside the flat part of its \
         backside, since nothing in the model holds it down"
    );
    let advice = "The lock of a real tray would: check whether the load lies within the tray, and set [contact.deformable] \
                 backside = \"bonded\" if the insert is held down.";
    let value = (lift_mm, MAX_LIFT_MM, "mm");
    (lift_mm > MAX_LIFT_MM).then(|| warning("insert_rocks", value, message, advice))
}

pub(crate) fn thin_polyethylene(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let fields = finished.march.fields();
    let in_scar = finished.summary[&MAX_DEPTH_MM] * SCAR;
    // At the rim the normal misses the backside, and `condyle check` leaves it out too.
    let nodes = (0..fields.wear_depth_mm.len()).filter(|node| !finished.is_on_rim(*node));
    let under_scar = nodes.filter(|node| fields.wear_depth_mm[*node] > in_scar);
    let thinnest = under_scar.map(|node| fields.thickness_mm[node]);
    let thinnest = thinnest.fold(f64::INFINITY, f64::min);
    let message = format!(
        "the thinnest polyethylene under the scar is {thinnest:.2} mm; stresses rise steeply below {MIN_THICKNESS_MM:.0} mm"
    );
    let advice = match tests(finished) {
        TestedJoint::Knee => {
            "Check that the insert's mesh reaches down to its tray and that its `length_unit` in the case is right."
        }
        _ => "Check its thickness in the case, or that of its mesh and `length_unit`.",
    };
    let value = (thinnest, MIN_THICKNESS_MM, "mm");
    (thinnest < MIN_THICKNESS_MM).then(|| warning("thin_polyethylene", value, message, advice))
}

/// Distance between the triangles of a femur and its smooth surface up to which the contact is right, mm: the chord error
/// of an export for manufacturing. Beyond it the triangles no longer determine the surface.
const MAX_DEVIATION_MM: f64 = 0.05;

/// Error of an insert's surface by its mesh up to which its contact is right, mm: twice the chord error of a fine export leaves
/// it, and where facets are divided into flat triangles, more of it changed the mass by 3 %.
const MAX_INSERT_ERROR_MM: f64 = 0.005;

/// Height of voids below the contact up to which an insert counts as solid, mm; our choice: faces of parts that touch, and
/// engraved marks, leave less.
const MAX_VOID_MM: f64 = 0.2;

/// Largest part of the contact, by overclosure, where the triangles of a body do not determine its surface, %; our choice:
/// in sound knees, up to 4 % lies at the sharp edges that the smooth surface rounds.
const MAX_ROUGH_PERCENT: f64 = 10.0;

/// Warns of a femur whose triangles are too coarse, or too rough, where they touch the insert in an activity.
pub(crate) fn femur_mesh(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let worn = finished.march.fields().wear_depth_mm.iter();
    let pressed = worn.zip(&finished.march.state().first_pressure_mpa);
    let pressed = pressed.map(|(worn, pressed)| worn + pressed > 0.0);
    let nodes: Vec<usize> = (0..)
        .zip(pressed)
        .filter_map(|(node, is)| is.then_some(node))
        .collect();
    let femur = finished.march.counterface();
    let at = |pose: &Pose, node: usize| {
        let place = pose.to_counterface(&finished.surface.positions[node]);
        // The overclosure is a measure of the pressure in every model.
        let overclosure_mm = (-femur.gap_mm(&place)).max(0.0);
        let pressed = overclosure_mm * finished.surface.shares[node].area_mm2;
        (pressed, femur.deviation_mm(&place))
    };
    let [name, _] = tests(finished).bodies();
    let advice = format!(
        "The mesh is too coarse, too rough, or has a sharp edge there: export the {name} with a chord error of at most 0.03 mm, \
         without decimation, smooth a scan, and round a sharp edge or keep it 3 mm away from the contact."
    );
    let is = format!("the smooth surface of the {name} is");
    let from = " from the triangles of its mesh";
    // A rare activity wears little, but its own row of results is as doubtful as if it were the only one.
    let cycles: Vec<SolvedCycle<'_>> = finished.cycles().collect();
    let activities = cycles.chunk_by(|a, b| a.activity == b.activity);
    let each = activities.filter_map(|cycles| {
        let poses = cycles.iter().flat_map(|cycle| poses(finished, cycle));
        let contact = poses.flat_map(|pose| nodes.iter().map(move |&node| at(&pose, node)));
        let of_activity = finished.activity_in_words(&cycles[0]);
        let words = (of_activity.as_str(), is.as_str(), from);
        rough("femur_mesh", words, MAX_DEVIATION_MM, contact, &advice)
    });
    each.max_by(|a, b| a.value.total_cmp(&b.value))
}

/// Warns of a femur of a knee that bears on the eminence between the dishes of the insert.
pub(crate) fn femur_on_eminence(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    if tests(finished) != TestedJoint::Knee {
        return None;
    }
    let unworn = &finished.unworn;
    let dishes = Dishes::find(&unworn.positions)?;
    let (mut whole_n, mut between_n) = (0.0, 0.0);
    for (node, pressure_mpa) in finished.march.state().first_pressure_mpa.iter().enumerate() {
        // Along the load: a cam presses a post from the side.
        let along = unworn.normals[node].y.max(0.0);
        let force_n = pressure_mpa * unworn.shares[node].area_mm2 * along;
        whole_n += force_n;
        if dishes.is_on_eminence(&unworn.positions[node]) {
            between_n += force_n;
        }
    }
    let percent = percent_of(between_n, whole_n);
    let message = format!(
        "{percent:.0} % of the contact of the first cycle is on the eminence between the dishes; up to \
             {MAX_ON_EMINENCE_PERCENT:.0} % is acceptable"
    );
    let advice = "The femur does not lie in the dishes: check that both bodies are of one implant, their length_unit, axes and \
                  start_mm; dishes of a larger coronal radius have a lower eminence.";
    let value = (percent, MAX_ON_EMINENCE_PERCENT, "%");
    (percent > MAX_ON_EMINENCE_PERCENT)
        .then(|| warning("femur_on_eminence", value, message, advice))
}

/// Warns of an insert whose triangles are too coarse where the femur touches them.
pub(crate) fn insert_mesh(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let [_, name] = tests(finished).bodies();
    let advice = format!(
        "The mesh is too coarse there: export the {name} with a chord error of at most 0.01 mm, without decimation or division of \
         its facets."
    );
    let is = format!("the surface of the {name} is uncertain by");
    let contact = pressed(finished, finished.march.insert().mesh_error_mm());
    rough(
        "insert_mesh",
        ("", &is, ""),
        MAX_INSERT_ERROR_MM,
        contact,
        &advice,
    )
}

/// Warns of contact above a slot, an undercut or a void of the insert.
pub(crate) fn hollow_insert(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let [_, name] = tests(finished).bodies();
    let advice = "The hexahedra fill the slot, undercut or void below the contact with polyethylene. If a part of the tray fills it, \
                  test a mesh whose backside is the upper face of the void; if it is empty, the body deflects more than computed.";
    let is = format!("the {name} below is hollow by");
    let contact = pressed(finished, finished.march.insert().void_mm());
    rough("hollow_insert", ("", &is, ""), MAX_VOID_MM, contact, advice)
}

/// Returns the force on each surface node in the first cycle, N, with its value.
fn pressed<'a>(
    finished: &'a Finished<'_>,
    values: &'a [f64],
) -> impl Iterator<Item = (f64, f64)> + 'a {
    let pressed_mpa = finished.march.state().first_pressure_mpa.iter();
    let force_n = pressed_mpa.zip(&finished.unworn.shares);
    let force_n = force_n.map(|(pressure_mpa, share)| pressure_mpa * share.area_mm2);
    force_n.zip(values.iter().copied())
}

/// Warns of the noise of a scan, whose peaks bear much of the load; the warning of the build names the mesh.
pub(crate) fn noisy_mesh(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let scatters_mm = finished
        .of_build
        .iter()
        .filter_map(BuildWarning::scatter_mm);
    let scatter_mm = scatters_mm.max_by(f64::total_cmp)?;
    let limit_mm = BuildWarning::MAX_SCATTER_MM;
    let message = format!(
        "the vertices of a mesh scatter by about {scatter_mm:.3} mm around a smooth surface, and up to {limit_mm} mm is acceptable: \
             the highest pressure is unreliable, up to a fifth too high at 0.01 mm, and more than doubled at 0.05 mm"
    );
    let advice = "A warning names the mesh: smooth it, or use the body from CAD.";
    Some(warning(
        "noisy_mesh",
        (scatter_mm, limit_mm, "mm"),
        message,
        advice,
    ))
}

/// Warns if too much of the contact lies where the distance of a surface, which both words describe, exceeds `limit_mm`. `contact`
/// has a measure of the force and the distance, mm, of each place.
fn rough(
    check: &'static str,
    (of_activity, is, from): (&str, &str, &str),
    limit_mm: f64,
    contact: impl Iterator<Item = (f64, f64)>,
    advice: &str,
) -> Option<PlausibilityWarning> {
    let (mut whole, mut doubtful, mut largest_mm): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for (pressed, deviation_mm) in contact {
        whole += pressed;
        if pressed > 0.0 && deviation_mm > limit_mm {
            doubtful += pressed;
            largest_mm = largest_mm.max(deviation_mm);
        }
    }
    let percent = percent_of(doubtful, whole);
    let message = format!(
        "in {percent:.0} % of the contact{of_activity}, {is} more than {limit_mm} mm (at most {largest_mm:.3} mm){from}; up to \
             {MAX_ROUGH_PERCENT:.0} % is acceptable"
    );
    let value = (percent, MAX_ROUGH_PERCENT, "%");
    (percent > MAX_ROUGH_PERCENT).then(|| warning(check, value, message, advice))
}

/// Largest part of a cycle during which a condyle may be beyond the rim, %; our choice.
const MAX_BEYOND_PERCENT: f64 = 1.0;
/// Distance within which a condyle counts as being at the surface, loaded or not, mm: the gap up to which a mesh's
/// field is reliable.
const NEAR_MM: f64 = 1.5;
/// Largest number of instants of a cycle that are examined.
const INSTANTS: usize = 50;

/// Part of a cycle, %, with the name of the side and the cycle in words.
type Beyond = (f64, &'static str, String);

/// Warns of a condyle that is nearest to the insert at the rim of the articulating surface, loaded there or not: its
/// middle is on the rim or beyond.
pub(crate) fn femur_beyond_rim(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let beyond = finished.cycles().flat_map(|cycle| beyond(finished, &cycle));
    let most = beyond.max_by(|a, b| a.0.total_cmp(&b.0));
    let (percent, side, cycle) = most.filter(|beyond| beyond.0 > MAX_BEYOND_PERCENT)?;
    let message = format!(
        "for {percent:.0} % of the {cycle} the {side} condyle is on or beyond the rim of the articulating surface"
    );
    let advice = "The counterface moves off the insert: check the placement of the bodies (start_mm, axes, sides), their sizes, \
                    loads and springs, and the place where the outline of the insert was cut.";
    let value = (percent, MAX_BEYOND_PERCENT, "%");
    Some(warning("femur_beyond_rim", value, message, advice))
}

/// Returns the poses of the femur at instants of a cycle.
fn poses(finished: &Finished<'_>, cycle: &SolvedCycle<'_>) -> Vec<Pose> {
    let test = finished.march.test();
    let machine = finished.machine(cycle);
    let chain = Chain::new(
        machine,
        finished.march.state().zero_mm,
        test.flexion_axis_mm,
    );
    // A gap at every node is slow: a coarse sample of the cycle is enough for a part of it.
    let every = cycle.rows.len().div_ceil(INSTANTS).max(1);
    cycle
        .rows
        .iter()
        .step_by(every)
        .map(|row| chain.at(&row.positions).pose)
        .collect()
}

/// Returns, for every side, the part of a cycle during which its condyle is nearest to the rim.
fn beyond(finished: &Finished<'_>, cycle: &SolvedCycle<'_>) -> Vec<Beyond> {
    let looked_at = poses(finished, cycle);
    let machine = finished.machine(cycle);
    let sides = machine.mechanism.regions.iter().enumerate();
    let of_side = |(side, region): (usize, &condyle::machine::Region)| {
        let at_rim = looked_at
            .iter()
            .filter(|pose| is_at_rim(finished, pose, side));
        let part = at_rim.count() as f64 / looked_at.len().max(1) as f64;
        (100.0 * part, region.name, finished.cycle_in_words(cycle))
    };
    sides.map(of_side).collect()
}

/// Returns whether the node of a side nearest to the femur is on the rim.
fn is_at_rim(finished: &Finished<'_>, pose: &Pose, side: usize) -> bool {
    let regions = finished.march.insert().regions();
    let nodes = finished.surface.positions.iter().enumerate();
    let of_side = nodes.filter(|(node, _)| regions.of_node(*node) == side);
    let gaps = of_side.map(|(node, place)| {
        (
            finished
                .march
                .counterface()
                .gap_mm(&pose.to_counterface(place)),
            node,
        )
    });
    let nearest = gaps.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.is_some_and(|(gap_mm, node)| gap_mm < NEAR_MM && finished.is_on_rim(node))
}
