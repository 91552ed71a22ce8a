//! Lets rosrust find the message definitions: those of other packages in `vendor/`, and our
//! own, which it expects in a folder named like their package.

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
