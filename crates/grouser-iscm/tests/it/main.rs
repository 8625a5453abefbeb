//! Integration tests of the soil contact model.

mod multi_pass;
mod restart;
mod single_wheel;
mod verification_cases;
