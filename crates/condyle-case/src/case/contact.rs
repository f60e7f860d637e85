//! Model of contact, pressure law, friction, and how nodes that touch are found.

use condyle::contact::{Foundation, FrictionModel, PressureTable, Search, softening_modulus};

use super::deformable::BacksideChoice;
use super::deformable::PlasticityChoice;
use super::pressure_table::{StrainTable, WAYS, WAYS_OF_STRAIN};
use super::table::{Context, Table, WearLaws, WriteWaveform};
use crate::config::{
    Choices, Key, Log, Offered, Page, Section, Settings, TableSchema, Variants, Writer, choice,
    settings, variants, within,
};

choice! {
    /// What the insert is to the femur.
    ContactModelWord {
        /// A rigid body with an elastic layer on it, in which neighbours do not feel each other.
        Foundation = "foundation",
        /// An elastic body of finite elements, bonded to its tray.
        Deformable = "deformable",
    }

    /// How a deformable insert rubs.
    FrictionModelWord {
        /// Friction goes with the sliding speed, and does not move the surface.
        Regularised = "regularised",
        /// The surface gives way along itself, and each node sticks or slides.
        StickSlip = "stick-slip",
    }

    /// How the nodes that may touch are found.
    SearchWord {
        /// By bounds that are carried along as the femur moves.
        Coherent = "coherent",
        /// Every node is a candidate, every time.
        BruteForce = "brute-force",
    }
}

impl FrictionModelWord {
    /// The model that it stands for.
    pub fn model(self) -> FrictionModel {
        match self {
            Self::Regularised => FrictionModel::Regularised,
            Self::StickSlip => FrictionModel::StickSlip,
        }
    }
}

impl SearchWord {
    /// The search that it stands for.
    pub fn search(self) -> Search {
        match self {
            Self::Coherent => Search::Coherent,
            Self::BruteForce => Search::BruteForce,
        }
    }
}

settings! {
    /// The model of contact.
    ModelOfContact {
        /// What the insert is: an elastic foundation, quick, whose pressure follows a law; or a deformable body, exact for small strains, which has no law.
        model: ContactModelWord = ContactModelWord::Foundation;
    }

    /// Friction on a deformable insert.
    FrictionSettings {
        /// Regularised: friction goes with the sliding speed by slip_tolerance_mm_per_s. Stick-slip: the surface gives way along itself, and each node sticks or slides by Coulomb's law, without a tolerance; some seven times the time, and the implicit integrator alone.
        friction_model: FrictionModelWord = FrictionModelWord::Regularised;
    }

    /// Contact besides the pressure law.
    Friction {
        /// Coulomb coefficient of friction.
        friction: f64 = 0.07, in within(0.0, 2.0);
        /// Sliding speed at which friction is nearly full: smaller is truer and slower.
        slip_tolerance_mm_per_s: f64 = 0.3, in within(1e-6, 1000.0);
    }

    /// How contact is found; results do not depend on it, but for what a reused sample rounds.
    Finding {
        /// How the nodes that may touch are found; the results are the same, brute force is the slow reference.
        search: SearchWord = SearchWord::Coherent;
        /// Motion up to which a sample of the femur is extrapolated rather than taken anew, which changes the force by less than a hundred-thousandth; 0 takes every sample anew.
        sample_reuse_mm: f64 = Foundation::SAMPLE_REUSE_MM, in within(0.0, 0.02);
    }
}

settings! {
    /// How polyethylene softens under one stress: strain = e0/2 (stress/s0 + (stress/s0)^3).
    SofteningCurve {
        /// e0, the strain at the softening stress; Young's modulus is then 2 s0/e0, 616 MPa by default, and that of the material is not used. Approximate.
        softening_strain: f64 = 0.0597, in within(1e-4, 10.0);
        /// s0, the stress at which the strain is twice what the first modulus gives. Approximate.
        softening_stress_mpa: f64 = 18.4, in within(0.1, 10_000.0);
    }
}

impl SofteningCurve {
    /// Modulus of a confined layer at no pressure, MPa.
    pub(super) fn modulus_mpa(&self, poissons_ratio: f64) -> f64 {
        softening_modulus(
            self.softening_strain,
            self.softening_stress_mpa,
            poissons_ratio,
        )
    }
}

variants! {
    /// Pressure against overclosure; the modulus comes from the material.
    PressureLawChoice by
    /// Form of pressure against overclosure.
    law = "linear" {
        /// p = K d / h.
        Linear = "linear",
        /// p = -K ln(1 - d / h).
        Logarithmic = "logarithmic",
        /// d / h = (p / K) (1 + (p / s)^2), which softens as polyethylene does.
        Softening(SofteningCurve) = "softening",
        /// Points of pressure against overclosure.
        Tabulated(PressureTable) = "tabulated",
        /// Points of pressure against overclosure over thickness.
        TabulatedStrain(StrainTable) = "tabulated-strain",
    }
}

impl PressureLawChoice {
    /// By how much the peak pressure is off that of the deformable insert that the law was fitted to, %, if that is known.
    pub fn peak_error_percent(&self) -> Option<f64> {
        match self {
            Self::TabulatedStrain(table) => table.error.peak_error_percent,
            Self::Linear | Self::Logarithmic | Self::Softening(_) | Self::Tabulated(_) => None,
        }
    }
}

/// Model of contact, pressure law, friction, and how nodes that touch are found.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The model.
    pub model: ContactModelWord,
    /// Pressure against overclosure; of the foundation alone.
    pub law: PressureLawChoice,
    /// Whether and how the insert yields; of the deformable insert alone.
    pub plasticity: PlasticityChoice,
    /// How it rubs; of the deformable insert alone.
    pub friction_model: FrictionModelWord,
    /// What holds its backside; of the deformable insert alone.
    pub backside: BacksideChoice,
    /// Friction.
    pub friction: Friction,
    /// How contact is found.
    pub finding: Finding,
}

impl Contact {
    /// The keys that choose model and law, and those that `[contact]` has whatever they are.
    pub(super) fn keys() -> Vec<Key> {
        [
            ModelOfContact::keys(),
            vec![PressureLawChoice::choices().by],
            Self::keys_of_deformable(),
            Self::other_keys(),
        ]
        .concat()
    }

    /// The same but for those of a deformable insert alone.
    pub(super) fn keys_of_page() -> Vec<Key> {
        let of_deformable = Self::keys_of_deformable();
        let mut keys = Self::keys();
        keys.retain(|key| of_deformable.iter().all(|other| other.name != key.name));
        keys
    }

    /// Those of a deformable insert alone, but for those that a kind of plasticity or of backside brings.
    pub(super) fn keys_of_deformable() -> Vec<Key> {
        let plasticity = PlasticityChoice::choices().by;
        let backside = BacksideChoice::choices().by;
        [vec![plasticity], FrictionSettings::keys(), vec![backside]].concat()
    }

    /// The choice of the model, which brings the key of the law, or that and `of_law`, or the keys of a deformable insert,
    /// or those and `of_choices`.
    pub(super) fn models(of_law: &[Key], of_choices: &[Key]) -> Choices {
        let key = &ModelOfContact::keys()[0];
        let law = [&[PressureLawChoice::choices().by], of_law].concat();
        let deformable = [&Self::keys_of_deformable(), of_choices].concat();
        let offered = ContactModelWord::ALL.iter().map(|model| Offered {
            word: model.word(),
            keys: match model {
                ContactModelWord::Foundation => law.clone(),
                ContactModelWord::Deformable => deformable.clone(),
            },
        });
        let default = ContactModelWord::Foundation.word();
        Choices::new(key.name, key.doc.clone(), default, offered.collect())
    }

    fn other_keys() -> Vec<Key> {
        [Friction::keys(), Finding::keys()].concat()
    }

    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let model = ModelOfContact::read(section, log).map(|of| of.model);
        let word = model.unwrap_or(ContactModelWord::Foundation);
        let of_law = all_keys(&PressureLawChoice::choices());
        let of_plasticity = all_keys(&PlasticityChoice::choices());
        let of_backside = all_keys(&BacksideChoice::choices());
        let of_choices = [&of_plasticity[1..], &of_backside[1..]].concat();
        Self::models(&of_law[1..], &of_choices).check_keys_of_others(word.word(), section, log);
        let common = [
            ModelOfContact::keys(),
            Self::other_keys(),
            FrictionSettings::keys(),
        ]
        .concat();
        let (law, (plasticity, rubbing, backside)) = match word {
            ContactModelWord::Deformable => {
                let common = [common, of_law].concat();
                let law = Some(PressureLawChoice::Linear);
                (law, Self::read_deformable(section, &common, log))
            }
            ContactModelWord::Foundation => {
                let common = [common, of_plasticity, of_backside].concat();
                let law = PressureLawChoice::read(section, &common, log);
                let friction_model = FrictionModelWord::Regularised;
                let rubbing = FrictionSettings { friction_model };
                let none = (PlasticityChoice::None, rubbing, BacksideChoice::Bonded);
                (law, (Some(none.0), Some(none.1), Some(none.2)))
            }
        };
        let friction = Friction::read(section, log);
        let finding = Finding::read(section, log);
        Some(Self {
            model: model?,
            law: law?,
            plasticity: plasticity?,
            friction_model: rubbing?.friction_model,
            backside: backside?,
            friction: friction?,
            finding: finding?,
        })
    }

    /// What a deformable insert alone has.
    fn read_deformable(
        section: &Section<'_>,
        common: &[Key],
        log: &mut Log<'_>,
    ) -> (
        Option<PlasticityChoice>,
        Option<FrictionSettings>,
        Option<BacksideChoice>,
    ) {
        let with = |choices: Choices| [common, &all_keys(&choices)].concat();
        let beside_plasticity = with(BacksideChoice::choices());
        let beside_backside = with(PlasticityChoice::choices());
        (
            PlasticityChoice::read(section, &beside_plasticity, log),
            FrictionSettings::read(section, log),
            BacksideChoice::read(section, &beside_backside, log),
        )
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let model = self.model;
        ModelOfContact { model }.write(out);
        match model {
            ContactModelWord::Foundation => self.law.write(out),
            ContactModelWord::Deformable => {
                self.plasticity.write(out);
                let friction_model = self.friction_model;
                FrictionSettings { friction_model }.write(out);
                self.backside.write(out);
            }
        }
        self.friction.write(out);
        self.finding.write(out);
    }
}

/// The key that chooses, and those that all words bring.
fn all_keys(choices: &Choices) -> Vec<Key> {
    let offered = choices.offered.iter();
    let keys = offered.flat_map(|offer| offer.keys.clone());
    [choices.by.clone()].into_iter().chain(keys).collect()
}

impl Table for Contact {
    const NAME: &'static str = "contact";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&root.table(Self::NAME, log), log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let laws = PressureLawChoice::choices();
        let table = TableSchema::new("Model of contact, pressure law and friction.")
            .with_keys(&Self::keys())
            .with_choices(&Self::models(&[], &[]))
            .with_choices(&laws)
            .with_choices(&PlasticityChoice::choices())
            .with_choices(&BacksideChoice::choices())
            .with_one_of_under(&laws, "tabulated", &WAYS)
            .with_one_of_under(&laws, "tabulated-strain", &WAYS_OF_STRAIN);
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        page.chosen(
            "`[contact]`",
            &Self::keys_of_page(),
            &PressureLawChoice::choices(),
        );
        let plasticity = PlasticityChoice::choices();
        page.chosen(
            "`[contact]` of a deformable insert",
            &Self::keys_of_deformable(),
            &plasticity,
        );
        let backside = BacksideChoice::choices();
        let by = std::slice::from_ref(&backside.by);
        page.chosen("`[contact]` of a backside", by, &backside);
    }
}
