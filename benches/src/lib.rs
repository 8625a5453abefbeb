//! What the benches of the workspace share: beds at rest, figures as a table and as JSON, and precision as an argument.

pub mod beds;
pub mod figures;
pub mod scalar;
