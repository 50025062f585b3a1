/// One ergonomic rule.
#[derive(Debug, PartialEq)]
pub struct Rule {
    /// Stable, for searching and for programs.
    pub code: &'static str,
    /// What goes wrong, in a few words.
    pub title: &'static str,
}

/// All rules, by code.
pub const RULES: &[Rule] = &[];

/// The rule of this code.
#[must_use]
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.code == code)
}
