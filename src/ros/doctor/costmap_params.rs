//! What the parameters of move_base say of its global costmap, as far as they are set.

use crate::geometry::Footprint;
use serde_json::Value;

/// Numbers and switches of costmap_2d.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CostmapParams {
    /// `track_unknown_space` of the costmap.
    pub track_unknown_space: Option<bool>,
    /// The layers that have a `track_unknown_space` of their own.
    pub layers: Vec<(String, bool)>,
    /// The outline, from `footprint` or `robot_radius`.
    pub footprint: Option<Footprint>,
    /// `inflation_radius`, metres.
    pub inflation_radius_m: Option<f64>,
}

impl CostmapParams {
    /// Reads the tree below `NAME/global_costmap`.
    #[must_use]
    pub fn of(tree: &Value) -> Self {
        let tables = tree.as_object().into_iter().flatten().filter(|(_, value)| value.is_object());
        let layers = tables
            .filter_map(|(name, table)| Some((name.clone(), table.get("track_unknown_space")?.as_bool()?)))
            .collect();
        let radius = tree.get("robot_radius").and_then(Value::as_f64).map(Footprint::RadiusM);
        let polygon = tree.get("footprint").and_then(corners).map(Footprint::PolygonM);
        let footprint = polygon.or(radius).filter(|footprint| footprint.validate().is_ok());
        Self {
            track_unknown_space: tree.get("track_unknown_space").and_then(Value::as_bool),
            layers,
            footprint,
            inflation_radius_m: inflation_radius(tree),
        }
    }

    /// The name of the first switch, below the costmap's, that makes the unknown free.
    #[must_use]
    pub fn unknown_is_off(&self) -> Option<String> {
        let whole = (self.track_unknown_space == Some(false)).then(|| "track_unknown_space".to_owned());
        let layer = || self.layers.iter().find(|(_, is_on)| !is_on);
        whole.or_else(|| layer().map(|(name, _)| format!("{name}/track_unknown_space")))
    }
}

/// That of a layer, or, as before layers, that of the costmap itself.
fn inflation_radius(tree: &Value) -> Option<f64> {
    let tables = tree.as_object().into_iter().flatten().map(|(_, table)| table);
    tables.chain([tree]).find_map(|table| table.get("inflation_radius").and_then(Value::as_f64))
}

/// Corners as a list, or as a text that holds one; `[]` is none.
fn corners(value: &Value) -> Option<Vec<[f64; 2]>> {
    let corners: Vec<[f64; 2]> = match value {
        Value::String(text) => serde_json::from_str(text).ok()?,
        value => serde_json::from_value(value.clone()).ok()?,
    };
    (!corners.is_empty()).then_some(corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn switches_of_the_costmap_and_of_its_layers_are_read() {
        let params = |tree| CostmapParams::of(&tree);
        assert_eq!(params(json!({})), CostmapParams::default());
        let off = params(json!({"track_unknown_space": false, "obstacle_layer": {"track_unknown_space": true}}));
        assert_eq!(off.unknown_is_off().as_deref(), Some("track_unknown_space"));
        let layer = params(json!({"track_unknown_space": true, "obstacles": {"track_unknown_space": false}}));
        assert_eq!(layer.unknown_is_off().as_deref(), Some("obstacles/track_unknown_space"));
        assert_eq!(params(json!({"track_unknown_space": true})).unknown_is_off(), None);
    }

    #[test]
    fn outlines_come_as_radius_list_or_text() {
        let footprint = |tree| CostmapParams::of(&tree).footprint;
        let square = vec![[-0.2, -0.2], [-0.2, 0.2], [0.2, 0.2], [0.2, -0.2]];
        assert_eq!(footprint(json!({"robot_radius": 0.18})), Some(Footprint::RadiusM(0.18)));
        assert_eq!(footprint(json!({"footprint": square})), Some(Footprint::PolygonM(square.clone())));
        let text = "[[-0.2, -0.2], [-0.2, 0.2], [0.2, 0.2], [0.2, -0.2]]";
        assert_eq!(footprint(json!({"footprint": text, "robot_radius": 0.1})), Some(Footprint::PolygonM(square)));
        assert_eq!(footprint(json!({"footprint": [], "robot_radius": 0.1})), Some(Footprint::RadiusM(0.1)));
        assert_eq!(footprint(json!({"footprint": "none"})), None);
    }

    #[test]
    fn the_inflation_radius_stands_in_a_layer_or_beside_them() {
        let radius = |tree| CostmapParams::of(&tree).inflation_radius_m;
        assert_eq!(radius(json!({"inflation_layer": {"inflation_radius": 0.5}, "inflation_radius": 0.3})), Some(0.5));
        assert_eq!(radius(json!({"inflation_radius": 1})), Some(1.0));
        assert_eq!(radius(json!({"width": 3})), None);
    }
}
