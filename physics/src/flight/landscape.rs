//! The energy landscape of a chamber: how much energy the sphere needs to be at x, and the saddle between the seats.
//!
//! Of every column the lowest potential at which the sphere can be there counts. No path crosses a column with less energy than
//! that, whatever its course: a sphere with less than the columns on both sides of it is shut in, with certainty.

use super::{Seat, Setup, Vector};

/// Columns of the landscape.
const COLUMNS: usize = 1200;
/// Places in a column at which the potential is looked at.
const PLACES: usize = 24;
/// How far the lowest point may lie from the centre of a seated sphere, over the radius.
const OFF_SEAT: f64 = 0.01;

/// Lowest potential over x.
#[derive(Debug, Clone, PartialEq)]
pub struct Landscape {
    /// x in m of the sphere's centre. Shape (columns).
    pub x: Vec<f64>,
    /// Lowest potential in J over that in the seat the sphere starts from. Shape (columns).
    pub energy: Vec<f64>,
    /// The highest of all columns between the seats.
    pub saddle: Saddle,
    /// Potential in J of the seat the sphere starts from.
    seat_energy: f64,
    hollows: Vec<Hollow>,
}

/// A column that is higher than those around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saddle {
    /// Its x in m.
    pub x: f64,
    /// Its potential in J over that in the seat the sphere starts from.
    pub energy: f64,
}

/// A stretch between two saddles or walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hollow {
    /// From where to where in x, m.
    range: [f64; 2],
    /// Potential in J below which the sphere can't leave it, nor be held in it by friction beside its lowest point.
    pub(super) certain_below: f64,
    /// Where its lowest point is, m.
    pub(super) x: f64,
    pub(super) seat: Seat,
}

impl Landscape {
    /// Of a `setup`, whatever shakes it.
    ///
    /// # Errors
    /// One sentence if the sphere does not stay in one of the seats, or nothing lies between them.
    pub fn new(setup: &Setup) -> Result<Self, String> {
        let [low, high] = setup.chamber.columns();
        let x: Vec<f64> = (0..=COLUMNS).map(|k| low + (high - low) * k as f64 / COLUMNS as f64).collect();
        let energy: Vec<f64> = x.iter().map(|&x| lowest(setup, x).0).collect();
        let turns = turns(setup, &x, &energy);
        let seats = setup.chamber.seats();
        let of_seat = seats.map(|seat| setup.field.potential(setup.mass, seat));
        let mut hollows: Vec<Hollow> = Vec::new();
        for (k, turn) in turns.iter().enumerate().filter(|(_, turn)| turn.lowest) {
            let neighbours = [k.checked_sub(1), Some(k + 1)].map(|at| at.and_then(|at| turns.get(at)));
            let range = [neighbours[0].map_or(low, |t| t.x), neighbours[1].map_or(high, |t| t.x)];
            let rim = neighbours.iter().flatten().map(|t| t.energy).fold(f64::INFINITY, f64::min);
            let sticking = friction_barrier(setup, range, turn.x);
            let in_range = |seat: &Vector| (range[0]..=range[1]).contains(&seat.x);
            let seat = match seats.iter().position(in_range) {
                Some(0) => Seat::Same,
                Some(_) => Seat::Other,
                None => Seat::None,
            };
            hollows.push(Hollow { range, certain_below: rim.min(sticking), x: turn.x, seat });
        }
        if let Some(sentence) = unheld(setup, &hollows) {
            return Err(sentence);
        }
        let [from, to] = [seats[0].x.min(seats[1].x), seats[0].x.max(seats[1].x)];
        let between = turns.iter().filter(|turn| !turn.lowest && turn.x > from && turn.x < to);
        let saddle = between.copied().max_by(|a, b| a.energy.total_cmp(&b.energy));
        let saddle = saddle.ok_or("nothing lies between the seats: the sphere is held in neither")?;
        Ok(Landscape {
            x,
            energy: energy.iter().map(|energy| energy - of_seat[0]).collect(),
            saddle: Saddle { x: saddle.x, energy: saddle.energy - of_seat[0] },
            seat_energy: of_seat[0],
            hollows,
        })
    }

    /// One in which nothing is ever certain.
    #[cfg(test)]
    pub(super) fn unknown() -> Self {
        Landscape {
            x: Vec::new(),
            energy: Vec::new(),
            saddle: Saddle { x: 0.0, energy: 0.0 },
            seat_energy: 0.0,
            hollows: Vec::new(),
        }
    }

    /// Least speed in m/s with which the sphere of `mass` kg can leave its seat for good: sqrt(2 dU / m).
    pub fn least_speed(&self, mass: f64) -> f64 {
        (2.0 * self.saddle.energy / mass).sqrt()
    }

    /// The hollow around `x` m.
    pub(super) fn hollow(&self, x: f64) -> Option<&Hollow> {
        self.hollows.iter().find(|hollow| (hollow.range[0]..=hollow.range[1]).contains(&x))
    }

    /// Potential in J of the seat that [`Self::energy`] counts from.
    pub fn seat_energy(&self) -> f64 {
        self.seat_energy
    }
}

/// Lowest potential in J in the column at `x`, and the height in m where it is.
fn lowest(setup: &Setup, x: f64) -> (f64, f64) {
    let [low, high] = [setup.chamber.floor(x), setup.chamber.ceiling()];
    let at = |z: f64| setup.field.potential(setup.mass, Vector::new(x, z));
    let places = if setup.field.spring.as_ref().is_some_and(|s| s.anchor.is_some()) { PLACES } else { 2 };
    let place = |k: usize| low + (high - low) * k as f64 / places as f64;
    let all = (0..=places).map(|k| (at(place(k)), k));
    let (energy, k) = all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((at(low), 0));
    if k == 0 || k == places {
        return (energy, place(k));
    }
    let z = golden(&at, place(k - 1), place(k + 1));
    (at(z), z)
}

/// Where `f` is lowest between `a` and `b`.
fn golden(f: &dyn Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_9;
    let (mut c, mut d) = (b - SHARE * (b - a), a + SHARE * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    for _ in 0..60 {
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - SHARE * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + SHARE * (b - a);
            fd = f(d);
        }
    }
    0.5 * (a + b)
}

/// A column lower, or higher, than those around it.
#[derive(Debug, Clone, Copy)]
struct Extremum {
    x: f64,
    energy: f64,
    lowest: bool,
}

/// The columns at which the landscape turns, from left to right: lowest and highest ones alternate, the first and the last are
/// lowest ones. Of a level stretch the middle counts.
fn turns(setup: &Setup, x: &[f64], energy: &[f64]) -> Vec<Extremum> {
    let scale = energy.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    let level = 1e-12 * scale;
    // stretches of equal energy: first and last column
    let mut stretches: Vec<[usize; 2]> = Vec::new();
    for k in 0..x.len() {
        match stretches.last_mut() {
            Some(last) if (energy[k] - energy[last[1]]).abs() <= level => last[1] = k,
            _ => stretches.push([k, k]),
        }
    }
    let height = |s: &[usize; 2]| energy[s[0]];
    let mut found = Vec::new();
    for (k, stretch) in stretches.iter().enumerate() {
        let neighbours = [k.checked_sub(1), Some(k + 1)].map(|at| at.and_then(|at| stretches.get(at)));
        let above = neighbours.map(|other| other.is_none_or(|other| height(other) > height(stretch)));
        let below = neighbours.map(|other| other.is_some_and(|other| height(other) < height(stretch)));
        let lowest = above == [true; 2];
        if lowest || below == [true; 2] {
            let sign = if lowest { 1.0 } else { -1.0 };
            let [a, b] = [x[stretch[0].saturating_sub(1)], x[(stretch[1] + 1).min(x.len() - 1)]];
            let x = if stretch[0] == stretch[1] {
                golden(&|x| sign * self::lowest(setup, x).0, a, b)
            } else {
                0.5 * (x[stretch[0]] + x[stretch[1]])
            };
            found.push(Extremum { x, energy: self::lowest(setup, x).0, lowest });
        }
    }
    found
}

/// Lowest potential in J in a `range` of x at which friction of surface and spring together can hold the sphere elsewhere than at
/// the lowest point: the surface stops it from sliding, the spring from rolling.
fn friction_barrier(setup: &Setup, range: [f64; 2], lowest_x: f64) -> f64 {
    let mut least = f64::INFINITY;
    if setup.field.spring.as_ref().is_none_or(|spring| spring.friction == 0.0) || setup.friction == 0.0 {
        return least;
    }
    for k in 0..=COLUMNS {
        let x = range[0] + (range[1] - range[0]) * k as f64 / COLUMNS as f64;
        let place = Vector::new(x, setup.chamber.floor(x));
        let nearest = (0..setup.chamber.walls()).map(|wall| setup.chamber.nearest(wall, place).point);
        let Some(point) = nearest.min_by(|a, b| (place - a).norm().total_cmp(&(place - b).norm())) else {
            continue;
        };
        let normal = (place - point).normalize();
        let pull = setup.mass * setup.field.acceleration(setup.mass, f64::INFINITY, place);
        let (pressed, along) = (-pull.dot(&normal), pull.dot(&super::track::tangent(normal)).abs());
        let resisted = setup.field.resisting_moment(setup.radius, place) / setup.radius;
        let sticking = pressed > 0.0 && along <= (setup.friction * pressed).min(resisted);
        if sticking && (x - lowest_x).abs() > OFF_SEAT * setup.radius {
            least = least.min(setup.field.potential(setup.mass, place));
        }
    }
    least
}

/// Says so if a seat does not hold the sphere.
fn unheld(setup: &Setup, hollows: &[Hollow]) -> Option<String> {
    let mm = |length: f64| format!("{} mm", (length * 1e6).round() / 1e3);
    for (seat, name) in setup.chamber.seats().into_iter().zip(["the seat it starts from", "the other seat"]) {
        let Some(hollow) = hollows.iter().find(|h| (h.range[0]..=h.range[1]).contains(&seat.x)) else {
            return Some(format!(
                "the sphere does not stay in {name}: nothing holds it at x = {}",
                mm(seat.x)
            ));
        };
        let height = lowest(setup, hollow.x).1;
        let off = Vector::new(hollow.x, height) - seat;
        if off.norm() > OFF_SEAT * setup.radius {
            return Some(format!(
                "gravity and spring do not hold the sphere in {name} (x = {}, z = {}): they draw it to x = {}, z = {}",
                mm(seat.x),
                mm(seat.y),
                mm(hollow.x),
                mm(height)
            ));
        }
    }
    None
}
