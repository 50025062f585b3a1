//! Limits reports to the contacts in one area of a floor.

use std::borrow::Cow;

use crate::floor::{Area, Geometry};
use crate::sense::Contact;
use crate::sink::{EventSink, Report};
use crate::units::Instant;

/// Passes on all reports, except contacts beyond an area: the computer that serves the next area reports those.
pub struct ContactsWithin<S> {
    inner: S,
    area: Area,
    /// The whole floor.
    geometry: Geometry,
    contacts: Vec<Contact>,
}

impl<S: EventSink> ContactsWithin<S> {
    /// Reports to `inner` the contacts whose centroid is in `area` of the floor of this `geometry`.
    pub fn new(inner: S, area: Area, geometry: Geometry) -> Self {
        Self { inner, area, geometry, contacts: Vec::new() }
    }
}

impl<S: EventSink> EventSink for ContactsWithin<S> {
    fn report(&mut self, report: &Report<'_>) {
        let Report::Contacts(at, contacts) = report else { return self.inner.report(report) };
        let own = contacts.iter().filter(|contact| self.area.holds(&self.geometry, contact.centroid));
        self.contacts.clear();
        self.contacts.extend(own.cloned());
        self.inner.report(&Report::Contacts(*at, Cow::Borrowed(&self.contacts)));
    }

    fn poll(&mut self, now: Instant) {
        self.inner.poll(now);
    }

    fn dropped(&self) -> u64 {
        self.inner.dropped()
    }
}

impl<S> std::fmt::Debug for ContactsWithin<S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactsWithin").field("area", &self.area).finish_non_exhaustive()
    }
}
