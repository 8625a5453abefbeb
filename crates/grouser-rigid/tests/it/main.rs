//! Rigid bodies against closed forms.

mod closed_forms;
mod refusals;
mod restart;
