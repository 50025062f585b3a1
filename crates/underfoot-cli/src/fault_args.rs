//! Options for the rehearsal of faults.

use underfoot::source::{FaultInjector, FloorInput, LinkFaults};

/// Faults between the boards and this program, for rehearsals.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct FaultArgs {
    /// Rehearse a fault between the boards and this program; several may be given. Times are seconds since the start:
    /// loss=5%, duplicate=10%, delay=10%:20ms, damage=1%, bursts=1s:50ms, silent=10s..12s, board=3:10s..12s,
    /// frozen=3:10s..12s, stall=10s..10.2s, swapped=0:1, panic=20s, nemesis=SEED:60s:BOARDS.
    #[arg(long = "fault", value_name = "FAULT")]
    faults: Vec<LinkFaults>,
    /// Seed that determines the affected packets.
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "faults")]
    fault_seed: u64,
}

impl FaultArgs {
    /// `input` with these faults and those of a scenario; reports them, so that they are not mistaken for real ones.
    pub(crate) fn wrap(&self, input: impl Into<FloorInput>, scenario: LinkFaults) -> FloorInput {
        let mut input = input.into();
        let faults = self.faults.iter().cloned().fold(scenario, LinkFaults::and);
        if faults == LinkFaults::default() {
            return input;
        }
        say_what_is_rehearsed(&faults);
        input.source = Box::new(FaultInjector::new(input.source, faults, self.fault_seed));
        input
    }
}

/// Reports that faults are rehearsed, if there are any.
pub(crate) fn say_what_is_rehearsed(faults: &LinkFaults) {
    if *faults != LinkFaults::default() {
        errln!(
            "This is a rehearsal: packets are lost or changed on purpose (--fault, or faults of the scenario)."
        );
    }
}
