//! Spur gears with modified teeth: geometry, stiffness, contact, transmission error, and the search for good ones.
//!
//! Must not know: YAML, studies, files.

pub mod gear;
pub mod numeric;
pub mod optimize;
