//! The messages of feet in a region: `Contacts(Mpe("synth"))`.

use super::node::Node;
use super::problem::Problem;
use super::send::address;
use super::send_codecs::{OscSettingsRecord, write_osc};
use crate::messages::{ARRIVAL_N, ContactPayload, ContactSending, MAX_MESSAGES, MpeSettings, OscArgument};
use underfoot_format::codec::{At, By, List};
use underfoot_format::describe::{Description, FieldType};
use underfoot_format::text::RonText;
use underfoot_format::{Codec, Rec, Record, list, num, record};

record! {
    /// Feet that count.
    struct ArrivalRecord = "Contacts", Copy;
    /// The force at which a foot arrives; it leaves at half of it.
    press_n: f32 = "press_n", num(10.0..=1000.0) => ARRIVAL_N;
}

/// The messages of a region.
pub(super) const CONTACTS: List<At<By<ContactSending>>> = list("message", MAX_MESSAGES, At(CONTACT));

const CONTACT: By<ContactSending> = By {
    shape: || FieldType::Words("Contacts(Osc(target, address) | Mpe(target) | Pointer(target))"),
    read: |node, ()| read(node),
    write,
    stand_in: || ContactSending {
        target: String::new(),
        payload: ContactPayload::Pointer,
        press_n: ARRIVAL_N,
    },
};

const FORM: &str = "Contacts(Mpe(\"synth\"))";
const OSC: &str = "Osc(\"desk\", \"/foot\")";
const MPE: &str = "Mpe(\"synth\", (from: 48, to: 72))";
const POINTER: &str = "Pointer(\"viewer\")";

/// The settings of MPE where none are written: two octaves around the middle C.
const USUAL_MPE: MpeSettings = MpeSettings { from: 48, to: 72, feet: 15, force_n: 800.0 };

fn read(node: Node<'_>) -> Option<ContactSending> {
    let call = node.call(&["Contacts"])?;
    let ([message], arrival) = call.values(FORM)?;
    let arrival = arrival
        .map_or(Some(ARRIVAL_N), |node| node.record::<ArrivalRecord>(None, &()).map(|record| record.press_n));
    let (target, payload) = payload(Node { name: "message", ..message })?;
    Some(ContactSending { target, payload, press_n: arrival? })
}

fn payload(node: Node<'_>) -> Option<(String, ContactPayload)> {
    let call = node.call(&["Osc", "Mpe", "Pointer"])?;
    let target = |node: Node<'_>| Node { name: "target", ..node }.id().map(str::to_owned);
    match call.name {
        "Osc" => {
            let ([to, at], settings) = call.values(OSC)?;
            let settings = settings
                .map_or(Some(OscSettingsRecord::PLAIN), |node| node.record::<OscSettingsRecord>(None, &()));
            let as_written = |_: Node<'_>, text: &str| Some(text.to_owned());
            let (to, at) = (target(to), address(Node { name: "address", ..at }, &as_written));
            let settings = settings?.settings();
            if settings.arguments.iter().flatten().any(|argument| *argument == OscArgument::Value) {
                let problem = Problem::error(node.span(), "a foot has no value");
                node.report(problem.expected("expected foot, x, y, force, numbers and texts"));
                return None;
            }
            Some((to?, ContactPayload::Osc(at?, settings)))
        }
        "Mpe" => {
            let ([to], settings) = call.values(MPE)?;
            let settings = settings.map_or(Some(USUAL_MPE), |node| node.record(None, &()));
            Some((target(to)?, ContactPayload::Mpe(settings?)))
        }
        _ => {
            let ([to], extra) = call.values(POINTER)?;
            let to = call.without(extra, POINTER, target(to))?;
            Some((to?, ContactPayload::Pointer))
        }
    }
}

/// Returns the text of one message.
fn write(sending: &ContactSending) -> RonText {
    let target = RonText::quoted(&*sending.target);
    let payload = match &sending.payload {
        ContactPayload::Osc(address, settings) => {
            let values = [target, RonText::quoted(&**address)];
            RonText::Call("Osc", values.into_iter().chain(write_osc(settings)).collect())
        }
        ContactPayload::Mpe(settings) if *settings == USUAL_MPE => RonText::Call("Mpe", vec![target]),
        ContactPayload::Mpe(settings) => RonText::Call("Mpe", vec![target, Rec.write(settings)]),
        ContactPayload::Pointer => RonText::Call("Pointer", vec![target]),
    };
    let arrival = ArrivalRecord { press_n: sending.press_n };
    let usual = sending.press_n == ARRIVAL_N;
    let values = [payload].into_iter().chain((!usual).then(|| Rec.write(&arrival)));
    RonText::Call("Contacts", values.collect())
}

/// Writes the messages of a region.
pub(super) fn write_all(sendings: &[ContactSending]) -> RonText {
    RonText::List(sendings.iter().map(write).collect())
}

/// Describes the forms of messages of feet for the reference.
pub(super) fn describe() -> Vec<Description> {
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    vec![
        with(
            "Contacts",
            "`Contacts(message)`, in `send` of a region: the feet on its free floor, each by itself. `Osc(target, address)` \
             sends `foot`, `x`, `y` and `force`, with force 0 when the foot leaves; `from` and `to` scale the places from \
             the edges of the region. `Pointer(target)` moves the pointer to the place of the first foot; the edges of the \
             region are those of the screen.",
            ArrivalRecord::describe(),
        ),
        with(
            "Mpe",
            "`Contacts(Mpe(target))`: each foot is a voice of MPE in the lower zone, with one member channel per foot.",
            MpeSettings::describe(),
        ),
    ]
}
