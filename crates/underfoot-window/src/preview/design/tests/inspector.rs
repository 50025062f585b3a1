//! The inspector: plain words, sliders, drop-downs, colours, waveforms, and the origin of each value.

use egui_kittest::kittest::NodeT;

use super::*;

impl Desk {
    /// With the button `home` selected.
    fn at_home(text: &str) -> Self {
        let mut desk = Self::on(text, None);
        let home = desk.place("home");
        desk.drag(home, home);
        desk
    }

    fn open(&mut self, section: &str) {
        self.click(section);
        self.window.run_steps(30);
    }

    fn click_in_view(&mut self, label: &str) {
        self.window.get_by_label(label).scroll_to_me();
        self.window.run_steps(20);
        self.click(label);
    }

    /// Chooses `choice` from the drop-down called `name`.
    fn choose(&mut self, name: &str, choice: &str) {
        self.window.get_by_role_and_label(Role::ComboBox, name).scroll_to_me();
        self.window.run_steps(20);
        self.window.get_by_role_and_label(Role::ComboBox, name).click();
        self.window.run_steps(3);
        self.click(choice);
    }

    fn press_of_home(&self) -> f32 {
        let layout = self.designer().layout();
        layout.widgets[layout.widget_index("home").unwrap()].behaviour.thresholds().press.0
    }
}

fn map() -> &'static str {
    builtin_layout("map").unwrap()
}

#[test]
fn the_force_that_a_foot_needs_is_set_by_its_slider_and_reset_to_that_of_the_kind() {
    let mut desk = Desk::at_home(map());
    let before = desk.text();
    assert!(desk.says("Takes") && desk.says("Lets go below"));
    assert!(!desk.says("Reset Takes"), "it comes from the kind");
    let slider = desk.window.get_by_label("Takes: slider").rect();
    let middle = slider.center();
    desk.drag(egui::pos2(slider.left() + 0.2 * slider.width(), middle.y), middle);
    let pressed = desk.press_of_home();
    assert!((100.0..170.0).contains(&pressed), "{pressed} N in the middle of 20 to 250 N");
    assert!(desk.text().contains("press_n: "), "{}", desk.text());
    desk.click("Reset Takes");
    assert_eq!((desk.press_of_home(), desk.text()), (60.0, before.clone()));
    desk.click("Undo");
    assert_eq!(desk.press_of_home(), pressed);
    desk.click("Undo");
    assert_eq!(desk.text(), before, "a drag is one step");
    desk.window.get_by_label("Takes: slider").focus();
    desk.window.run_steps(2);
    desk.key(Key::ArrowRight);
    assert!(desk.press_of_home() > 60.0, "by the keyboard too");
}

#[test]
fn a_press_threshold_below_that_of_the_release_moves_it_along() {
    let mut desk = Desk::at_home(map());
    desk.field("press_n").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "30");
    let layout = desk.designer().layout();
    let now = layout.widgets[layout.widget_index("home").unwrap()].behaviour.thresholds();
    assert!(now.press.0 == 30.0 && now.release.0 <= 24.0, "{now:?}");
}

#[test]
fn what_cannot_be_says_so_at_its_field_until_it_is_mended() {
    let mut desk = Desk::at_home(map());
    let before = desk.text();
    desk.field("press_n").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "5000");
    assert_eq!(desk.text(), before);
    let refusal = desk.window.get_by_label_contains("Not changed: ").rect();
    let field = desk.field("press_n").rect();
    assert!((0.0..20.0).contains(&(refusal.top() - field.bottom())), "{refusal:?} is not below {field:?}");
    desk.field("press_n").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "70");
    assert!(desk.text().contains("press_n: 70") && !desk.says("Not changed"));
    // A text that is refused stays, to be mended.
    desk.field("id").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "Go Home");
    assert!(desk.says("Not changed: "));
    assert_eq!(desk.field("id").value().as_deref(), Some("Go Home"));
}

#[test]
fn a_guard_is_chosen_from_a_list_and_its_time_is_set_below() {
    let mut desk = Desk::at_home(map());
    desk.choose("Guard", "a second press");
    assert!(desk.text().contains("guard: Confirm"), "{}", desk.text());
    desk.field("within_s").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "5");
    assert!(desk.text().contains("guard: Confirm(within_s: 5)"), "{}", desk.text());
    desk.choose("Acts on", "the press");
    assert!(desk.text().contains("acts_on: Press"), "{}", desk.text());
}

#[test]
fn a_gesture_is_switched_on_with_a_usual_time_and_off_again() {
    let mut desk = Desk::at_home(map());
    let before = desk.text();
    desk.click_in_view("Long press from: on");
    assert!(desk.text().contains("long_press_ms: 600"), "{}", desk.text());
    desk.click_in_view("Long press from: on");
    assert_eq!(desk.text(), before);
}

#[test]
fn a_colour_of_another_control_is_taken_over_and_the_contrast_is_said() {
    let mut desk = Desk::at_home(map());
    desk.open("Look");
    assert!(desk.says("to 1, easy to read"));
    desk.click_in_view("Pick Face");
    desk.window.run_steps(10);
    // The colour of the slider.
    desk.click("Use #efe4d2");
    assert!(desk.text().contains("look: (face: \"#efe4d2\")"), "{}", desk.text());
    desk.key(Key::Escape);
    let ink = map().replace("label: \"Home\"", "label: \"Home\", look: (ink: \"#e0e0e0\")");
    let mut desk = Desk::at_home(&ink);
    // With the number of its problems.
    desk.open("Look (1)");
    assert!(desk.says("hard to read"));
    assert!(desk.says("Look at rest") && desk.says("Look while pressed"));
}

#[test]
fn the_waveform_of_each_effect_is_drawn_with_its_figures() {
    let mut desk = Desk::at_home(map());
    desk.open("Feel");
    for moment in ["at the press", "at the release"] {
        let begin = format!("Waveform {moment}: ");
        let shown = desk.window.get_by_label_contains(&begin);
        let figures = shown.accesskit_node().label().unwrap_or_default();
        assert!(figures.contains(" N peak, "), "{figures}");
    }
}

#[test]
fn the_kind_of_inherited_values_is_shown_on_request() {
    let mut desk = Desk::at_home(map());
    desk.click("Kind of button: round button");
    assert!(desk.says("Kind round button") && desk.says("It comes with underfoot"));
    assert!(desk.says("Made of it: Control home") && !desk.says("Made of it: Control zoom"));
    desk.click("Back");
    assert!(desk.says("Takes: slider"));
}

#[test]
fn a_rule_that_a_region_leaves_out_is_the_usual_one() {
    let mut desk = Desk::on(map(), None);
    desk.click("Region map");
    let shown = desk.window.get_by_role_and_label(Role::ComboBox, "Worked by").accesskit_node().value();
    assert_eq!(shown.as_deref(), Some("the heaviest foot"));
    desk.choose("Worked by", "every foot");
    assert!(desk.text().contains("cursor: Each"), "{}", desk.text());
}

#[test]
fn a_threshold_that_follows_from_another_can_be_set_once_that_is_there() {
    let mut desk = Desk::at_home(map());
    assert!(!desk.says("press_share"), "no name in files");
    desk.click_in_view("Takes of weight: on");
    desk.field("release_share").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "0.12");
    assert!(desk.text().contains("release_share: 0.12"), "{}", desk.text());
}

#[test]
fn the_name_in_files_is_told_at_the_plain_name() {
    let mut desk = Desk::at_home(map());
    let name = desk.window.get_by_role_and_label(Role::Label, "Takes").rect().center();
    desk.window.event(Event::PointerMoved(name));
    desk.window.run_steps(60);
    assert!(desk.says("press_n") && desk.says("from round button"));
}
