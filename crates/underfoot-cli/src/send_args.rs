//! Options for the messages of a layout to other programs.

use underfoot::layout::Layout;
use underfoot::messages::{Destination, MessagePlan, TargetSort};
use underfoot_io::targets::{LoadedPlan, TargetSink, redirect};

use super::failure::Failure;
use super::own_program;

/// Options for messages of controls.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct SendArgs {
    /// Move a target of the layout: another host and port for OSC (`desk=10.0.0.5:53000`, `desk=tcp:10.0.0.5:53000`),
    /// another X display for a keyboard (`viewer=:1`), another name for a MIDI port (`synth=stage`), another address for
    /// Art-Net, sACN or MQTT (`lights=10.0.0.20`, `home=10.0.0.7:1883`), another program. May be given several times.
    #[arg(long = "target", value_name = "NAME=PLACE", value_parser = moved)]
    targets: Vec<(String, String)>,
    /// Send no messages of controls to the layout's targets.
    #[arg(long)]
    no_send: bool,
    /// Let controls start the programs that the layout names, with the arguments that it writes.
    #[arg(long, conflicts_with = "no_send")]
    allow_run: bool,
}

fn moved(text: &str) -> Result<(String, String), String> {
    let (name, place) = text.split_once('=').ok_or("write it like desk=127.0.0.1:53000")?;
    Ok((name.to_owned(), place.to_owned()))
}

/// Says that the messages of `layout` are off, if it has any.
pub(crate) fn tell_off(layout: &Layout, reason: &str) {
    if layout.sends() {
        errln!("The messages of this layout to other programs are off: {reason}.");
    }
}

impl SendArgs {
    /// Opens the way to the targets of `layout`, which the operator has named; says where its messages go.
    pub(crate) fn open(&self, layout: &Layout) -> Result<(TargetSink, LoadedPlan), Failure> {
        let plan = self.plan(layout).map_err(Failure::Other)?;
        if !plan.is_empty() {
            let names: Vec<&str> = plan.targets.iter().map(|target| target.name.as_str()).collect();
            errln!("Controls send to {}; -v shows every message.", names.join(", "));
            self.tell_programs(&plan);
        } else if self.no_send {
            tell_off(layout, "--no-send");
        }
        let command = || {
            let mut command = own_program::command()?;
            command.arg("guardian");
            Ok(command)
        };
        TargetSink::start(layout, plan, Box::new(command))
            .map_err(|error| Failure::Other(format!("messages can't be sent: {error}")))
    }

    /// Uses the messages of the layout's file after it was saved.
    pub(crate) fn reload(&self, messages: &LoadedPlan, layout: &Layout) {
        match self.plan(layout) {
            Ok(plan) => messages.load(layout, plan),
            Err(problem) => messages.stop(layout, &problem),
        }
    }

    /// Says that the programs of the layout do not start, if it has any and they are not allowed.
    fn tell_programs(&self, plan: &MessagePlan) {
        let programs = plan.targets.iter().filter(|target| target.to.sort() == TargetSort::Program);
        let names: Vec<&str> = programs.map(|target| target.name.as_str()).collect();
        if !self.allow_run && !names.is_empty() {
            errln!("No program starts for {}: that needs --allow-run.", names.join(", "));
        }
    }

    /// The messages, with the targets where this command line puts them.
    fn plan(&self, layout: &Layout) -> Result<MessagePlan, String> {
        if self.no_send {
            return Ok(MessagePlan::default());
        }
        let mut plan = layout.plan();
        for (name, place) in &self.targets {
            redirect(&mut plan.targets, name, place)?;
        }
        for target in &mut plan.targets {
            if let Destination::Run(program) = &mut target.to {
                program.is_allowed = self.allow_run;
            }
        }
        Ok(plan)
    }
}
