//! One tree of settings laid over another.

use serde_json::Value;

/// Lays `over` on `base`: what it names is replaced, what it does not name stays. A
/// table that is given another `name` is replaced as a whole: the settings of a dwa are
/// none of a path follower's.
pub fn merge(base: &mut Value, over: Value) {
    match (base, over) {
        (Value::Object(base), Value::Object(over)) => {
            let renamed = over.get("name").is_some_and(|name| base.get("name") != Some(name));
            if renamed {
                base.clear();
            }
            for (key, value) in over {
                merge(base.entry(key).or_insert(Value::Null), value);
            }
        }
        (base, over) => *base = over,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn check(base: Value, over: Value, expected: &Value) {
        let mut merged = base;
        merge(&mut merged, over);
        assert_eq!(merged, *expected);
    }

    #[test]
    fn what_is_not_named_stays() {
        check(json!({"a": {"b": 1, "c": 2}}), json!({"a": {"c": 3}}), &json!({"a": {"b": 1, "c": 3}}));
        check(json!({"a": [1, 2]}), json!({"a": [3]}), &json!({"a": [3]}));
    }

    #[test]
    fn another_name_replaces_the_table() {
        check(json!({"name": "dwa", "x": 1}), json!({"name": "dwa", "y": 2}), &json!({"name": "dwa", "x": 1, "y": 2}));
        check(json!({"name": "dwa", "x": 1}), json!({"name": "p"}), &json!({"name": "p"}));
    }
}
