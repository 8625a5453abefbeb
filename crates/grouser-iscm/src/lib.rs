//! Integration soil contact model (ISCM): wheeled and tracked vehicles on soft ground.
pub mod contact;
pub mod equilibrium;
pub mod gear;
pub mod imprint;
pub mod machine;
pub mod mechanism;
pub mod polygon;
pub mod pressure;
pub mod rolling_resistance;
pub mod route;
pub mod run;
pub mod rut;
pub mod terrain;
pub mod vehicle;
