//! The world that comes with the program.

use super::*;
use crate::mercator::unproject;

#[test]
fn places_are_in_their_countries() {
    let world = World::shipped().unwrap();
    let at = |lon, lat| world.country_at(lon, lat).map(|country| country.name.as_str());
    assert_eq!(at(2.35, 48.85), Some("France"));
    assert_eq!(at(139.0, 36.0), Some("Japan"));
    assert_eq!(at(28.2, -29.6), Some("Lesotho"), "a hole of South Africa");
    assert_eq!(at(12.45, 43.94), Some("San Marino"), "a hole of Italy");
    assert_eq!(at(-30.0, 40.0), None);
    let across = (at(-175.0, 66.0), at(175.0, 67.0));
    assert_eq!(across, (Some("Russia"), Some("Russia")), "over the date line");
    assert_eq!(
        (at(-90.0, 60.5), at(-105.0, 60.0), at(100.0, -80.0)),
        (None, Some("Canada"), Some("Antarctica"))
    );
    let brazil = world.countries.iter().find(|country| country.name == "Brazil").unwrap();
    let (lon, lat) = unproject(brazil.middle);
    assert_eq!(at(lon, lat), Some("Brazil"));
}

#[test]
fn neighbours_have_different_hues() {
    let world = World::shipped().unwrap();
    let hue = |name: &str| world.countries.iter().find(|country| country.name == name).unwrap().hue;
    for (one, others) in [
        ("Germany", ["France", "Poland", "Austria", "Czechia", "Denmark"]),
        ("Brazil", ["Peru", "Bolivia", "Argentina", "Colombia", "Venezuela"]),
        ("Russia", ["China", "Finland", "Ukraine", "Mongolia", "Norway"]),
    ] {
        for other in others {
            assert_ne!(hue(one), hue(other), "{one} and {other}");
        }
    }
    assert!(world.countries.iter().all(|country| country.hue < HUES && country.area > 0.0));
}

#[test]
fn coasts_are_as_fine_as_the_nearest_zoom_shows_them() {
    let world = World::shipped().unwrap();
    let points: usize = world.lines.iter().map(|line| line.points.len()).sum();
    // The data at 1:110 million have 8,000.
    assert!(points > 60_000, "{points}");
    // Crete is 260 km long: with 12 points for each of its sides it would look like a polygon.
    let crete = |at: &&[f64; 2]| {
        let (lon, lat) = unproject(**at);
        (23.4..26.4).contains(&lon) && (34.8..35.8).contains(&lat)
    };
    let crete = world.lines.iter().flat_map(|line| &line.points).filter(crete).count();
    assert!(crete > 50, "{crete}");
}

#[test]
fn lakes_and_rivers_lie_where_they_do() {
    let world = World::shipped().unwrap();
    let lake = world.lakes.iter().find(|lake| lake.name == "Lake Victoria").unwrap();
    assert!(lake.from <= 2.5 && lake.areas.iter().any(|area| area.contains(project(33.0, -1.0))));
    assert!(!lake.areas.iter().any(|area| area.contains(project(36.8, -1.3))), "Nairobi");
    // The Nile at Aswan, and the Amazon at Manaus.
    for (lon, lat) in [(32.9, 24.1), (-60.0, -3.1)] {
        let [x, y] = project(lon, lat);
        let near = |at: &[f64; 2]| (at[0] - x).hypot(at[1] - y) < 0.3 / 360.0;
        assert!(world.rivers.iter().any(|river| river.from <= 3.0 && river.points.iter().any(near)), "{lon}");
    }
}

#[test]
fn cities_lie_in_their_countries_and_great_ones_are_named_first() {
    let world = World::shipped().unwrap();
    let city = |name: &str| world.cities.iter().find(|city| city.name == name).unwrap();
    for (name, country) in
        [("Paris", "France"), ("Kano", "Nigeria"), ("Bengaluru", "India"), ("Lima", "Peru")]
    {
        let (lon, lat) = unproject(city(name).at);
        assert_eq!(world.country_at(lon, lat).map(|found| found.name.as_str()), Some(country), "{name}");
    }
    assert!(city("Paris").is_capital && !city("Lagos").is_capital);
    assert!(city("Tokyo").from < city("Lyon").from && city("Lyon").from < city("Kassel").from);
    assert!(world.cities.is_sorted_by(|one, other| one.from <= other.from));
    assert!(world.cities.iter().all(|city| !city.name.is_empty()));
}
