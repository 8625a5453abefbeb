//! Tetrahedra in VTK's XML format (`.vtu`), as ParaView opens it.

use super::vtp::{Appended, PointField};

/// A tetrahedral mesh with fields on points and cells.
#[derive(Debug, Clone, Default)]
pub struct Tetrahedra<'a> {
    /// Simulated time [s].
    pub time: f64,
    /// Coordinates [m].
    pub points: Vec<[f64; 3]>,
    /// Points of all cells, one cell after the other.
    pub connectivity: Vec<u32>,
    /// Points of each cell: 4 or 10.
    pub per_cell: usize,
    /// Fields on the points.
    pub point_fields: Vec<(&'a str, PointField)>,
    /// Fields on the cells.
    pub cell_fields: Vec<(&'a str, PointField)>,
}

impl Tetrahedra<'_> {
    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let n_cells = self.connectivity.len() / self.per_cell.max(1);
        let mut file = Appended::default();
        let (mut points, mut of_points, mut of_cells, mut cells) =
            (String::new(), String::new(), String::new(), String::new());
        let coordinates = self.points.iter().flatten().flat_map(|x| x.to_le_bytes());
        file.array(&mut points, "Points", "Float64", 3, coordinates);
        self.point_fields.iter().for_each(|(name, field)| file.field(&mut of_points, name, field));
        self.cell_fields.iter().for_each(|(name, field)| file.field(&mut of_cells, name, field));
        let corners = self.connectivity.iter().flat_map(|&i| i64::from(i).to_le_bytes());
        file.array(&mut cells, "connectivity", "Int64", 1, corners);
        let ends = (1..=n_cells).flat_map(|i| ((i * self.per_cell) as i64).to_le_bytes());
        file.array(&mut cells, "offsets", "Int64", 1, ends);
        // VTK_TETRA and VTK_QUADRATIC_TETRA
        let kind = if self.per_cell == 10 { 24_u8 } else { 10 };
        file.array(&mut cells, "types", "UInt8", 1, std::iter::repeat_n(kind, n_cells));
        let mut bytes = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n\
             <FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}\
             </DataArray></FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{n_cells}\">\n\
             <PointData>\n{of_points}</PointData>\n<CellData>\n{of_cells}</CellData>\n<Points>\n{points}</Points>\n\
             <Cells>\n{cells}</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
            self.time,
            self.points.len()
        )
        .into_bytes();
        bytes.extend(file.block);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::vtp::tests::array;

    #[test]
    fn cells_and_their_fields_read_back() {
        let mesh = Tetrahedra {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]],
            connectivity: vec![0, 1, 2, 3, 1, 4, 2, 3],
            per_cell: 4,
            cell_fields: vec![("strain", PointField::Scalar(vec![0.25, -0.5]))],
            ..Tetrahedra::default()
        };
        let bytes = mesh.to_bytes();
        let corners: Vec<u8> = [0_i64, 1, 2, 3, 1, 4, 2, 3].iter().flat_map(|i| i.to_le_bytes()).collect();
        assert_eq!(array(&bytes, "connectivity"), corners);
        assert_eq!(array(&bytes, "types"), [10, 10]);
        assert_eq!(array(&bytes, "strain")[8..], (-0.5_f64).to_le_bytes());
        assert_eq!(array(&bytes, "offsets")[8..], 8_i64.to_le_bytes());
    }
}
