//! Ergonomic review of a layout: checks a valid layout against rules with numbers and sources, for feet and for eyes.
//!
//! ```
//! use underfoot_scene::ergonomics;
//! use underfoot::floor::Floor;
//! use underfoot::schema::{self, Kinds};
//!
//! let floor = Floor::default();
//! let text = schema::builtin_layout("map").unwrap_or_default();
//! let loaded = schema::parse_layout(text, "map", &Kinds::builtin(), &floor.geometry)?;
//! let findings = ergonomics::review(&loaded.layout, &floor);
//! // At their places in the text, with carets.
//! println!("{}", ergonomics::locate(&loaded.places, &findings));
//! # assert!(findings.is_empty());
//! # Ok::<(), schema::Diagnostics>(())
//! ```

mod force;
mod place_error;
mod press;
mod rules;
mod sight;
mod space;

pub use place_error::{Zone, predicted_error_m};
pub use press::{PressProposal, PressSpread, propose_press};
pub use rules::{RULES, Rule, rule};
pub use space::{
    REACH_M, SMALL_M, STEP_AWAY_M, footing, free_tiles, gap_between_m, needed_gap_m, reach_m, smallest_part,
};

use underfoot::floor::Floor;
use underfoot::layout::{Layout, Widget};
pub use underfoot::schema::ControlPart as Part;
use underfoot::schema::{Diagnostics, Places, Remark};
use underfoot_format::diagnostic::Severity;

/// One ergonomic problem of one control.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// Severity of the problem.
    pub severity: Severity,
    /// Index in [`Layout::widgets`].
    pub widget: usize,
    /// The aspect of the control that the finding concerns.
    pub part: Part,
    /// Description of the problem, in one clause.
    pub message: String,
    /// The measured value and the wanted one; printed beside the carets.
    pub expected: String,
    /// Suggested remedy.
    pub help: Option<String>,
}

/// Reviews `layout` on `floor` and returns all findings, control by control.
///
/// A checked layout has finite numbers only; a NaN in a layout built by hand gives no finding.
#[must_use]
pub fn review(layout: &Layout, floor: &Floor) -> Vec<Finding> {
    let mut findings = Vec::new();
    let cut = sight::cut_labels(layout, floor);
    for (index, widget) in layout.widgets.iter().enumerate() {
        let mut subject = Subject { layout, floor, index, widget, findings: &mut findings };
        space::review(&mut subject);
        force::review(&mut subject);
        sight::review(&mut subject, cut.contains(&index));
    }
    findings
}

/// Returns the findings at their places in the text of the layout; similar findings about the controls of one grid are
/// one.
#[must_use]
pub fn locate(places: &Places, findings: &[Finding]) -> Diagnostics {
    places.locate(findings.iter().map(Finding::remark))
}

impl Finding {
    /// The finding as a remark about the control.
    #[must_use]
    pub fn remark(&self) -> Remark<'_> {
        Remark {
            code: self.rule.code,
            severity: self.severity,
            widget: self.widget,
            part: self.part,
            message: &self.message,
            expected: &self.expected,
            help: self.help.as_deref(),
        }
    }
}

/// The control under review, and the findings so far.
struct Subject<'a> {
    layout: &'a Layout,
    floor: &'a Floor,
    index: usize,
    widget: &'a Widget,
    findings: &'a mut Vec<Finding>,
}

impl Subject<'_> {
    fn error(&mut self, code: &str, part: Part, message: String, expected: String) {
        self.find(Severity::Error, code, part, message, expected);
    }

    fn warning(&mut self, code: &str, part: Part, message: String, expected: String) {
        self.find(Severity::Warning, code, part, message, expected);
    }

    fn find(&mut self, severity: Severity, code: &str, part: Part, message: String, expected: String) {
        // Only this module writes codes; a test checks that each has its rule.
        let Some(rule) = rule(code) else { return };
        let help = Some(rule.remedy.to_owned());
        self.findings.push(Finding { rule, severity, widget: self.index, part, message, expected, help });
    }

    /// The control's name for messages.
    fn name(&self) -> String {
        format!("\"{}\"", self.widget.id)
    }

    /// Other controls that can be visible at the same time.
    fn others(&self) -> impl Iterator<Item = &Widget> {
        let own = self.widget.page;
        let shares_page = move |other: &Widget| own.is_none() || other.page.is_none() || other.page == own;
        let index = self.index;
        self.layout
            .widgets
            .iter()
            .enumerate()
            .filter(move |(other, widget)| *other != index && shares_page(widget))
            .map(|(_, widget)| widget)
    }
}

/// Formats a length in centimetres.
fn cm(metres: f32) -> String {
    let cm = metres * 100.0;
    if cm < 9.95 { format!("{cm:.1} cm") } else { format!("{cm:.0} cm") }
}
