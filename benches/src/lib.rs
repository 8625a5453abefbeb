//! What the benches of the workspace share: beds at rest, and figures as a table and as JSON.

pub mod beds;
pub mod figures;
