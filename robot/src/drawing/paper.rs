//! Sheet: projection to paper, and the text of numbers, paths and outlines.

use super::scene::{NOTHING, Point, Scene};
use super::view::View;
use std::fmt::Write;

/// Width of the sheet, pixels.
pub(super) const WIDTH: f64 = 720.0;
/// Margins: left and right for names, top for the title, bottom for the legend.
const MARGIN: [f64; 3] = [92.0, 104.0, 96.0];
/// Largest height of the robot, pixels.
const TALLEST: f64 = 400.0;
/// Diameter of the sphere around a rotated robot, pixels.
const LARGEST_TURNED: f64 = 500.0;
/// Smallest height, for flat robots, pixels.
const LOWEST: f64 = 130.0;

/// Scale and position of the robot on paper.
pub(super) struct Sheet {
    scale: f64,
    /// Centre of the robot's bounding box, m.
    middle: [f64; 2],
    /// Height of the sheet, pixels.
    pub(super) height: f64,
}

impl Sheet {
    /// Sheet with the largest scale at which a scene fits.
    pub(super) fn fitted(scene: &Scene, view: &View) -> Self {
        let mut places: Vec<[f64; 3]> = scene.points().iter().map(|p| view.project(p)).collect();
        let globe = scene.sphere.unwrap_or(0.0);
        if globe > 0.0 {
            places.extend([[-globe, -globe, 0.0], [globe, globe, 0.0]]);
        }
        let range = |axis: usize| {
            let low = places.iter().map(|p| p[axis]).fold(f64::MAX, f64::min);
            let high = places.iter().map(|p| p[axis]).fold(f64::MIN, f64::max);
            if low > high { (0.0, 0.0) } else { (low, high) }
        };
        let ((left, right), (bottom, top)) = (range(0), range(1));
        let (width, height) = (right - left, top - bottom);
        // A robot without extent, such as a single joint, fits any scale.
        let scale = if width.max(height) < NOTHING {
            400.0
        } else {
            let wide = (WIDTH - 2.0 * MARGIN[0]) / width.max(NOTHING);
            wide.min(TALLEST / height.max(NOTHING))
        };
        Self {
            scale,
            middle: [(left + right) / 2.0, (bottom + top) / 2.0],
            height: ((height * scale).max(LOWEST) + MARGIN[1] + MARGIN[2]).round(),
        }
    }

    /// Sheet on which a scene fits from every direction: that of its bounding sphere.
    pub(super) fn around(scene: &Scene, view: &View) -> Self {
        let points = scene.points();
        let low = points.iter().copied().reduce(|a, b| a.inf(&b));
        let high = points.iter().copied().reduce(|a, b| a.sup(&b));
        let middle = (low.unwrap_or_default() + high.unwrap_or_default()) / 2.0;
        let far = points.iter().map(|point| (point - middle).norm());
        let radius = far.fold(scene.sphere.unwrap_or(0.0), f64::max);
        let scale = if radius < NOTHING {
            400.0
        } else {
            LARGEST_TURNED / (2.0 * radius)
        };
        let [right, up, _] = view.project(&middle);
        Self {
            scale,
            middle: [right, up],
            height: (LARGEST_TURNED + MARGIN[1] + MARGIN[2]).round(),
        }
    }

    /// Length of a pixel, m.
    pub(super) fn pixel(&self) -> f64 {
        1.0 / self.scale
    }

    /// Position on paper (pixels from the top left) and depth (pixels).
    pub(super) fn place(&self, view: &View, point: &Point) -> [f64; 3] {
        let [right, up, near] = view.project(point);
        let middle = (self.height - MARGIN[2] + MARGIN[1]) / 2.0;
        [
            WIDTH / 2.0 + (right - self.middle[0]) * self.scale,
            middle - (up - self.middle[1]) * self.scale,
            near * self.scale,
        ]
    }
}

/// Number with one decimal, without minus zero.
pub(super) fn n(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    format!("{rounded}")
}

/// Path data through points.
pub(super) fn path(points: &[Point], view: &View, sheet: &Sheet) -> String {
    let mut text = String::new();
    for (index, point) in points.iter().enumerate() {
        let [x, y, _] = sheet.place(view, point);
        let command = if index == 0 { 'M' } else { 'L' };
        // Writing to a string cannot fail.
        let _ = write!(text, "{command}{} {}", n(x), n(y));
    }
    text
}

/// SVG polygon through some points.
pub(super) fn polygon(class: &str, places: &[[f64; 2]]) -> String {
    let points: Vec<String> = places
        .iter()
        .map(|[x, y]| format!("{},{}", n(*x), n(*y)))
        .collect();
    let points = points.join(" ");
    format!(
        "<polygon class=\"ov-{class}\" points=\"{points}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n"
    )
}

/// A point on paper.
pub(super) fn flat(point: &Point, view: &View, sheet: &Sheet) -> [f64; 2] {
    let [x, y, _] = sheet.place(view, point);
    [x, y]
}

/// Convex hull without duplicate points.
pub(super) fn hull(mut places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let rounded = |p: &[f64; 2]| p.map(|v| (v * 10.0).round() as i64);
    places.sort_by_key(rounded);
    places.dedup_by_key(|p| rounded(p));
    if places.len() < 3 {
        return places;
    }
    let turn = |a: &[f64; 2], b: &[f64; 2], c: &[f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let half = |order: &mut dyn Iterator<Item = &[f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for place in order {
            while chain.len() > 1
                && turn(&chain[chain.len() - 2], &chain[chain.len() - 1], place) <= 1.0
            {
                chain.pop();
            }
            chain.push(*place);
        }
        chain.pop();
        chain
    };
    let mut outline = half(&mut places.iter());
    outline.extend(half(&mut places.iter().rev()));
    outline
}
