//! Points and triangles in VTK's XML format (`.vtp`), as ParaView opens it: a header, then one appended block of
//! raw little-endian arrays, each compressed by zlib.

use flate2::{Compression, write::ZlibEncoder};
use std::fmt::Write as _;
use std::io::Write as _;

/// Points, triangles between them, and named fields on the points.
#[derive(Debug, Clone, Default)]
pub struct PolyData<'a> {
    /// Simulated time [s].
    pub time: f64,
    /// Coordinates [m].
    pub points: Vec<[f64; 3]>,
    /// Corners of triangles by number of point; empty for a cloud of points.
    pub triangles: Vec<[u32; 3]>,
    /// Fields on the points.
    pub fields: Vec<(&'a str, PointField)>,
}

/// One value a point or cell.
#[derive(Debug, Clone)]
pub enum PointField {
    /// Numbers.
    Scalar(Vec<f64>),
    /// Vectors.
    Vector(Vec<[f64; 3]>),
    /// Whole numbers such as identities.
    Id(Vec<i64>),
}

impl PolyData<'_> {
    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let n = self.points.len();
        let is_cloud = self.triangles.is_empty();
        let mut file = Appended::default();
        let mut points = String::new();
        file.array(
            &mut points,
            "Points",
            "Float64",
            3,
            self.points.iter().flatten().flat_map(|x| x.to_le_bytes()),
        );

        let mut fields = String::new();
        self.fields.iter().for_each(|(name, field)| file.field(&mut fields, name, field));

        let mut cells = String::new();
        let per_cell = if is_cloud { 1 } else { 3 };
        let n_cells = if is_cloud { n } else { self.triangles.len() };
        let corners: Vec<u32> =
            if is_cloud { (0..n as u32).collect() } else { self.triangles.as_flattened().to_vec() };
        file.array(
            &mut cells,
            "connectivity",
            "Int64",
            1,
            corners.iter().flat_map(|&i| i64::from(i).to_le_bytes()),
        );
        let ends = (1..=n_cells as i64).flat_map(|i| (i * per_cell).to_le_bytes());
        file.array(&mut cells, "offsets", "Int64", 1, ends);

        let kind = if is_cloud { "Verts" } else { "Polys" };
        let (n_verts, n_polys) = if is_cloud { (n_cells, 0) } else { (0, n_cells) };
        let mut bytes = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n\
             <FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}\
             </DataArray></FieldData>\n\
             <Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"{n_verts}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{n_polys}\">\n<PointData>\n{fields}</PointData>\n<Points>\n{points}</Points>\n\
             <{kind}>\n{cells}</{kind}>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
            self.time
        )
        .into_bytes();
        bytes.extend(file.block);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}

/// The appended block: every array in pieces of 1 MiB, each compressed.
#[derive(Default)]
pub(super) struct Appended {
    pub block: Vec<u8>,
}

impl Appended {
    /// A field.
    pub fn field(&mut self, xml: &mut String, name: &str, field: &PointField) {
        match field {
            PointField::Scalar(v) => {
                self.array(xml, name, "Float64", 1, v.iter().flat_map(|x| x.to_le_bytes()))
            }
            PointField::Vector(v) => {
                self.array(xml, name, "Float64", 3, v.iter().flatten().flat_map(|x| x.to_le_bytes()));
            }
            PointField::Id(v) => self.array(xml, name, "Int64", 1, v.iter().flat_map(|x| x.to_le_bytes())),
        }
    }

    /// An array of numbers given as bytes.
    pub fn array(
        &mut self,
        xml: &mut String,
        name: &str,
        kind: &str,
        width: usize,
        data: impl Iterator<Item = u8>,
    ) {
        const PIECE: usize = 1 << 20;
        let offset = self.block.len();
        let _ = writeln!(
            xml,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"appended\" \
             offset=\"{offset}\"/>"
        );
        let data: Vec<u8> = data.collect();
        let pieces: Vec<Vec<u8>> = data.chunks(PIECE).map(compress).collect();
        let mut header = vec![pieces.len() as u64, PIECE as u64, (data.len() % PIECE) as u64];
        header.extend(pieces.iter().map(|piece| piece.len() as u64));
        self.block.extend(header.iter().flat_map(|x| x.to_le_bytes()));
        self.block.extend(pieces.iter().flatten());
    }
}

fn compress(data: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(data).and_then(|()| encoder.finish()).expect("writing to memory does not fail")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::io::Read;

    /// Reads one appended array back, as a VTK reader does.
    pub fn array(bytes: &[u8], name: &str) -> Vec<u8> {
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start = bytes.windows(marker.len()).position(|w| w == marker).unwrap() + marker.len();
        let xml = String::from_utf8_lossy(&bytes[..start]);
        let tag = &xml[xml.find(&format!("Name=\"{name}\" NumberOfComp")).unwrap()..];
        let offset: usize =
            tag.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        let block = &bytes[start + offset..];
        let word = |i: usize| u64::from_le_bytes(block[8 * i..8 * i + 8].try_into().unwrap()) as usize;
        let (mut data, mut at) = (Vec::new(), 8 * (3 + word(0)));
        for piece in 0..word(0) {
            flate2::read::ZlibDecoder::new(&block[at..at + word(3 + piece)]).read_to_end(&mut data).unwrap();
            at += word(3 + piece);
        }
        data
    }

    #[test]
    fn arrays_of_several_pieces_read_back() {
        let points: Vec<[f64; 3]> =
            (0..60_000).map(|i| [f64::from(i), 0.5, -1.0 / f64::from(i + 1)]).collect();
        let ids = PointField::Id((0..60_000).rev().collect());
        let data =
            PolyData { time: 0.25, points: points.clone(), fields: vec![("id", ids)], ..PolyData::default() };
        let bytes = data.to_bytes();
        let read = array(&bytes, "Points");
        let expected: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        assert!(read == expected && read.len() > 1 << 20);
        assert_eq!(array(&bytes, "id")[..8], 59_999_i64.to_le_bytes());
        assert_eq!(array(&bytes, "offsets")[8..16], 2_i64.to_le_bytes());
    }

    #[test]
    fn triangles_are_written_by_corner() {
        let data = PolyData {
            points: vec![[0.0; 3]; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..PolyData::default()
        };
        let bytes = data.to_bytes();
        let corners: Vec<u8> = [0_i64, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()).collect();
        assert_eq!(array(&bytes, "connectivity"), corners);
        assert!(String::from_utf8_lossy(&bytes).contains("NumberOfPolys=\"2\""));
    }
}
