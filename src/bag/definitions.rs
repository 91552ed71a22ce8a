//! The message types that are read and written: names, md5 sums, definitions.

/// A message type that this program reads or writes in bags.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MessageType {
    /// `nav_msgs/OccupancyGrid`.
    Map,
    /// `map_msgs/OccupancyGridUpdate`.
    MapUpdate,
    /// `tf2_msgs/TFMessage`, and `tf/tfMessage`, which is the same.
    Transforms,
    /// `sensor_msgs/LaserScan`.
    Scan,
    /// `nav_msgs/Odometry`.
    Odometry,
    /// `geometry_msgs/PoseStamped`.
    Pose,
    /// `nav_msgs/Path`.
    Path,
    /// `move_base_msgs/MoveBaseActionGoal`.
    Goal,
    /// `move_base_msgs/MoveBaseActionResult`.
    Result,
    /// `rosgraph_msgs/Clock`.
    Clock,
    /// `visualization_msgs/MarkerArray`; only written.
    Markers,
}

impl MessageType {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Map,
        Self::MapUpdate,
        Self::Transforms,
        Self::Scan,
        Self::Odometry,
        Self::Pose,
        Self::Path,
        Self::Goal,
        Self::Result,
        Self::Clock,
        Self::Markers,
    ];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Map => "nav_msgs/OccupancyGrid",
            Self::MapUpdate => "map_msgs/OccupancyGridUpdate",
            Self::Transforms => "tf2_msgs/TFMessage",
            Self::Scan => "sensor_msgs/LaserScan",
            Self::Odometry => "nav_msgs/Odometry",
            Self::Pose => "geometry_msgs/PoseStamped",
            Self::Path => "nav_msgs/Path",
            Self::Goal => "move_base_msgs/MoveBaseActionGoal",
            Self::Result => "move_base_msgs/MoveBaseActionResult",
            Self::Clock => "rosgraph_msgs/Clock",
            Self::Markers => "visualization_msgs/MarkerArray",
        }
    }

    /// Its md5 sum, as `rosmsg md5` prints it; `tests/messages.rs` holds the same.
    #[must_use]
    pub const fn md5(self) -> &'static str {
        match self {
            Self::Map => "3381f2d731d4076ec5c71b0759edbe4e",
            Self::MapUpdate => "b295be292b335c34718bd939deebe1c9",
            Self::Transforms => "94810edda583a504dfda3829e70d7eec",
            Self::Scan => "90c7ef2dc6895d81024acba2ac42f369",
            Self::Odometry => "cd5e73d190d741a2f92e81eda573aca7",
            Self::Pose => "d3812c3cbc69362b77dc0b19b345f8f5",
            Self::Path => "6227e2b7e9cce15051f669a5e197bbf7",
            Self::Goal => "660d6895a1b9a16dce51fbdd9a64a56b",
            Self::Result => "1eb06eeff08fa7ea874431638cb52332",
            Self::Clock => "a9c97c1d230cfc112e270351a944ee47",
            Self::Markers => "d155b9ce5188fbaf89745847fd5882d7",
        }
    }

    /// The type of a connection, if it is one of these, in the version that is known.
    #[must_use]
    pub fn of(kind: &str, md5: &str) -> Option<Self> {
        let known = Self::ALL.into_iter().find(|known| known.md5() == md5)?;
        let is_named = known.name() == kind || (known == Self::Transforms && kind == "tf/tfMessage");
        is_named.then_some(known)
    }

    /// Whether its messages begin with a `std_msgs/Header`.
    #[must_use]
    pub const fn has_header(self) -> bool {
        !matches!(self, Self::Transforms | Self::Clock | Self::Markers)
    }

    /// The definition with all that it uses, as a bag holds it.
    #[must_use]
    pub fn definition(self) -> String {
        let mut text = source(self.name()).unwrap_or_default().to_owned();
        let mut used = Vec::new();
        collect(self.name(), &mut used);
        for name in used {
            text += &format!("\n{}\nMSG: {name}\n{}", "=".repeat(80), source(&name).unwrap_or_default());
        }
        text
    }
}

/// The types that a definition uses, each once.
fn collect(name: &str, used: &mut Vec<String>) {
    let package = name.split('/').next().unwrap_or_default();
    for line in source(name).unwrap_or_default().lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        let Some(field) = line.split_whitespace().next() else { continue };
        let field = field.split('[').next().unwrap_or_default();
        let full = match field {
            "Header" => "std_msgs/Header".to_owned(),
            _ if field.contains('/') => field.to_owned(),
            _ => format!("{package}/{field}"),
        };
        if source(&full).is_some() && !used.contains(&full) {
            used.push(full.clone());
            collect(&full, used);
        }
    }
}

/// The fields of a type, if it is one of `msg/vendor`.
fn source(name: &str) -> Option<&'static str> {
    SOURCES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

macro_rules! sources {
    ($($package:literal / $name:literal),* $(,)?) => {
        &[$((
            concat!($package, "/", $name),
            include_str!(concat!("../../msg/vendor/", $package, "/msg/", $name, ".msg")),
        )),*]
    };
}

const SOURCES: &[(&str, &str)] = sources![
    "actionlib_msgs" / "GoalID",
    "actionlib_msgs" / "GoalStatus",
    "geometry_msgs" / "Point",
    "geometry_msgs" / "Pose",
    "geometry_msgs" / "PoseStamped",
    "geometry_msgs" / "PoseWithCovariance",
    "geometry_msgs" / "Quaternion",
    "geometry_msgs" / "Transform",
    "geometry_msgs" / "TransformStamped",
    "geometry_msgs" / "Twist",
    "geometry_msgs" / "TwistWithCovariance",
    "geometry_msgs" / "Vector3",
    "map_msgs" / "OccupancyGridUpdate",
    "move_base_msgs" / "MoveBaseActionGoal",
    "move_base_msgs" / "MoveBaseActionResult",
    "move_base_msgs" / "MoveBaseGoal",
    "move_base_msgs" / "MoveBaseResult",
    "nav_msgs" / "MapMetaData",
    "nav_msgs" / "OccupancyGrid",
    "nav_msgs" / "Odometry",
    "nav_msgs" / "Path",
    "rosgraph_msgs" / "Clock",
    "sensor_msgs" / "LaserScan",
    "std_msgs" / "ColorRGBA",
    "std_msgs" / "Header",
    "tf2_msgs" / "TFMessage",
    "visualization_msgs" / "Marker",
    "visualization_msgs" / "MarkerArray",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_known_by_name_and_sum() {
        for kind in MessageType::ALL {
            assert_eq!(MessageType::of(kind.name(), kind.md5()), Some(kind));
            assert!(!kind.definition().is_empty(), "{kind:?}");
        }
        assert_eq!(MessageType::of("tf/tfMessage", MessageType::Transforms.md5()), Some(MessageType::Transforms));
        assert_eq!(MessageType::of("nav_msgs/OccupancyGrid", "0"), None);
    }

    #[test]
    fn a_definition_holds_all_that_it_uses_once() {
        assert!(MessageType::Result.definition().contains("MSG: move_base_msgs/MoveBaseResult\n"), "without fields");
        let text = MessageType::Goal.definition();
        for name in ["std_msgs/Header", "actionlib_msgs/GoalID", "geometry_msgs/Quaternion"] {
            assert_eq!(text.matches(&format!("MSG: {name}\n")).count(), 1, "{name}");
        }
    }
}
