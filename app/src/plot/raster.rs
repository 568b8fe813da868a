//! Pictures of axisymmetric meshes and stresses: elements as pixels of few colours, both halves of the section.

use crate::error::{Error, Result};
use crate::plot::colours::cividis;

/// Colours of stresses between 0 and the largest.
const LEVELS: usize = 200;
/// Colours of a mesh's lines between the body's own and the darkest, per body.
const SHADES: usize = 8;
/// Fills of outer body, plate and inner body, and the darkest line on each.
const BODIES: [([f64; 3], [f64; 3]); 3] = [
    ([191.0, 216.0, 236.0], [0.0, 60.0, 110.0]),
    ([226.0, 226.0, 220.0], [60.0, 60.0, 56.0]),
    ([244.0, 217.0, 178.0], [120.0, 62.0, 0.0]),
];
const OUTLINE: u8 = 255;
const OUTLINE_COLOUR: [u8; 3] = [90; 3];

/// Quadrilaterals in the half-plane (r, z).
#[derive(Debug, Clone, Copy)]
pub(crate) struct QuadMesh<'a> {
    /// Coordinates r and z of the nodes in m.
    pub(crate) points: &'a [[f64; 2]],
    /// Nodes of each element.
    pub(crate) quads: &'a [[usize; 4]],
    /// Number of each element's body. Shape (quads.len()).
    pub(crate) bodies: &'a [usize],
}

/// What part of the section is shown: -r to r, and z from below to above, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    pub(crate) radius: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// Picture with one byte per pixel, an index into its palette; 0 is transparent.
pub(crate) struct Raster {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Raster {
    fn new(view: View, width: usize) -> Self {
        let height = (width as f64 * (view.high - view.low) / (2.0 * view.radius)).round().max(1.0) as usize;
        Raster { width, height, pixels: vec![0; width * height] }
    }

    /// The elements, their lines the darker the farther apart they are, so that fine parts don't turn black.
    pub(crate) fn mesh(mesh: QuadMesh, view: View, width: usize) -> Self {
        let mut raster = Raster::new(view, width);
        let place = raster.placed(mesh, view);
        let mut pixels = std::mem::take(&mut raster.pixels);
        let first = |body: usize| (1 + (body % BODIES.len()) * SHADES) as u8;
        let corners = |quad: &[usize; 4]| quad.map(|n| place[n]);
        for (quad, body) in mesh.quads.iter().zip(mesh.bodies) {
            raster.fill(corners(quad), [0.0; 4], |pixel, _| pixels[pixel] = first(*body));
        }
        raster.pixels = pixels;
        // lines on all fills, the darkest last, each the lighter the nearer the next one: all parts have the same tone
        let mut lines: Vec<(u8, [[f64; 2]; 2], u8)> = Vec::new();
        for (quad, body) in mesh.quads.iter().zip(mesh.bodies) {
            let corners = corners(quad);
            let edge = |k: usize| distance(corners[k % 4], corners[(k + 1) % 4]);
            lines.extend((0..4).map(|k| {
                let shade = (0.5 * edge(k + 1).min(edge(k + 3))).clamp(1.0, (SHADES - 1) as f64) as u8;
                (shade, [corners[k], corners[(k + 1) % 4]], first(*body) + shade)
            }));
        }
        lines.sort_by_key(|(shade, ..)| *shade);
        lines.iter().for_each(|(_, [from, to], colour)| raster.line(*from, *to, *colour));
        raster.outlined(mesh, &place).mirrored()
    }

    /// Nodal means of `values` (one per element, none negative), in colours from 0 to `top`.
    pub(crate) fn field(mesh: QuadMesh, values: &[f64], top: f64, view: View, width: usize) -> Self {
        let mut raster = Raster::new(view, width);
        let place = raster.placed(mesh, view);
        let shown = raster.shown(mesh, values, &place);
        let scale = if top > 0.0 { (LEVELS - 1) as f64 / top } else { 0.0 };
        for (pixel, value) in raster.pixels.iter_mut().zip(&shown).filter(|(_, value)| value.is_finite()) {
            *pixel = 1 + (value.max(0.0) * scale).round().min((LEVELS - 1) as f64) as u8;
        }
        raster.outlined(mesh, &place).mirrored()
    }

    /// What the nodal means of `values` do not exceed in a `share` of the section in view (1 = the largest of them).
    pub(crate) fn within(mesh: QuadMesh, values: &[f64], share: f64, view: View, width: usize) -> f64 {
        let raster = Raster::new(view, width);
        let mut sorted = raster.shown(mesh, values, &raster.placed(mesh, view));
        sorted.retain(|value| value.is_finite());
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1) as f64;
        sorted.get((share * last).round() as usize).copied().unwrap_or(0.0)
    }

    /// The nodal means at the pixels of the right half, NaN where no element is.
    fn shown(&self, mesh: QuadMesh, values: &[f64], place: &[[f64; 2]]) -> Vec<f64> {
        let nodal = nodal_means(mesh, values);
        let mut shown = vec![f64::NAN; self.pixels.len()];
        for quad in mesh.quads {
            self.fill(quad.map(|n| place[n]), quad.map(|n| nodal[n]), |pixel, value| shown[pixel] = value);
        }
        shown
    }

    /// Nodes in pixels of the right half, z upwards.
    fn placed(&self, mesh: QuadMesh, view: View) -> Vec<[f64; 2]> {
        let scale = self.width as f64 / (2.0 * view.radius);
        let middle = 0.5 * self.width as f64;
        mesh.points.iter().map(|p| [middle + p[0] * scale, (view.high - p[1]) * scale]).collect()
    }

    /// Visits the pixels of a quadrilateral as those of two triangles; a pixel's value is linear in the corners'.
    fn fill(&self, corners: [[f64; 2]; 4], values: [f64; 4], mut set: impl FnMut(usize, f64)) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let (pa, pb, pc) = (corners[a], corners[b], corners[c]);
            let area = cross(pa, pb, pc);
            if area == 0.0 {
                continue;
            }
            let range = |k: usize, size: usize| {
                let (low, high) = (pa[k].min(pb[k]).min(pc[k]), pa[k].max(pb[k]).max(pc[k]));
                (low - 0.5).ceil().max(0.0) as usize..((high + 0.5).floor().max(0.0) as usize).min(size)
            };
            for y in range(1, self.height) {
                for x in range(0, self.width) {
                    let p = [x as f64 + 0.5, y as f64 + 0.5];
                    let w = [cross(pb, pc, p) / area, cross(pc, pa, p) / area, cross(pa, pb, p) / area];
                    if w.iter().all(|w| *w >= -1e-9) {
                        let value = w[0] * values[a] + w[1] * values[b] + w[2] * values[c];
                        set(y * self.width + x, value);
                    }
                }
            }
        }
    }

    fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: u8) {
        let steps = distance(from, to).ceil().clamp(1.0, 1e5) as usize;
        for k in 0..=steps {
            let s = k as f64 / steps as f64;
            let (x, y) = (from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1]));
            if x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64 {
                self.pixels[y as usize * self.width + x as usize] = colour;
            }
        }
    }

    /// Edges that belong to one element only, the axis aside.
    fn outlined(mut self, mesh: QuadMesh, place: &[[f64; 2]]) -> Self {
        let mut edges: Vec<[usize; 2]> = mesh
            .quads
            .iter()
            .flat_map(|q| (0..4).map(|k| [q[k].min(q[(k + 1) % 4]), q[k].max(q[(k + 1) % 4])]))
            .collect();
        edges.sort_unstable();
        for same in edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1) {
            let [a, b] = same[0];
            if mesh.points[a][0] > 0.0 || mesh.points[b][0] > 0.0 {
                self.line(place[a], place[b], OUTLINE);
            }
        }
        self
    }

    /// The left half as the mirror image of the right one.
    fn mirrored(mut self) -> Self {
        for row in self.pixels.chunks_exact_mut(self.width) {
            for x in 0..row.len() / 2 {
                row[x] = row[row.len() - 1 - x];
            }
        }
        self
    }

    /// Height over width.
    pub(crate) fn aspect(&self) -> f64 {
        self.height as f64 / self.width as f64
    }

    /// PNG of a mesh or, with `field`, of a field.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be encoded.
    pub(crate) fn png(&self, field: bool) -> Result<Vec<u8>> {
        let mut palette = vec![[0_u8; 3]; 256];
        if field {
            (0..LEVELS).for_each(|k| palette[1 + k] = cividis(k as f64 / (LEVELS - 1) as f64));
        } else {
            for (b, (fill, dark)) in BODIES.iter().enumerate() {
                for s in 0..SHADES {
                    let share = s as f64 / (SHADES - 1) as f64;
                    palette[1 + b * SHADES + s] =
                        std::array::from_fn(|c| (fill[c] + share * (dark[c] - fill[c])).round() as u8);
                }
            }
        }
        palette[OUTLINE as usize] = OUTLINE_COLOUR;
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(palette.concat());
        encoder.set_trns(vec![0_u8]);
        encoder.set_filter(png::Filter::NoFilter);
        let internal = |e: png::EncodingError| Error::Internal(format!("drawing the mesh: {e}"));
        let mut writer = encoder.write_header().map_err(internal)?;
        writer.write_image_data(&self.pixels).map_err(internal)?;
        writer.finish().map_err(internal)?;
        Ok(bytes)
    }
}

fn nodal_means(mesh: QuadMesh, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); mesh.points.len()];
    for (quad, value) in mesh.quads.iter().zip(values) {
        for n in quad {
            sums[*n].0 += value;
            sums[*n].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 }).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    const UNIT_SQUARE: QuadMesh = QuadMesh { points: &SQUARE, quads: &[[0, 1, 2, 3]], bodies: &[1] };

    const VIEW: View = View { radius: 2.0, low: -1.0, high: 2.0 };

    /// Both halves, at the right place and of the right size.
    #[test]
    fn a_square_covers_its_share_of_the_picture() {
        let raster = Raster::mesh(UNIT_SQUARE, VIEW, 80);
        assert_eq!((raster.width, raster.height), (80, 60));
        let covered: Vec<usize> = (0..raster.pixels.len()).filter(|k| raster.pixels[*k] != 0).collect();
        // 2 x 1 of 4 x 3, and its outline
        assert!((800..=884).contains(&covered.len()), "{}", covered.len());
        assert!(covered.iter().all(|k| (20..=40).contains(&(k / 80)) && (19..=60).contains(&(k % 80))));
    }

    #[test]
    fn a_field_is_coloured_from_zero_to_its_largest_value_in_view() {
        let points = [&SQUARE[..], &[[2.0, 0.0], [2.0, 1.0]]].concat();
        let mesh = QuadMesh { points: &points, quads: &[[0, 1, 2, 3], [1, 4, 5, 2]], bodies: &[1, 1] };
        let largest = Raster::within(mesh, &[0.0, 10.0], 1.0, VIEW, 80);
        let raster = Raster::field(mesh, &[0.0, 10.0], largest, VIEW, 80);
        assert!((9.8..=10.0).contains(&largest), "{largest}");
        // 0 at the axis, the mean of both elements between them, 10 at the rim: 5 per unit of length
        for x in [41, 50, 60, 70, 78] {
            let expected = 1.0 + 199.0 * 5.0 * (x as f64 + 0.5 - 40.0) / 20.0 / largest;
            let found = f64::from(raster.pixels[30 * 80 + x]);
            assert!((found - expected).abs() <= 1.0, "{found} at {x}, expected {expected}");
        }
        assert_eq!(raster.pixels[30 * 80 + 2], raster.pixels[30 * 80 + 77]);
        // the field rises from 0 to 5 over the first element
        let near = View { radius: 0.5, ..VIEW };
        assert!((2.3..=2.5).contains(&Raster::within(mesh, &[0.0, 10.0], 1.0, near, 80)));
        let half = Raster::within(mesh, &[0.0, 10.0], 0.5, VIEW, 80);
        assert!((4.7..=5.3).contains(&half), "{half}");
    }

    #[test]
    fn pictures_can_be_decoded_and_the_colours_are_those_of_the_map() {
        let png = Raster::field(UNIT_SQUARE, &[1.0], 1.0, VIEW, 40).png(true).expect("PNG");
        let image = resvg::tiny_skia::Pixmap::decode_png(&png).expect("valid");
        let centre = image.pixel(20, 15).expect("inside").demultiply();
        assert_eq!([centre.red(), centre.green(), centre.blue()], cividis(1.0));
        assert_eq!(image.pixel(0, 0).expect("inside").alpha(), 0);
        // ends of the published map, #00224e and #fee838, which the polynomials meet within 14 of 255
        for (share, end) in [(0.0, [0, 34, 78]), (1.0, [254, 232, 56])] {
            assert!(cividis(share).iter().zip(end).all(|(a, b)| a.abs_diff(b) <= 14), "{:?}", cividis(share));
        }
        // what makes it readable without colour: brightness rises evenly (relative luminance's weights)
        let brightness = |k: usize| {
            let [r, g, b] = cividis(k as f64 / 20.0).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..20).all(|k| (4.0..16.0).contains(&(brightness(k + 1) - brightness(k)))));
    }
}
