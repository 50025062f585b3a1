//! The file of shapes and names that comes with this program; `data/build.py` makes it.

use std::io::{self, Read};

use flate2::read::GzDecoder;
use serde::Deserialize;
use thiserror::Error;

use crate::mercator::project;

/// Countries, lakes, rivers and cities; the page beside it names their sources.
const PACKED: &[u8] = include_bytes!("../../data/world.json.gz");

/// The reason for a missing map.
#[derive(Debug, Error)]
pub enum NoWorld {
    #[error("the shapes can't be unpacked: {0}")]
    Packed(#[from] io::Error),
    #[error("the shapes can't be read: {0}")]
    Read(#[from] serde_json::Error),
}

/// A line as its first place and the steps from each place to the next.
type Steps = Vec<[i64; 2]>;

/// The content of the file: places are whole numbers of a scale.
#[derive(Debug, Deserialize)]
pub struct Atlas {
    scale: [f64; 2],
    translate: [f64; 2],
    arcs: Vec<Steps>,
    pub countries: Vec<CountryShape>,
    pub lakes: Vec<LakeShape>,
    pub rivers: Vec<RiverLine>,
    pub cities: Vec<CityPlace>,
}

/// Polygons of rings of arcs; the complement of an index is the arc in reverse.
#[derive(Debug, Deserialize)]
pub struct CountryShape {
    pub name: String,
    pub polygons: Vec<Vec<Vec<i64>>>,
}

#[derive(Debug, Deserialize)]
pub struct LakeShape {
    pub name: String,
    /// From 0 for the most important ones to 5.
    pub rank: u8,
    pub polygons: Vec<Vec<Steps>>,
}

#[derive(Debug, Deserialize)]
pub struct RiverLine {
    /// The zoom from which it is drawn.
    pub from: f64,
    /// From 0.15 to 1.2.
    pub width: f32,
    pub line: Steps,
}

#[derive(Debug, Deserialize)]
pub struct CityPlace {
    pub name: String,
    pub at: [i64; 2],
    /// The zoom from which its name is written.
    pub from: f64,
    #[serde(default)]
    pub is_capital: bool,
}

impl Atlas {
    /// The atlas that comes with this program.
    ///
    /// # Errors
    /// It is damaged.
    pub fn shipped() -> Result<Self, NoWorld> {
        let mut text = Vec::new();
        GzDecoder::new(PACKED).read_to_end(&mut text)?;
        Ok(serde_json::from_slice(&text)?)
    }

    /// The lines that countries share, each once.
    pub fn arcs(&self) -> Vec<Vec<[f64; 2]>> {
        self.arcs.iter().map(|steps| self.line(steps)).collect()
    }

    /// A line in the world.
    pub fn line(&self, steps: &[[i64; 2]]) -> Vec<[f64; 2]> {
        let mut at = [0, 0];
        let along = |step: &[i64; 2]| {
            at = [at[0] + step[0], at[1] + step[1]];
            self.place(at)
        };
        steps.iter().map(along).collect()
    }

    /// A place in the world.
    pub fn place(&self, at: [i64; 2]) -> [f64; 2] {
        let degrees = |axis: usize| at[axis] as f64 * self.scale[axis] + self.translate[axis];
        project(degrees(0), degrees(1))
    }
}
