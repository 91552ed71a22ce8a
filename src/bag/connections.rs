//! The topics of a bag as their publishers published them.

use super::problems::Problems;
use super::record::Fields;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most connections, and the most bytes of their definitions, that are kept.
const MAX_CONNECTIONS: usize = 10_000;
pub const MAX_DEFINITION_BYTES: usize = 32 << 20;

/// A topic as one publisher published it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Connection {
    /// The topic's name.
    pub topic: String,
    /// The type, such as `nav_msgs/OccupancyGrid`.
    pub kind: String,
    /// The sum over the type's definition.
    pub md5: String,
    /// The type's definition, with those that it uses.
    pub definition: String,
    /// Who published it, if that was recorded.
    pub caller: String,
    /// Whether late subscribers get the last message.
    pub is_latching: bool,
}

/// The connections seen so far, by their numbers.
#[derive(Clone, Debug, Default)]
pub struct Connections {
    pub known: BTreeMap<u32, Arc<Connection>>,
    definition_bytes: usize,
}

impl Connections {
    /// Those that were read before.
    pub fn known(known: &BTreeMap<u32, Arc<Connection>>) -> Self {
        Self { known: known.clone(), definition_bytes: 0 }
    }

    /// Whether messages of a connection can be understood; tells of one that is unknown.
    pub fn has(&self, number: u32, problems: &mut Problems) -> bool {
        let is_known = self.known.contains_key(&number);
        if !is_known {
            problems.tell(format!("messages of connection {number}, which nothing describes, are left out"));
        }
        is_known
    }

    /// Takes in a connection record.
    pub fn take(&mut self, fields: &Fields<'_>, data: &[u8], problems: &mut Problems) {
        let Ok(number) = fields.u32("conn") else { return };
        let described = Fields::new(data);
        let connection = || Connection {
            topic: fields.text("topic"),
            kind: described.text("type"),
            md5: described.text("md5sum"),
            definition: described.text("message_definition"),
            caller: described.text("callerid"),
            is_latching: described.get("latching") == Some(b"1"),
        };
        self.insert(number, connection, problems);
    }

    /// Adds a connection; the first of a number counts.
    pub fn insert(&mut self, number: u32, connection: impl FnOnce() -> Connection, problems: &mut Problems) {
        if self.known.contains_key(&number) {
            return;
        }
        let connection = connection();
        self.definition_bytes += connection.definition.len();
        if self.known.len() >= MAX_CONNECTIONS || self.definition_bytes > MAX_DEFINITION_BYTES {
            problems.tell(format!("only the first {} connections are read", self.known.len()));
            return;
        }
        self.known.insert(number, Arc::new(connection));
    }
}
