//! TUIO 2.0: pointers with pressure.

use rosc::{OscPacket, OscTime, OscType};

use super::tuio::{LastContacts, News, SHOE_M, Surface, heaviest, message, send_frame, session};
use crate::floor::Geometry;
use crate::sense::Contact;
use crate::units::Instant;

/// Force that is reported as pressure 1, in newtons: a person of 100 kg on one foot. Greater forces are reported as
/// 1.
const TUIO_FULL_FORCE_N: f32 = 1000.0;

/// Contacts as TUIO 2.0 pointers, with their force as pressure.
///
/// Positions run from 0 to 1, from the floor's north-west corner, y towards the south; the floor's dimension is in
/// millimetres. Pressure is force over 1000 N, at most 1. Type, user and component are 0: the floor identifies
/// feet, not people.
///
/// # Source
/// TUIO 2.0 protocol specification (tuio.org).
#[derive(Debug)]
pub struct Tuio2 {
    memory: LastContacts,
    /// Width and height in millimetres, 16 bits each.
    dimension: i32,
    /// Half a shoe's width, in units of the floor's width.
    radius: f32,
    source: String,
    /// The number of the next bundle.
    next: i32,
}

impl Tuio2 {
    /// An encoder for a floor of this geometry. `source` is its name, such as `underfoot:0@10.0.0.5`; its bundles are
    /// numbered from `first` on ([`super::tuio_first_frame`]).
    #[must_use]
    pub fn new(geometry: &Geometry, source: &str, first: i32) -> Self {
        let surface = Surface::of(geometry);
        let millimetres = (surface.size() * 1000.0).round();
        // A side beyond 65 m is reported as 65 m.
        let dimension = (u32::from(millimetres.x as u16) << 16) | u32::from(millimetres.y as u16);
        Self {
            memory: LastContacts::of(surface),
            dimension: dimension.cast_signed(),
            radius: 0.5 * SHOE_M.y / surface.size().x,
            source: source.into(),
            next: first,
        }
    }

    /// Passes each datagram of one frame to `send`, none larger than [`super::TUIO_DATAGRAM`]; returns the number of
    /// contacts left out.
    ///
    /// A bundle holds `/tuio2/frm` with the bundle's number and `clock`, `/tuio2/ptr` for the contacts that have
    /// changed (all of them once a second) and `/tuio2/alv` with all contacts; a frame that is too large takes
    /// several bundles, each with its own number and an `alv` without the new contacts that are still to come.
    /// Without contacts `alv` is empty, which is also the goodbye.
    pub fn write(
        &mut self,
        at: Instant,
        clock: OscTime,
        contacts: &[Contact],
        send: impl FnMut(&[u8]),
    ) -> usize {
        let (contacts, left_out) = heaviest(contacts);
        let news = self.memory.news(at, &contacts);
        let mut next = self.next;
        let bundle = |number, alive, pointers| {
            let frm = vec![
                OscType::Int(number),
                OscType::Time(clock),
                OscType::Int(self.dimension),
                OscType::String(self.source.clone()),
            ];
            let mut content = vec![message("/tuio2/frm", frm)];
            content.extend::<Vec<OscPacket>>(pointers);
            content.push(message("/tuio2/alv", alive));
            content
        };
        send_frame(&mut next, &contacts, &news, |news| self.pointer(news), bundle, send);
        self.next = next;
        left_out
    }

    /// `ptr s_id tu_id c_id x_pos y_pos angle shear radius press x_vel y_vel p_vel m_acc p_acc`.
    fn pointer(&self, news: &News) -> OscPacket {
        let News { id, told, .. } = *news;
        let pressure = |force: f32| force / TUIO_FULL_FORCE_N;
        let (type_and_user, component) = (OscType::Int(0), OscType::Int(0));
        let (shear, pressure_acceleration) = (0.0, 0.0);
        let floats = [
            told.place.x,
            told.place.y,
            told.angle,
            shear,
            self.radius,
            pressure(told.force).clamp(0.0, 1.0),
            told.velocity.x,
            told.velocity.y,
            pressure(told.force_change),
            told.acceleration,
            pressure_acceleration,
        ];
        let mut args = vec![session(id), type_and_user, component];
        args.extend(floats.map(OscType::Float));
        message("/tuio2/ptr", args)
    }
}
