//! Parameters from the master as a tree that serde reads.

use rosrust::api::Ros;
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
