//! Integration tests of the soil contact model.

mod rut_depth;
mod vehicles;
