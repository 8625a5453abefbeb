//! Integration tests of the soil contact model.

mod restart;
mod verification_cases;
