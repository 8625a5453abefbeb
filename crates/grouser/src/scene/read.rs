//! From text to a checked scenario, and back with every default written out.

use super::{Pair, Problem, Scenario, Source, Study, Tool, Variant, advice, validate};
use crate::diagnostic::Diagnostic;
use ron::error::{Error, SpannedError};
use ron::extensions::Extensions;
use ron::ser::PrettyConfig;
use std::collections::BTreeMap;

/// How scenarios are written: optional parts without `Some`, payloads of variants without a second bracket.
pub fn dialect() -> ron::Options {
    ron::Options::default().with_default_extension(
        Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES,
    )
}

/// Reads, completes and checks a scenario. `name` is the file's name in messages; `sets` are (path, value) overrides
/// of the command line; `is_quick` applies the scenario's own `quick` overrides before them.
pub fn read(
    name: &str,
    text: &str,
    is_quick: bool,
    sets: &[(String, String)],
) -> Result<Scenario, Vec<Diagnostic>> {
    read_with_advice(name, text, is_quick, sets).map(|(scenario, _)| scenario)
}

/// The same, with advice about what is legal but unwise.
///
/// # Errors
/// As [`read`].
pub fn read_with_advice(
    name: &str,
    text: &str,
    is_quick: bool,
    sets: &[(String, String)],
) -> Result<(Scenario, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut source = Source::new(name, text);
    let mut scenario = parse(&source).map_err(|error| vec![error]);
    // What the file alone gets wrong is reported before overrides hide it; `quick` needs it anyway.
    if is_quick {
        for (path, value) in &scenario.as_ref().map_err(Clone::clone)?.quick.clone() {
            let origin = format!("quick: {path}");
            source.set(path, value.get_ron().trim(), &origin).map_err(|error| vec![error])?;
        }
    }
    for (path, value) in sets {
        source.set(path, value, &format!("--set {path}")).map_err(|error| vec![error])?;
    }
    if is_quick || !sets.is_empty() {
        scenario = parse(&source).map_err(|error| vec![error]);
    }
    let mut scenario = scenario?;
    scenario.is_quick = is_quick && !scenario.quick.is_empty();
    complete_pairs(&mut scenario);
    scenario.find_beside(name);
    if let Some(Tool::Mesh(mesh)) = &scenario.tool
        && let Err(message) = mesh.surface()
    {
        return Err(vec![Diagnostic { place: source.place_of("tool.file"), ..message }]);
    }
    let placed = |problem: Problem| Diagnostic { place: source.place_of(&problem.path), ..problem.into() };
    let problems = validate(&scenario);
    if problems.is_empty() {
        let variants = scenario.study.iter().flat_map(Study::variants);
        let refused = variants.filter_map(|each| variant(&scenario, &each).err()).flatten();
        let messages: Vec<Diagnostic> = refused.collect();
        if !messages.is_empty() {
            return Err(messages);
        }
        let advice = advice(&scenario).into_iter().map(placed).collect();
        return Ok((scenario, advice));
    }
    Err(problems.into_iter().map(placed).collect())
}

/// The scenario as a text with every default written out. Reading it gives the same scenario, and writing that
/// the same bytes.
pub fn resolved(scenario: &Scenario) -> String {
    let pretty = PrettyConfig::new().depth_limit(6).separate_tuple_members(false).new_line("\n");
    let text =
        dialect().to_string_pretty(scenario, pretty).expect("a scenario holds nothing RON cannot write");
    text + "\n"
}

/// One combination of a study as a scenario of its own.
///
/// # Errors
/// Messages about what the combination makes of the scenario.
pub fn variant(scenario: &Scenario, variant: &Variant) -> Result<Scenario, Vec<Diagnostic>> {
    let title = format!("{}: {}", scenario.title, variant.labels.join(", "));
    let base = Scenario { study: None, quick: BTreeMap::new(), title, ..scenario.clone() };
    let read =
        read(&format!("study, {}", variant.labels.join(", ")), &resolved(&base), false, &variant.sets)?;
    Ok(Scenario { is_quick: scenario.is_quick, ..read })
}

fn parse(source: &Source) -> Result<Scenario, Diagnostic> {
    dialect().from_str(source.text()).map_err(|error| explain(source, &error))
}

/// Writes down the contacts between unlike materials that meet but are not listed.
fn complete_pairs(scenario: &mut Scenario) {
    let mut names: Vec<&str> = Vec::new();
    if let Some(grains) = scenario.soil.grains() {
        names.extend(grains.layers.iter().map(|layer| layer.material.as_str()));
        names.push(&grains.container.material);
        names.extend(scenario.tool.as_ref().map(Tool::material));
    }
    names.sort();
    names.dedup();
    let mut added = Vec::new();
    for (i, a) in names.iter().enumerate() {
        for b in &names[i + 1..] {
            let is_listed = scenario
                .pairs
                .iter()
                .any(|Pair { between: (c, d), .. }| (c == *a && d == *b) || (c == *b && d == *a));
            let materials = (scenario.materials.get(*a), scenario.materials.get(*b));
            if let ((Some(first), Some(second)), false) = (materials, is_listed) {
                added.push(Pair {
                    between: (a.to_string(), b.to_string()),
                    restitution: first.restitution.min(second.restitution),
                    friction: first.friction.min(second.friction),
                });
            }
        }
    }
    scenario.pairs.extend(added);
}

/// RON's error with what was expected and the usual cause.
fn explain(source: &Source, error: &SpannedError) -> Diagnostic {
    let list = |names: &[&str]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let nearest = |names: &[&str], found: &str| {
        let likeness = |name: &str| strsim::jaro_winkler(name, found);
        let best = names.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
        (likeness(best) > 0.7).then(|| format!("did you mean `{best}`?"))
    };
    let of = |outer: &Option<String>| outer.as_ref().map_or(String::new(), |name| format!(" of {name}"));
    let mut message = match &error.code {
        Error::NoSuchStructField { expected, found, outer } => {
            Diagnostic::new(format!("unknown key `{found}`{}", of(outer)))
                .expected(format!("one of {}", list(expected)))
                .usual_cause(
                    "a misspelt key, a missing unit at its end, or a key of another part of the scene",
                )
                .remedy(nearest(expected, found).unwrap_or_default())
        }
        Error::NoSuchEnumVariant { expected, found, outer } => {
            Diagnostic::new(format!("unknown choice `{found}`{}", of(outer)))
                .expected(format!("one of {}", list(expected)))
                .usual_cause("a misspelt name")
                .remedy(nearest(expected, found).unwrap_or_default())
        }
        Error::MissingStructField { field, outer } => {
            Diagnostic::new(format!("`{field}`{} is missing; it has no default", of(outer)))
                .expected(format!("`{field}: …` before this closing bracket"))
                .usual_cause("a line was deleted or commented out")
        }
        Error::InvalidValueForType { expected, found } => Diagnostic::new(format!("this value is {found}"))
            .expected(expected.clone())
            .usual_cause("a number in quotation marks, a list where one number belongs, or the reverse"),
        Error::ExpectedFloat | Error::ExpectedInteger => Diagnostic::new("this value is not a number")
            .expected("a number such as 0.05, 2e7 or 1_000")
            .usual_cause("a number in quotation marks, or a name or list where one number belongs"),
        Error::ExpectedString => Diagnostic::new("this value is not a text")
            .expected("a text in quotation marks")
            .usual_cause("a name without quotation marks"),
        other => Diagnostic::new(format!("this is not a scenario: {}", lower_first(&other.to_string())))
            .expected("RON: `name: value,` within round brackets, lists within square brackets")
            .usual_cause("a missing comma or bracket at this place or shortly before it"),
    };
    let text = source.text();
    let span = byte_of(text, error.span.start)..byte_of(text, error.span.end);
    let blank = text[span.clone()].len() - text[span.clone()].trim_start().len();
    message.place = Some(source.place(span.start + blank..span.end));
    message
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_lowercase().chain(chars).collect())
}

/// Byte of a line and column, both counted in characters from 1.
fn byte_of(text: &str, position: ron::error::Position) -> usize {
    let line_start =
        text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum::<usize>();
    let rest = &text[line_start..];
    rest.char_indices().nth(position.col.saturating_sub(1)).map_or(text.len(), |(at, _)| line_start + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEVAMETER: &str = include_str!("../../../../scenarios/bevameter.ron");

    fn sets(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
        pairs.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect()
    }

    fn message(pairs: &[(&str, &str)]) -> String {
        let errors = read("b.ron", BEVAMETER, false, &sets(pairs)).expect_err("a refusal");
        errors.iter().map(Diagnostic::to_string).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn the_resolved_scenario_reads_back_to_the_same_bytes() {
        for is_quick in [false, true] {
            let scenario = read("b.ron", BEVAMETER, is_quick, &[]).unwrap();
            assert_eq!(scenario.is_quick, is_quick);
            let first = resolved(&scenario);
            let again = resolved(&read("r.ron", &first, false, &[]).unwrap());
            assert_eq!(first, again);
            let quick_again = resolved(&read("r.ron", &first, true, &[]).unwrap());
            assert_eq!(is_quick, first == quick_again);
            for default in ["energy_ratio: ", "gravity_m_s2: ", "seed: 1"] {
                assert!(first.contains(default), "{default} is hidden in\n{first}");
            }
        }
    }

    #[test]
    fn quick_and_set_override_in_this_order() {
        let set = sets(&[("materials.sand.young_pa", "7e6"), ("soil.settle.energy_ratio", "1e-3")]);
        let scenario = read("b.ron", BEVAMETER, true, &set).unwrap();
        let bed = scenario.soil.grains().unwrap();
        assert_eq!(scenario.materials["sand"].young_pa, 7e6);
        assert_eq!(bed.settle.energy_ratio, 1e-3);
        assert_ne!(bed.layers[0].sizes, {
            let full = read("b.ron", BEVAMETER, false, &[]).unwrap();
            full.soil.grains().unwrap().layers[0].sizes.clone()
        });
    }

    #[test]
    fn an_unknown_key_is_located_with_the_names_that_would_do() {
        let text = BEVAMETER.replace("poisson: 0.3,\n", "poison: 0.3,\n");
        let error = read("b.ron", &text, false, &[]).unwrap_err().remove(0).to_string();
        for part in ["unknown key `poison`", "b.ron:11:13", "`young_pa`", "did you mean `poisson`?"] {
            assert!(error.contains(part), "{part} in\n{error}");
        }
    }

    #[test]
    fn a_wrong_type_and_a_missing_comma_are_located() {
        let text = BEVAMETER.replace("young_pa: 2e7,", "young_pa: \"2e7\",");
        let error = read("b.ron", &text, false, &[]).unwrap_err().remove(0).to_string();
        assert!(error.contains("b.ron:10:23") && error.contains("not a number"), "{error}");
        let text = BEVAMETER.replace("young_pa: 2e7,", "young_pa: 2e7");
        let error = read("b.ron", &text, false, &[]).unwrap_err().remove(0).to_string();
        assert!(error.contains("missing comma") && error.contains("b.ron:11:13"), "{error}");
    }

    #[test]
    fn impossible_physics_is_refused_at_its_place() {
        for (path, value, parts) in [
            ("soil.layers[0].sizes.radius_m", "(-0.003, 0.004)", ["sizes.radius_m[0]", "positive"]),
            ("materials.sand.restitution", "0", ["in (0, 1]", "usual cause"]),
            ("materials.sand.restitution", "1.2", ["in (0, 1]", "percentage"]),
            ("materials.sand.young_pa", "NaN", ["is NaN", "stiffness [Pa]"]),
            ("materials.sand.young_pa", "57e3", ["cannot carry", "remedy: a Young's modulus of at least"]),
            ("soil.layers", "[]", ["the bed is empty", "usual cause"]),
            ("soil.layers[0].depth_m", "0.001", ["bed would be empty", "diameter"]),
            ("motion.gap_m", "-0.01", ["starts inside the bed", "motion.depth_m"]),
            ("motion.depth_m", "20", ["less than the bed's depth", "millimetres"]),
            ("soil.layers[0].material", "\"snd\"", ["no material \"snd\"", "\"sand\""]),
            ("dials.time_step_fraction", "20", ["(0, 1]", "unstable"]),
            ("dials.time_stp", "20", ["unknown key", "did you mean `time_step_fraction`?"]),
            ("dials.rotation", "Fred", ["unknown choice `Fred`", "did you mean `Free`?"]),
            ("tool.diameters_m[7]", "1", ["no value at", "resolved scenario"]),
        ] {
            let text = message(&[(path, value)]);
            assert!(text.contains(path) && parts.iter().all(|part| text.contains(part)), "{path}:\n{text}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_damage_to_a_file_makes_the_reader_panic(at in 0..6000_usize, len in 0..40_usize, put in "[ -~]{0,12}") {
            let mut text = BEVAMETER.to_owned();
            let start = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap();
            let end = (start..=(start + len).min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap();
            text.replace_range(start..end, &put);
            if let Err(errors) = read("b.ron", &text, true, &sets(&[("soil.seed", "3")])) {
                proptest::prop_assert!(errors.iter().all(|error| error.to_string().len() > 20));
            }
        }
    }
}
