//! The ROS nodes (the rim): `explore_node`, and `sim_node` in the place of a robot. Each is a
//! program on the ROS adapter; bin/ holds their thin `main`. `doctor/` looks at what they need.

mod doctor;
mod explore;
mod sim;

pub use doctor::{DoctorOptions, Finding, FindingLevel, examine};
pub use explore::{Activity, ExploreNodeError, Session, explore_node, explore_with};
pub use sim::{SimNodeError, sim_node, simulate_with};
