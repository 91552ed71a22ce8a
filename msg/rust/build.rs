//! Lets rosrust find the message definitions: those of other packages in `vendor/`, and our
//! own, which it expects in a folder named like their package. Actions become the seven
//! messages that catkin makes of them.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let own = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let vendored = own.join("vendor");
    let staged = PathBuf::from(env::var("OUT_DIR")?).join("messages");
    let folder = staged.join("frontier_explorer/msg");
    fs::create_dir_all(&folder)?;
    for file in definitions(&own, "msg")? {
        if let Some(name) = file.file_name() {
            fs::copy(&file, folder.join(name))?;
        }
    }
    for file in definitions(&own, "action")? {
        if let Some(name) = file.file_stem().and_then(|name| name.to_str()) {
            write_action(&folder, name, &fs::read_to_string(&file)?)?;
        }
    }
    // cargo looks at a folder's own time only: every file is named.
    watch(&own)?;
    println!("cargo:rustc-env=ROSRUST_MSG_PATH={}:{}", vendored.display(), staged.display());
    // A ROS installation must not come before what is checked here.
    println!("cargo:rustc-env=ROS_PACKAGE_PATH=");
    println!("cargo:rustc-env=CMAKE_PREFIX_PATH=");
    Ok(())
}

fn definitions(folder: &Path, extension: &str) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == extension) {
            files.push(path);
        }
    }
    Ok(files)
}

/// The messages of an action: goal, result and feedback, each also as it is sent.
fn write_action(folder: &Path, name: &str, text: &str) -> Result<(), Box<dyn Error>> {
    let parts: Vec<&str> = text.split("\n---\n").collect();
    let [goal, result, feedback] = parts.as_slice() else {
        return Err(format!("{name}.action: must have a goal, a result and a feedback").into());
    };
    let status = "actionlib_msgs/GoalStatus status";
    let messages = [
        (format!("{name}Goal"), (*goal).to_owned()),
        (format!("{name}Result"), (*result).to_owned()),
        (format!("{name}Feedback"), (*feedback).to_owned()),
        (format!("{name}ActionGoal"), format!("Header header\nactionlib_msgs/GoalID goal_id\n{name}Goal goal\n")),
        (format!("{name}ActionResult"), format!("Header header\n{status}\n{name}Result result\n")),
        (format!("{name}ActionFeedback"), format!("Header header\n{status}\n{name}Feedback feedback\n")),
        (
            format!("{name}Action"),
            format!(
                "{name}ActionGoal action_goal\n{name}ActionResult action_result\n{name}ActionFeedback action_feedback\n"
            ),
        ),
    ];
    for (name, text) in messages {
        fs::write(folder.join(format!("{name}.msg")), text)?;
    }
    Ok(())
}

fn watch(folder: &Path) -> std::io::Result<()> {
    println!("cargo:rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            watch(&path)?;
        } else {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
    Ok(())
}
