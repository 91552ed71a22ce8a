//! Parameters from the master as a tree that serde reads.

use rosrust::api::Ros;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

/// The parameters below a node's name; an empty table when there are none.
pub(super) fn tree(ros: &Ros, node: &str) -> Result<Value, String> {
    let param = ros.param(node).ok_or_else(|| format!("{node} is no name"))?;
    if !param.exists().map_err(|e| e.to_string())? {
        return Ok(Value::Object(Map::new()));
    }
    param.get::<Value>().map_err(|e| e.to_string())
}

/// A parameter found by searching upwards from the node, as a string.
pub(super) fn searched(ros: &Ros, name: &str) -> Option<String> {
    let found = ros.param(name)?.search().ok()?;
    ros.param(&found)?.get::<String>().ok()
}

/// Takes a parameter away.
pub(super) fn delete(ros: &Ros, name: &str) -> Result<(), String> {
    let param = ros.param(name).ok_or_else(|| format!("{name} is no name"))?;
    param.delete().map_err(|e| e.to_string())
}

/// A tree as the parameter server knows values: whole numbers of 32 bits, larger ones as numbers
/// with a point, and without what is null.
pub struct ParamTree<'a>(pub &'a Value);

impl Serialize for ParamTree<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Value::Number(number) => match number.as_i64().and_then(|whole| i32::try_from(whole).ok()) {
                Some(whole) => serializer.serialize_i32(whole),
                None => serializer.serialize_f64(number.as_f64().unwrap_or(f64::NAN)),
            },
            Value::Array(items) => serializer.collect_seq(items.iter().map(ParamTree)),
            Value::Object(table) => {
                let told = || table.iter().filter(|(_, value)| !value.is_null());
                let mut map = serializer.serialize_map(Some(told().count()))?;
                for (key, value) in told() {
                    map.serialize_entry(key, &ParamTree(value))?;
                }
                map.end()
            }
            other => other.serialize(serializer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_tree_has_no_nulls_and_no_long_numbers() {
        let tree = json!({"a": null, "b": [1, 2.5], "c": {"d": 5_000_000_000_i64, "e": "text", "f": true}});
        let told = serde_json::to_value(ParamTree(&tree)).unwrap();
        assert_eq!(told, json!({"b": [1, 2.5], "c": {"d": 5e9, "e": "text", "f": true}}));
    }
}
