//! Every value with every other, or one at a time.

use super::place::Place;

/// Where test `row` has its inputs, of which input `i` has `counts[i]` values: the last input changes fastest.
pub(in super::super) fn factorial_places(row: u64, counts: &[u64]) -> Vec<Place> {
    let mut rest = row;
    let mut places: Vec<Place> = Vec::with_capacity(counts.len());
    for &count in counts.iter().rev() {
        places.push(along(rest % count, count));
        rest /= count;
    }
    places.reverse();
    places
}

/// Where test `row` has its inputs: first all as they are, then each in turn at its values.
pub(in super::super) fn one_at_a_time_places(row: u64, counts: &[u64]) -> Vec<Place> {
    let mut places = vec![Place::AsItIs; counts.len()];
    let Some(mut rest) = row.checked_sub(1) else {
        return places;
    };
    for (place, &count) in places.iter_mut().zip(counts) {
        if rest < count {
            *place = along(rest, count);
            break;
        }
        rest -= count;
    }
    places
}

/// Value `number` of `count`, from end to end.
fn along(number: u64, count: u64) -> Place {
    Place::Along(number as f64 / (count - 1).max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Place::{Along, AsItIs};

    #[test]
    fn every_value_meets_every_other() {
        let all: Vec<Vec<Place>> = (0..6).map(|row| factorial_places(row, &[2, 3])).collect();
        assert_eq!(all[0], [Along(0.0), Along(0.0)]);
        assert_eq!(all[1], [Along(0.0), Along(0.5)]);
        assert_eq!(all[5], [Along(1.0), Along(1.0)]);
    }

    #[test]
    fn one_moves_and_the_others_stay() {
        let all: Vec<Vec<Place>> = (0..6)
            .map(|row| one_at_a_time_places(row, &[2, 3]))
            .collect();
        assert_eq!(all[0], [AsItIs, AsItIs]);
        assert_eq!(all[2], [Along(1.0), AsItIs]);
        assert_eq!(all[4], [AsItIs, Along(0.5)]);
    }
}
