//! Numbers as they are typed: lengths, points, counts of threads.

use glam::DVec3;
use std::str::FromStr;
use std::time::Duration;

/// A length in model units, or a share of the diagonal of the box around all inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Model units.
    Units(f64),
    /// A share of the diagonal; `2%` is 0.02.
    OfDiagonal(f64),
}

impl Length {
    /// The length in model units.
    pub fn resolve(self, diagonal: f64) -> f64 {
        match self {
            Self::Units(length) => length,
            Self::OfDiagonal(share) => share * diagonal,
        }
    }
}

impl FromStr for Length {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (number, scale): (_, fn(f64) -> Self) = match text.strip_suffix('%') {
            Some(percent) => (percent, |p| Self::OfDiagonal(p / 100.0)),
            None => (text, Self::Units),
        };
        let value: f64 = number.trim().parse().map_err(|_| {
            "a length is a number of model units, such as 0.25, or a share of the diagonal, such as 2%".to_string()
        })?;
        if value.is_finite() && value >= 0.0 {
            Ok(scale(value))
        } else {
            Err("a length must be finite and not negative".into())
        }
    }
}

/// A length above zero.
pub fn positive_length(text: &str) -> Result<Length, String> {
    let length = text.parse()?;
    if length == Length::Units(0.0) || length == Length::OfDiagonal(0.0) {
        return Err("must be above zero".into());
    }
    Ok(length)
}

/// Radii as typed: one, or one for each side of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radius {
    /// Left and right.
    pub sides: [Length; 2],
}

impl Radius {
    /// Both in model units.
    pub fn resolve(self, diagonal: f64) -> [f64; 2] {
        self.sides.map(|r| r.resolve(diagonal))
    }
}

/// A radius, or two with a comma between.
pub fn radius(text: &str) -> Result<Radius, String> {
    let (left, right) = text.split_once(',').unwrap_or((text, text));
    Ok(Radius { sides: [positive_length(left)?, positive_length(right)?] })
}

/// A radius at a place, `x,y,z=R`.
pub fn radius_at(text: &str) -> Result<(DVec3, Length), String> {
    let (at, radius) = text.split_once('=').ok_or("a radius at a place is X,Y,Z=R, such as 0,1.5,-2=0.25")?;
    Ok((point(at)?, positive_length(radius)?))
}

/// A point, and a radius where it is given: `x,y,z` or `x,y,z=R`.
pub fn near(text: &str) -> Result<(DVec3, Option<Length>), String> {
    match text.split_once('=') {
        Some(_) => radius_at(text).map(|(at, radius)| (at, Some(radius))),
        None => Ok((point(text)?, None)),
    }
}

/// A time in seconds, above zero.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let limit = text.parse().ok().filter(|&s: &f64| s > 0.0).and_then(|s| Duration::try_from_secs_f64(s).ok());
    limit.ok_or_else(|| "a time is a number of seconds above zero".into())
}

/// An angle from −90 to 90 degrees.
pub fn crease(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(angle) if (-90.0..=90.0).contains(&angle) => Ok(angle),
        _ => Err("must be an angle from -90 to 90 degrees".into()),
    }
}

/// A number of zero or more.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (0.0..=1e3).contains(&number) => Ok(number),
        _ => Err("must be a number from 0 to 1000".into()),
    }
}

/// A point or direction, `x,y,z`.
pub fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && DVec3::new(x, y, z).is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err("a point is three finite numbers, such as 0,1.5,-2".into()),
    }
}

/// A direction: a point other than the origin.
pub fn direction(text: &str) -> Result<DVec3, String> {
    let d = point(text)?;
    d.try_normalize().ok_or_else(|| "a direction must not be 0,0,0".into())
}

/// A plane: a point of it and its normal, `px,py,pz,nx,ny,nz`.
pub fn plane(text: &str) -> Result<(DVec3, DVec3), String> {
    let numbers: Vec<f64> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    let wrong = || "a plane is a point and a normal other than 0,0,0, such as 0,0,1.5,0,0,1".to_string();
    if numbers.len() != 6 || text.split(',').count() != 6 || !numbers.iter().all(|n| f64::is_finite(*n)) {
        return Err(wrong());
    }
    let (point, normal) = (DVec3::from_slice(&numbers), DVec3::from_slice(&numbers[3..]));
    if normal == DVec3::ZERO { Err(wrong()) } else { Ok((point, normal)) }
}

/// A share of an edge, in [0, 0.25].
pub fn snap(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(s) if (0.0..=0.25).contains(&s) => Ok(s),
        _ => Err("must be a number from 0 to 0.25".into()),
    }
}

/// An angle in degrees, in (0, 180).
pub fn angle(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(a) if a > 0.0 && a < 180.0 => Ok(a),
        _ => Err("an angle is a number of degrees between 0 and 180".into()),
    }
}

/// A number above zero.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if x > 0.0 && x < f64::INFINITY => Ok(x),
        _ => Err("must be a number above zero".into()),
    }
}

/// A loop by the numbers of its mesh and of itself, `1:0`.
pub fn mesh_and_loop(text: &str) -> Result<(usize, usize), String> {
    let parsed = text.split_once(':').and_then(|(mesh, index)| Some((mesh.parse().ok()?, index.parse().ok()?)));
    parsed.ok_or_else(|| "a loop is the number of its mesh and its own, such as 1:0".into())
}

/// An angle in degrees, in (0, 180]; 180 means none is large enough.
pub fn angle_or_none(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(180.0) => Ok(180.0),
        _ => angle(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_units_or_shares() {
        assert_eq!("0.25".parse(), Ok(Length::Units(0.25)));
        assert_eq!("2%".parse::<Length>().map(|l| l.resolve(50.0)), Ok(1.0));
        for bad in ["", "%", "2%%", "nan", "inf", "-1", "-1%", "two"] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
        assert!(positive_length("0").is_err() && positive_length("0%").is_err());
    }

    #[test]
    fn points_have_three_finite_numbers() {
        assert_eq!(point("0, 1.5,-2"), Ok(DVec3::new(0.0, 1.5, -2.0)));
        for bad in ["1,2", "1,2,3,4", "1,2,", "1,x,3", "1,2,inf", ""] {
            assert!(point(bad).is_err(), "{bad}");
        }
        assert!(direction("0,0,0").is_err());
        assert_eq!(plane("0,1,2, 0,0,-3"), Ok((DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, 0.0, -3.0))));
        for bad in ["0,0,0,0,0,0", "0,0,1", "0,0,0,0,0,1,2", "0,0,0,0,0,nan", ""] {
            assert!(plane(bad).is_err(), "{bad}");
        }
    }
}
