//! The frozen pond against its model, on 100,000 events.

use underfoot::ground::IceSpec;
use underfoot_lab::experiment::PondLaws;

/// 100,000 events of the experiment. A sample from the model fails a test at 0.001 for one of a thousand seeds; this
/// seed is fixed, so it passes unless the model changes.
#[test]
fn onsets_energies_fronts_and_turns_are_the_model_s() {
    let laws = PondLaws::measure(IceSpec::POND, 1, 100_000);
    println!("{laws}");
    let line = |what: &str| laws.line(what).unwrap_or_else(|| panic!("{what}"));
    let mut fits = 0;
    for law in &laws.lines {
        if let Some(fit) = law.fit {
            assert!(fit.p > 0.001, "{}: {fit:?}", law.what);
            fits += 1;
        }
    }
    assert_eq!(fits, 7);
    let onsets = line("onsets: how many");
    let (expected, found) = (onsets.expected.unwrap(), onsets.found.unwrap());
    assert!(onsets.count > 95_000, "{}", onsets.count);
    // Four standard deviations of a Poisson count.
    assert!((found - expected).abs() < 4.0 * expected.sqrt(), "{found} of {expected}");
    for what in ["energies: exponent gamma", "turns: sigma"] {
        let (expected, found) = (line(what).expected.unwrap(), line(what).found.unwrap());
        assert!((found / expected - 1.0).abs() < 0.05, "{what}: {found}, not {expected}");
    }
    assert!(line("turns: sigma").count > 95_000);
    assert_eq!(line("fronts: started at once").found, Some(2.0));
}

/// Other parameters than the shipped ones are followed as well; no threshold is the paper's own model.
#[test]
fn the_paper_s_plain_ice_follows_its_model_too() {
    let mut spec = IceSpec { calm_j: 0.0, onsets_per_j_s: 900.0, ..IceSpec::POND };
    spec.energy.gamma = -2.4;
    spec.cracks.turn = 0.1;
    spec.body.damping_n_s_m = 1500.0;
    let laws = PondLaws::measure(spec, 5, 20_000);
    println!("{laws}");
    assert!(laws.lines.iter().filter_map(|law| law.fit).all(|fit| fit.p > 0.001));
    let gamma = laws.line("energies: exponent gamma").unwrap().found.unwrap();
    assert!((gamma / -2.4 - 1.0).abs() < 0.05, "{gamma}");
}
