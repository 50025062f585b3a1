//! A plan as a table.

use underfoot_lab::plan::{Limit, Machine, Plan, Resource, Split};

/// Prints `plan` as a table.
pub(super) fn print(plan: &Plan) {
    for line in lines(plan) {
        outln!("{line}");
    }
}

fn lines(plan: &Plan) -> Vec<String> {
    let Plan { columns, rows, people, split, fullest, limits, total, whole, machine, .. } = plan;
    let mut lines =
        vec![format!("{columns} x {rows} tiles, {people} people: {}", cut(*split, total.computers))];
    let row = |name: &str, value: String| format!("  {name:<52} {value:>12}");
    lines.push("All together, people spread evenly:".to_owned());
    lines.extend([
        row("computers", total.computers.to_string()),
        row("boards", total.boards.to_string()),
        row("links of boards and computers", total.links.to_string()),
        row("sensor packets received per second", count(total.packets_per_s)),
        row("of them forwarded by another computer", count(total.forwards_per_s)),
        row("computers that a board's packets reach", format!("{:.2}", total.copies)),
        row("sensor packets, Mb/s", count(total.sensor_mbit)),
        row("contacts told per second", count(total.contacts_per_s)),
        row("to an app that hears all of them, Mb/s", count(total.app_mbit)),
        row("cores busy with sensing", count(total.sensing_cores)),
        row("cores busy with sound", count(total.sound_cores)),
    ]);
    let name = if fullest.id.is_empty() { String::new() } else { format!(", \"{}\"", fullest.id) };
    lines.push(format!(
        "The fullest area{name}: {} x {} tiles, senses {} x {} with {:.0} people:",
        fullest.columns, fullest.rows, fullest.sensed_columns, fullest.sensed_rows, fullest.sensed_people
    ));
    lines.push(row("sensor packets received per second", count(fullest.packets_per_s)));
    lines.push(row("sensor packets forwarded per second", count(fullest.forwards_per_s)));
    lines.extend(limits.iter().map(used));
    lines.push("More computers do not change:".to_owned());
    lines.extend(whole.iter().map(used));
    lines.push(verdict(plan));
    lines.push("A computer's constants, microseconds of one core for a millisecond of floor:".to_owned());
    lines.extend(constants(machine));
    lines.push("Taken for granted:".to_owned());
    lines.extend(plan.assumptions.iter().map(|assumption| format!("- {assumption}")));
    lines
}

fn constants(machine: &Machine) -> Vec<String> {
    let times = [
        ("a floor at work, whatever its size", machine.base_us),
        ("a packet", machine.packet_us),
        ("forwarding a packet", machine.forward_us),
        ("waking for what one neighbour forwards", machine.wake_us),
        ("assembling a tile", machine.assemble_tile_us),
        ("sensing a tile that carries nothing", machine.sense_tile_us),
        ("a person who walks", machine.person_us),
        ("a silent channel", machine.channel_us),
        ("a channel that clicks and rubs, in addition", machine.active_channel_us),
    ];
    let mut lines: Vec<_> = times.map(|(name, us)| format!("  {name:<52} {us:>12.3}")).into();
    lines.push(format!(
        "  and {} cores, {} channels of sound, {} Mb/s of network",
        machine.cores,
        machine.channels,
        count(machine.link_mbit)
    ));
    lines
}

fn cut(split: Option<Split>, areas: u32) -> String {
    match split {
        Some(split) if split.areas_count() == 1 => "one area".to_owned(),
        Some(Split { across, up }) => {
            format!("{} areas, {across} from west to east and {up} from south to north", across * up)
        }
        None => format!("{areas} areas, as the floor file names them"),
    }
}

fn used(limit: &Limit) -> String {
    let Limit { resource, needed, available, share } = limit;
    let unit = resource.unit();
    let gap = if unit.is_empty() { "" } else { " " };
    let of = format!("{} of {}{gap}{unit}", count(*needed), count(*available));
    format!("  {:<46} {of:>26} {:>6.0} %", resource.name(), 100.0 * share)
}

fn verdict(plan: &Plan) -> String {
    let first = plan.first_limit;
    let all = plan.whole.iter().chain(&plan.limits);
    let mut too_much = all.filter(|limit| limit.share > 1.0).map(|limit| limit.resource.name());
    let name = match first {
        Resource::Boards | Resource::Side => format!("the {}", first.name()),
        _ => format!("the {}", first.name()).replace("the all cores", "all cores"),
    };
    if plan.fits {
        return format!("Runs out first: {name}.");
    }
    let listed = too_much.by_ref().collect::<Vec<_>>().join("; ");
    format!("It does not fit: {listed}. Runs out first: {name}.")
}

/// A number with no more digits than a reader needs.
fn count(number: f64) -> String {
    match number {
        _ if number >= 100.0 => {
            let digits = format!("{number:.0}");
            let mut out = String::new();
            for (at, digit) in digits.chars().enumerate() {
                if at > 0 && (digits.len() - at).is_multiple_of(3) {
                    out.push(',');
                }
                out.push(digit);
            }
            out
        }
        _ if number >= 10.0 && number.fract() == 0.0 => format!("{number:.0}"),
        _ if number >= 10.0 => format!("{number:.1}"),
        _ => format!("{number:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_as_many_digits_as_help() {
        let counts = [0.0, 0.0532, 9.8765, 10.27, 64.0, 100.4, 1000.0, 1_234_567.8].map(count);
        assert_eq!(counts, ["0.000", "0.053", "9.877", "10.3", "64", "100", "1,000", "1,234,568"]);
    }
}
