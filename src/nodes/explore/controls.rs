//! What users may ask for while the node runs: the services and topics that hand it in at the
//! desk.

use super::connect::Connected;
use super::desk::{Control, Desk, Request};
use super::saving::save_as;
use super::settings::{ExploreNodeError, Settings};
use crate::ros::msg::std_msgs::Bool;
use crate::ros::msg::std_srvs::{Trigger, TriggerRes};
use crate::ros::{Feed, Node, Service};
use std::time::Duration;

/// Commands come seldom: so often it is looked whether all who tell them are met.
const LOOK: Duration = Duration::from_secs(60);
/// So long a service waits for the thread that explores.
const ANSWER_WITHIN: Duration = Duration::from_secs(5);

/// The services by which an operator controls the exploration.
const SERVICES: [(&str, Control); 7] = [
    ("~start", Control::Start),
    ("~pause", Control::Pause),
    ("~resume", Control::Resume),
    ("~stop", Control::Stop),
    ("~return_home", Control::ReturnHome),
    ("~clear_blacklist", Control::ClearBlacklist),
    ("~explain", Control::Explain),
];

/// The topics and services that take requests, as long as this lives.
pub struct Controls {
    _resume: Feed,
    _services: Vec<Service>,
}

impl Controls {
    /// Begins to take requests: the services, and `explore/resume` (explore_lite).
    ///
    /// # Errors
    /// [`ExploreNodeError`] when a service cannot be offered.
    pub fn listen(
        node: &Node,
        settings: &Settings,
        connected: &Connected,
        desk: &Desk,
    ) -> Result<Self, ExploreNodeError> {
        let resume = listen_to_resume(node, desk);
        let mut services = vec![serve_save_map(node, settings, connected)?];
        for (name, control) in SERVICES {
            services.push(serve(node, name, control, desk)?);
        }
        Ok(Self { _resume: resume, _services: services })
    }
}

/// Offers one control as a service.
fn serve(node: &Node, name: &'static str, control: Control, desk: &Desk) -> Result<Service, ExploreNodeError> {
    let (desk, log) = (desk.clone(), node.log().clone());
    Ok(node.serve::<Trigger>(name, move |_| {
        let answer = desk.ask(Request::Control(control), ANSWER_WITHIN);
        if control != Control::Explain {
            log.info(format_args!("{name}: {}", answer.message));
        }
        Ok(TriggerRes { success: answer.success, message: answer.message })
    })?)
}

/// Saves the newest map at once, whatever the exploration is about.
fn serve_save_map(node: &Node, settings: &Settings, connected: &Connected) -> Result<Service, ExploreNodeError> {
    let (maps, map_file, log) = (connected.maps.clone(), settings.params.map_file.clone(), node.log().clone());
    let path = if map_file.is_empty() { "map".to_owned() } else { map_file };
    Ok(node.serve::<Trigger>("~save_map", move |_| {
        let saved = match maps.newest() {
            Some(map) => save_as(&path, &map).map(|p| p.yaml.display().to_string()).map_err(|e| e.to_string()),
            None => Err("no map has come yet".to_owned()),
        };
        let (success, message) = match saved {
            Ok(file) => (true, file),
            Err(why) => (false, why),
        };
        log.info(format_args!("~save_map: {message}"));
        Ok(TriggerRes { success, message })
    })?)
}

fn listen_to_resume(node: &Node, desk: &Desk) -> Feed {
    let desk = desk.clone();
    Feed::listen_seldom(node, "explore/resume", 5, LOOK, move |message: Bool, _| {
        desk.hand_in(Request::Control(if message.data { Control::Resume } else { Control::Pause }));
    })
}
