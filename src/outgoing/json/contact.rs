//! Contacts, and the cursor of a region.

use serde::{Deserialize, Deserializer, Serialize};

use super::text::Few;
use crate::sense::{Contact, ContactId, Covariance, Cursor, Quality};

/// Maximum number of contacts that a reader keeps: more than fit into the longest line of a floor.
const MOST_CONTACTS: usize = 2048;

/// A contact. The optional fields are those of `underfoot sense`; other lines leave them out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Its number.
    pub id: ContactId,
    /// Centroid in floor metres, eastwards.
    pub x_m: f32,
    /// Centroid in floor metres, northwards.
    pub y_m: f32,
    /// Force in newtons.
    pub force_n: f32,
    /// Column and row of the tiles that carry it, heaviest first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiles: Option<Vec<[u16; 2]>>,
    /// Velocity of the centroid in metres per second, eastwards.
    #[serde(alias = "vx_m_s")]
    pub x_velocity_m_s: f32,
    /// Velocity of the centroid in metres per second, northwards.
    #[serde(alias = "vy_m_s")]
    pub y_velocity_m_s: f32,
    /// Uncertainty of the centroid, in square metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covariance_m2: Option<Covariance>,
    /// [`Contact::ambiguous`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ambiguous: Option<bool>,
    /// The worst quality among its tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quality: Option<Quality>,
    /// [`Contact::difference`] in metres; null on a single tile.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "nullable")]
    pub difference_m: Option<Option<[f32; 2]>>,
}

/// Reads a field that may be null.
fn nullable<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<Option<T>>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}

impl From<&Contact> for ContactRecord {
    fn from(contact: &Contact) -> Self {
        Self {
            id: contact.id,
            x_m: contact.centroid.x,
            y_m: contact.centroid.y,
            force_n: contact.force.0,
            x_velocity_m_s: contact.velocity.x,
            y_velocity_m_s: contact.velocity.y,
            ..Self::default()
        }
    }
}

impl ContactRecord {
    /// Returns the record of `contact` with all fields.
    #[must_use]
    pub fn full(contact: &Contact) -> Self {
        Self {
            tiles: Some(contact.tiles.iter().map(|load| [load.tile.column, load.tile.row]).collect()),
            covariance_m2: Some(contact.covariance),
            ambiguous: Some(contact.ambiguous),
            quality: Some(contact.quality),
            difference_m: Some(contact.difference.map(Into::into)),
            ..Self::from(contact)
        }
    }
}

/// The contacts on the floor: a line `contacts`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ContactsRecord {
    /// All of them.
    pub contacts: Few<ContactRecord, MOST_CONTACTS>,
}

impl From<&[Contact]> for ContactsRecord {
    fn from(contacts: &[Contact]) -> Self {
        Self { contacts: contacts.iter().map(ContactRecord::from).collect() }
    }
}

/// The cursor of a region.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CursorRecord {
    /// The contact that points.
    pub id: ContactId,
    /// Its position in floor metres, eastwards.
    pub x_m: f32,
    /// Its position in floor metres, northwards.
    pub y_m: f32,
    /// Force in newtons.
    pub force_n: f32,
}

impl From<Cursor> for CursorRecord {
    fn from(cursor: Cursor) -> Self {
        let (position, force_n) = (cursor.position, cursor.force.0);
        Self { id: cursor.contact, x_m: position.x, y_m: position.y, force_n }
    }
}

/// A line of `underfoot sense`: one instant of a force table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SensedRecord {
    /// The table's time, in seconds.
    pub t_s: f64,
    /// The contacts with all fields.
    pub contacts: Vec<ContactRecord>,
    /// The cursor of a region as large as the floor; null without one.
    pub cursor: Option<CursorRecord>,
}
