//! Readers, generators and the mesh doctor, seen from outside.

mod generators;
mod mesh_doctor;
mod mesh_files;
mod readers;
