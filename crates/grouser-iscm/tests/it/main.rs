//! Integration tests of the soil contact model.

mod ground_and_laws;
mod machine_traction;
mod multi_pass;
mod random_starts;
mod restart;
mod single_wheel;
mod slack_tracks;
mod verification_cases;
