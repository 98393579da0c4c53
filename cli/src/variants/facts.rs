//! Facts of the scene that vary, and the values that are tried.

use super::axis::{Axis, AxisSubject};
use framewright_graph::language::{Fact, FactType, FactValue, Facts};
use framewright_lab::mentions::Mentions;

/// At most this many values of a fact are tried.
const MOST: usize = 16;

/// An axis for each fact that the files mention. Its first value is the one without a scene: true, or the largest.
pub(super) fn axes(mentions: &Mentions<'_>) -> impl Iterator<Item = Axis> {
    let axis = |fact| Axis::new(AxisSubject::Fact(fact), values(fact, mentions));
    Fact::ALL.into_iter().filter(|fact| !names(*fact).is_empty() && mentioned(*fact, mentions)).map(axis)
}

/// A value as an axis has it, of the fact's own type.
pub(super) fn value(fact: Fact, text: &str) -> FactValue {
    match fact.ty() {
        FactType::Bool => FactValue::Bool(text == "true"),
        FactType::Integer => FactValue::Integer(text.parse().unwrap_or_default()),
        FactType::Number => FactValue::Number(text.parse().unwrap_or_default()),
    }
}

/// The names in pipeline files that a fact decides. The number of lights follows from those of suns and of point lights.
fn names(fact: Fact) -> Vec<&'static str> {
    match fact {
        Fact::Lights => Vec::new(),
        Fact::Suns | Fact::PointLights => vec![fact.name(), Fact::Lights.name()],
        _ => vec![fact.name()],
    }
}

fn mentioned(fact: Fact, mentions: &Mentions<'_>) -> bool {
    names(fact).into_iter().any(|name| mentions.may_hold(last(name), 1))
}

/// `scene.suns` is `suns`.
fn last(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, last)| last)
}

/// The values of a fact that are tried. A number is compared with numbers in the same string: each of those is tried with its
/// neighbours, and 0, up to [`MOST`]. A length or a factor is never 0.
fn values(fact: Fact, mentions: &Mentions<'_>) -> Vec<String> {
    let beside = || names(fact).into_iter().flat_map(|name| mentions.numbers_beside(last(name)));
    let mut values = Vec::new();
    let mut add = |value: String| {
        if values.len() < MOST && !values.contains(&value) {
            values.push(value);
        }
    };
    match Facts::UNKNOWN.value(fact) {
        FactValue::Bool(holds) => [holds, !holds].into_iter().for_each(|value| add(value.to_string())),
        FactValue::Integer(most) => {
            [most, 0].into_iter().for_each(|value| add(value.to_string()));
            for number in beside() {
                #[allow(clippy::cast_possible_truncation, reason = "beyond the range it is the nearest that there is")]
                let whole = number.floor() as i64;
                let near = [whole.saturating_sub(1), whole, whole.saturating_add(1)];
                near.into_iter().filter(|near| (0..=most).contains(near)).for_each(|near| add(near.to_string()));
            }
        }
        // Scaling by a length or a factor makes no other variant; being compared with a number does.
        FactValue::Number(usual) if fact.is_measure() => {
            add(format!("{usual:?}"));
            for number in mentions.numbers_compared_with(fact.name()).filter(|number| *number > 0.0) {
                [number.next_down(), number, number.next_up()].into_iter().for_each(|near| add(format!("{near:?}")));
            }
        }
        FactValue::Number(most) => {
            // Written so that it reads as the very same number.
            [most, 0.0].into_iter().for_each(|value| add(format!("{value:?}")));
            for number in beside() {
                let near = [number.next_down(), number, number.next_up()];
                near.into_iter().filter(|near| (0.0..=most).contains(near)).for_each(|near| add(format!("{near:?}")));
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Sources;

    fn of(text: &str) -> Vec<(Fact, Vec<String>)> {
        let mut sources = Sources::default();
        sources.add("a.ron", "a.ron", text.to_owned());
        let mentions = Mentions::of(&sources);
        let told = axes(&mentions).map(|axis| match axis.varied {
            AxisSubject::Fact(fact) => (fact, axis.values),
            other => panic!("{other:?}"),
        });
        told.collect()
    }

    #[test]
    fn a_length_varies_only_where_it_is_compared_with_a_number() {
        let only = |value: &str| vec![(Fact::Size, vec![value.to_owned()])];
        assert_eq!(of("\"0.1 * scene.size\""), only("1.0"));
        // A setting may have the last part of its name.
        assert_eq!(of("\"exposure > 2\""), [(Fact::Exposure, vec!["1.0".to_owned()])]);
        let compared = ["1.0", "99.99999999999999", "100.0", "100.00000000000001"].map(String::from).to_vec();
        assert_eq!(of("\"3.3 * scene.size\" \"scene.size > 100\""), [(Fact::Size, compared)]);
    }

    #[test]
    fn numbers_are_tried_at_0_and_on_both_sides_of_what_they_are_compared_with() {
        let objects = of("\"scene.objects > 100\" \"scene.objects < 2 || 7 > 3.5\"");
        assert_eq!(
            objects,
            [(
                Fact::Objects,
                ["250000", "0", "99", "100", "101", "1", "2", "3", "6", "7", "8", "4"].map(String::from).to_vec()
            )]
        );
        let radiance = of("\"scene.peak_radiance > 1.0\"");
        let values = ["65504.0", "0.0", "0.9999999999999999", "1.0", "1.0000000000000002"];
        assert_eq!(radiance, [(Fact::PeakRadiance, values.map(String::from).to_vec())]);
        assert_eq!(
            of("\"scene.has_opaque\" \"objects\" 7"),
            [
                (Fact::HasOpaque, vec!["true".to_owned(), "false".to_owned()]),
                (Fact::Objects, vec!["250000".to_owned(), "0".to_owned()]),
            ]
        );
    }

    #[test]
    fn the_number_of_lights_varies_by_its_parts() {
        let lights = of("\"scene.lights >= 2\"");
        assert_eq!(lights[0], (Fact::Suns, vec!["1".to_owned(), "0".to_owned()]));
        assert_eq!(lights[1], (Fact::PointLights, ["4096", "0", "1", "2", "3"].map(String::from).to_vec()));
        assert_eq!(lights.len(), 2);
    }

    #[test]
    fn however_many_numbers_there_are_only_some_are_tried() {
        let text: String = (1..100).map(|at| format!("\"scene.triangles > {}\"", at * 1000)).collect();
        assert_eq!(of(&text)[0].1.len(), MOST);
    }

    #[test]
    fn values_are_read_as_they_are_written() {
        for fact in Fact::ALL {
            let most = Facts::UNKNOWN.value(fact);
            let text = if let FactValue::Number(number) = most { format!("{number:?}") } else { most.to_string() };
            assert_eq!(value(fact, &text), most, "{}", fact.name());
        }
    }
}
